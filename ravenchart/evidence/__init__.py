# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The folder for an assessor: requirements traced both ways, and claims with their evidence."""
