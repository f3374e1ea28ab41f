# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Timing analysis of a `System`: response times, bus load, and the report."""
