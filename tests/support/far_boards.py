# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""A board of the pump at the far end of a serial line, which is a pseudo-terminal."""

from __future__ import annotations

import os
import tty

from tests.support.snapshot_files import trace_map

HEAD = ("E 71234", f"M {trace_map().digest}")
"""What a board says at its start."""


class Board:
    """The far end of a serial line."""

    def __init__(self) -> None:
        self.end, inner = os.openpty()
        tty.setraw(inner)
        self.port = os.ttyname(inner)
        self._inner = inner

    def says(self, *lines: str) -> None:
        """Write these lines."""
        self.writes("".join(f"{line}\r\n" for line in lines))

    def writes(self, text: str) -> None:
        """Write this, a line or not; the watcher reads meanwhile."""
        rest = text.encode()
        while rest:
            rest = rest[os.write(self.end, rest[:512]) :]

    def unplugged(self) -> None:
        """The device is gone."""
        os.close(self.end)
        self.end = -1

    def close(self) -> None:
        """Give all back."""
        if self.end >= 0:
            os.close(self.end)
        os.close(self._inner)
