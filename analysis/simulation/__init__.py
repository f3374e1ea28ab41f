# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Discrete-event simulation of tasks and buses in virtual time, with integer ticks.

It shares the records of `analysis.core` (the description of a system) and none of its
equations, so that observed responses can be compared with the bounds. They are examples: the
longest observed response for one choice of phases is not the longest possible one.
"""
