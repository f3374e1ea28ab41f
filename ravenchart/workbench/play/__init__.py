# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Charts in motion: a model executed by the interpreter, step by step, in a local web page."""
