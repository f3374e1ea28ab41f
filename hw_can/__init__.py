# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""CAN: the Ada layers below, and the Python bench in `hw_can.bench`."""
