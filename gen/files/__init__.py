# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Model files to checked forms: text, tree, schema. Nothing here knows what a form means."""
