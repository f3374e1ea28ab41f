# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Texts of a model while they are edited: where they say what, and what they come to."""
