# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Discrete-event simulation of tasks and buses in virtual time, with integer ticks.

It shares the records of `analysis.core` (what a system is) and none of its equations, so
that what it observes can be held against the bounds. Observed responses are examples: the
longest seen for one choice of phases is not the longest there is.
"""
