# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Consequences of a resolved system: distribution, tables, priorities, tasks, identifiers."""
