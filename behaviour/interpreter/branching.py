# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Branches of a running system: copies that go on independently from the same situation."""

from __future__ import annotations

import copy
from collections import deque
from dataclasses import replace

from .machine import InstanceRun, Machine, Mailbox
from .region import RegionRun


def branched(machine: Machine) -> Machine:
    """A copy of a machine that goes on independently."""
    new = copy.copy(machine)
    new.instances = {name: _instance(one) for name, one in machine.instances.items()}
    new.earliest = dict(machine.earliest)
    return new


def _instance(run: InstanceRun) -> InstanceRun:
    new = copy.copy(run)
    new.data, new.ports = dict(run.data), dict(run.ports)
    new.mailboxes = {name: _mailbox(one) for name, one in run.mailboxes.items()}
    new.regions = {name: _region(one) for name, one in run.regions.items()}
    return new


def _mailbox(box: Mailbox) -> Mailbox:
    new = copy.copy(box)
    new.waiting = deque(box.waiting)
    return new


def _region(run: RegionRun) -> RegionRun:
    new = copy.copy(run)
    new.active, new.history, new.timers = dict(run.active), dict(run.history), dict(run.timers)
    new.completed, new.done = set(run.completed), set(run.done)
    new.deferred = [replace(kept) for kept in run.deferred]
    new.queue = deque(run.queue)
    return new
