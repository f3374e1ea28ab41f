# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Buses in Ada: codecs, layout tables, controllers; and the DBC."""
