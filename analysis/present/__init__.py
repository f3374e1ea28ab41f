# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""An analysis as people read it: table, report, pictures, JSON."""
