# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""From a model to its program: checked, generated, compiled; and the tools outside."""
