# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Model to System to SPARK Ada: the generator half of Ravenchart."""
