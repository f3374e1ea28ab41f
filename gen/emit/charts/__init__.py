# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Statecharts in Ada: `compound` resolves the states that each transition leaves and enters.

`shape` decides types and names, and `declared` emits the chart as declared. `selection`,
`firing` and `stepping` emit the code that is proved against it.
"""
