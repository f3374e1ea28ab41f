# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""One test suite over any python-can interface that has two ends on one bus."""
