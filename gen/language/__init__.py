# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""What a model is written in: terms, types, expressions, intervals, units and names."""
