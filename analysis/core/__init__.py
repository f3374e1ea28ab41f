# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Response-time analysis of tasks, frames and chains, apart from any model or file.

Pure functions over frozen records. Every time is an integer in one tick of the
caller's choice (nanoseconds here); integers have no largest value, so nothing
overflows, and no quotient is ever taken in floating point.
"""
