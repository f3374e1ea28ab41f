# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Ada as nodes, their only printer, and the names of generated units."""
