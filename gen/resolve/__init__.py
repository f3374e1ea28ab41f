# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Forms to a `System`: every name looked up, every type known, every place kept."""
