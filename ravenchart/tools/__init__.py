# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Programs outside, as children that end with us; and what is kept between calls."""
