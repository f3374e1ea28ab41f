# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""What an analysis says of a model: missed deadlines, claims, advice."""
