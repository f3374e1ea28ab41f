# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The command line: it composes `gen`, `analysis` and the bench, and touches files."""
