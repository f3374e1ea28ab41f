# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""What a model does, step by step, before there is code.

An interpreter of `System`, written from docs/semantics.md and from nothing that
the Ada emitter uses: it walks the chart as modelled, so that its agreement with
a generated program says something about both.
"""
