# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The terms of a model in Ada: types, events, expressions, configurations."""
