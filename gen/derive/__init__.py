# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""What follows from a resolved system: distribution, tables, priorities, tasks, identifiers."""
