# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Statecharts in Ada: `compound` resolves what each transition leaves and enters,
`shape` decides types and names, `declared` emits the chart as declared, `selection`,
`firing` and `stepping` the code that is proved against it."""
