# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The language server: what an editor asks of a model while it is written (LSP 3.17)."""
