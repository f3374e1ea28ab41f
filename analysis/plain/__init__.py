# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Task sets from plain files: CSV and JSON in, records of `analysis.core` out, and results.

The columns are described in docs/plain-files.md.
"""
