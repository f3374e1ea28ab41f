# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Findings of an analysis of a model: missed deadlines, claimed bounds, advice."""
