# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""A second opinion on a generated program, by code that shares nothing with its generator.

It reads a model, the declared form of its charts in the generated specs, and the timing
certificate. It derives from the model what these must say, and reports each disagreement with
its file and line. It needs Python's standard library and PyYAML, and no other module of
Ravenchart: a copy of this folder works alone (``python -m independent MODEL``).
"""
