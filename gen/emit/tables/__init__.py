# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The rows of processors in Ada: what is executed, and what the trace says of it."""
