# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""What an assessor gets: requirements traced both ways, and claims with what shows them."""
