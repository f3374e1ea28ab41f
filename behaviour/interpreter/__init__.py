# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Charts executed as modelled, in virtual time, by docs/semantics.md."""
