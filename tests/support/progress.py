# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""What a command said, without the lines of progress that it has on a slow machine."""

from __future__ import annotations

import re

_LINE = re.compile(r"^.* \(\d+ s\)\n", re.M)


def without_progress(said: str) -> str:
    """Standard error without lines such as `checking model.yaml (2 s)`."""
    return _LINE.sub("", said)
