# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""How deep the stack of each task gets, and what memory a program takes, from the compiler's words.

Ada knows nothing of it: it is read in the call graphs that the compiler writes beside the objects
(``-fcallgraph-info=su,da``) and, for the run-time library of a board, in the image.
"""
