# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The one intermediate representation, and nothing that computes: `System` and its records."""
