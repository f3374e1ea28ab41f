# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Periodic rows of a model put together anew: tables searched, and judged by the whole model."""
