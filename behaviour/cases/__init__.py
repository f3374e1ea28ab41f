# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Test cases of charts: event files that take every transition and decide every guard both ways."""
