# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""`python -m ravenchart`: the same as the script `ravenchart`."""

from __future__ import annotations

from .start import main

if __name__ == "__main__":
    raise SystemExit(main())
