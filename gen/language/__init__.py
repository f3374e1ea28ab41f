# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The language of models: terms, types, expressions, intervals, units and names."""
