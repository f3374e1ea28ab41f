# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The behaviour of a model without its code: an interpreter, rules and test cases.

The interpreter executes `System` by the rules of docs/semantics.md, on the chart as modelled.
It shares only the model with the Ada emitter. So a comparison of the interpreter with a
generated program checks both.
"""
