# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The other side of the bus: simulated drives, a python-can peer, and scenarios."""
