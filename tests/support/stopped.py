# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""An exception in a thread of another process, at an instruction where one can come.

A signal from outside comes anywhere, also while the C library holds a lock of its own
for the thread. An exception raised there leaves the lock taken, which no exception of
the program itself does. So the thread is stopped (ptrace, x86-64 and others of Linux)
and hit only where it executes the program's own code or waits in the kernel.
"""

from __future__ import annotations

import ctypes
import os
import signal
import time
from pathlib import Path

LIMIT = 5.0
"""So long a thread is looked for at such an instruction, in s."""

_SEIZE, _INTERRUPT, _DETACH = 0x4206, 0x4207, 17  # requests of ptrace (linux/ptrace.h)
_ALL_CHILDREN = 0x40000000  # __WALL: threads too
_RUNNING = "-1"  # /proc/PID/syscall: stopped outside the kernel

_C = ctypes.CDLL(None, use_errno=True)
_C.ptrace.argtypes = (ctypes.c_long, ctypes.c_long, ctypes.c_void_p, ctypes.c_void_p)
_C.ptrace.restype = ctypes.c_long


def raise_in(process: int, thread: int, number: signal.Signals = signal.SIGFPE) -> None:
    """Send the signal to the thread, which becomes an exception there.

    Raises TimeoutError where the thread is never at such an instruction, and OSError where
    this process may not stop it or it has ended.
    """
    until = time.monotonic() + LIMIT
    while time.monotonic() < until:
        _stop(thread)
        hit = _can_raise(process, thread)
        if hit and _C.tgkill(process, thread, int(number)) != 0:
            raise _error()
        _ask(_DETACH, thread)
        if hit:
            return
        time.sleep(0.001)
    raise TimeoutError(f"thread {thread} never stood in code of its own")


def _stop(thread: int) -> None:
    _ask(_SEIZE, thread)
    _ask(_INTERRUPT, thread)
    os.waitpid(thread, _ALL_CHILDREN)


def _ask(request: int, thread: int) -> None:
    if _C.ptrace(request, thread, None, None) != 0:
        raise _error()


def _error() -> OSError:
    number = ctypes.get_errno()
    return OSError(number, os.strerror(number))


def _can_raise(process: int, thread: int) -> bool:
    """Whether the stopped thread waits in the kernel, or executes the program itself."""
    called, *_, address = Path(f"/proc/{process}/task/{thread}/syscall").read_text().split()
    if called != _RUNNING:
        return True
    program = str(Path(f"/proc/{process}/exe").readlink())
    for line in Path(f"/proc/{process}/maps").read_text().splitlines():
        if line.endswith(program):
            first, last = line.split()[0].split("-")
            if int(first, 16) <= int(address, 16) < int(last, 16):
                return True
    return False
