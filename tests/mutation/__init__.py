# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Proof mutation score: generated code broken in small ways, and who notices."""
