# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The geometry of charts: where vertices stand, what a transition leaves and enters."""
