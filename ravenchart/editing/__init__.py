# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Texts of a model while they are edited: their locations, their changes, their evaluation."""
