# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The workbench: a model in a local web page, changed and analysed there."""
