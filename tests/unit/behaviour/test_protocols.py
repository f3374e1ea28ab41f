# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Protocols of interfaces: clients that follow them, that break them, and that nobody can judge."""

from __future__ import annotations

import random
import re
from collections.abc import Iterable
from pathlib import Path

import pytest

from ravenchart.behaviour.rules import findings
from ravenchart.building import checking, generation
from ravenchart.editing.evaluation import over
from ravenchart.gen.diagnostics import Diagnostic
from ravenchart.gen.emit.program import generate
from ravenchart.gen.model.system import System
from ravenchart.gen.pipeline import load
from ravenchart.paths import ROOT
from tests.support.effort import seeds
from tests.support.protocol_model import DOOR, PROTOCOL, door

GRIPPER = ROOT / "tests" / "nodes" / "gripper" / "model.yaml"
MODEL = Path("model.yaml")


def loaded(text: str, path: Path = MODEL) -> tuple[System | None, list[Diagnostic]]:
    """The model, and its errors."""
    found = load(path, over({str(path): text.encode()}))
    return found.system, [one for one in found.diagnostics if one.is_error]


def judged(text: str, path: Path = MODEL) -> list[Diagnostic]:
    """The findings about protocols."""
    system, errors = loaded(text, path)
    assert system is not None, errors
    return [one for one in findings(system) if one.code in ("RV-1112", "RV-1113")]


def test_a_client_that_follows_the_protocol_is_accepted() -> None:
    assert judged(door()) == []


@pytest.mark.parametrize(
    ("old", "new", "command", "way", "at"),
    [
        ("effect: [{call: Ping}]", "effect: [{call: Move, with: 50}]",
         "Move", "Closed -Stop-> Closed", "ping"),
        ("{call: Move, with: 0}, {call: Disable}, ", "{call: Move, with: 0}, ",
         "Enable", "Closed -Open-> Opened -Close-> Closed -Open-> Opened", "open"),
        ("[Enable, Move, Disable, Ping, Get", "[Move, Enable, Disable, Ping, Get",
         "Move", "Closed -Open-> Opened", "open"),
        ("effect: [{call: Move, with: 50}]", "effect: [{if: seen > 50, then: [{call: Disable}]}]",
         "Move", "Sequence: Closed -Open-> Opened; note runs; "
         "Sequence: Opened -Stop-> Opened -Close-> Closed", "close"),
    ],
)  # fmt: skip
def test_a_call_that_the_state_does_not_allow_is_an_error_with_the_steps_to_it(
    old: str, new: str, command: str, way: str, at: str
) -> None:
    text = door((old, new))
    message = f"Door calls {command} where Motion does not allow it: {way}"
    (found,) = (one for one in judged(text) if one.message == message)
    assert found.code == "RV-1112" and found.hint is not None
    assert found.notes[0][1].startswith(f"Motion allows {command} in: ")
    assert found.notes[1][1] == "door_1 calls drive_1.Motion"
    assert text.splitlines()[found.origin.line - 1].strip().startswith(f"{at}:")


def test_a_self_transition_makes_the_calls_of_exit_and_entry_in_one_step() -> None:
    text = door(
        ("{call: Enable}, {call: Move, with: 100}", "{call: Enable}"),
        ("{call: Move, with: 0}, {call: Disable}", "{call: Disable}"),
        ("{from: Opened, on: Stop, effect: [{call: Move, with: 50}]}",
         "{from: Opened, to: Opened, on: Stop}"),
    )  # fmt: skip
    (found,) = judged(text)  # Enable comes before Disable
    assert found.message.endswith("Closed -Open-> Opened -Stop-> Opened")
    assert " calls Enable " in found.message


def test_calls_of_one_step_are_made_in_the_order_of_the_interface() -> None:
    entry = "[{call: Enable}, {call: Move, with: 100}", "[{call: Move, with: 100}, {call: Enable}"
    assert judged(door(entry)) == []


def test_the_order_is_told_of_the_commands_that_the_client_calls() -> None:
    order = "the calls of one step are made in order: "
    exits = "{call: Move, with: 0}, {call: Disable}, "
    stop = ("stop: {from: Opened, on: Stop, effect: [{call: Move, with: 50}]}",
            "stop: {from: Opened, on: Stop}")  # fmt: skip
    for calls, told in (
        ("{call: Enable}", []),  # Ping and Get_Opening are no commands of the protocol
        ("{call: Enable}, {call: Move, with: 100}", [f"{order}Enable, Move"]),
    ):
        entry = ("{call: Enable}, {call: Move, with: 100}", calls)
        (found,) = judged(door((exits, ""), entry, stop))
        assert " calls Enable " in found.message
        assert [text for _, text in found.notes if text.startswith(order)] == told


def test_a_guard_that_keeps_to_the_protocol_is_seen() -> None:
    before, guarded = "effect: [{call: Ping}]", "guard: ready, effect: [{call: Move, with: 50}]"
    assert judged(door((before, guarded))) == []


@pytest.mark.parametrize(
    ("change", "reason"),
    [
        (("body: [{set: seen, to: Get_Opening}]", "body: [{set: seen, to: Get_Opening}, "
          "{call: Disable}]"), "Sequence and note both call, and their order is not fixed"),
        (("body: [{set: seen, to: Get_Opening}]", "calls: [Enable], writes: [seen], "
          "reads: [Get_Opening], body: user"), "Sequence and note both call"),
    ],
)  # fmt: skip
def test_calls_whose_order_is_not_known_are_named(change: tuple[str, str], reason: str) -> None:
    (found,) = judged(door(change))
    assert found.code == "RV-1113" and reason in found.message


def test_the_body_of_a_user_may_call_in_any_order() -> None:
    calls = "            entry: [{call: Enable}, {call: Move, with: 100}, {set: ready, to: true}]\n"
    exits = "            exit: [{call: Move, with: 0}, {call: Disable}, {set: ready, to: false}]\n"
    body = "calls: [Enable, Move, Disable], writes: [seen, ready], reads: [Get_Opening], body: user"
    stop = ", effect: [{call: Move, with: 50}]"
    (found,) = judged(
        door(
            (calls, "            entry: [{call: Ping}]\n"),
            (exits, ""),
            (stop, ""),
            ("body: [{set: seen, to: Get_Opening}]", body),
        )
    )
    assert "the body of note is the user's" in found.message


def test_an_activity_with_actions_is_a_client_too() -> None:
    body = "[{if: ready, then: [{call: Move, with: 1}], "
    body += "else: [{call: Enable}, {set: ready, to: true}]}]"
    for text, codes in ((body, []), (body.replace("Enable", "Disable"), ["RV-1112"])):
        found = judged(
            door(
                ("[{call: Enable}, {call: Move, with: 100}, {set: ready, to: true}]", "[]"),
                ("[{call: Move, with: 0}, {call: Disable}, {set: ready, to: false}]", "[]"),
                (", effect: [{call: Move, with: 50}]", ""),
                ("body: [{set: seen, to: Get_Opening}]", f"body: {text}"),
            )
        )
        assert [one.code for one in found][:1] == codes


@pytest.mark.parametrize(
    ("protocol", "code", "message"),
    [
        (PROTOCOL.replace("{from: On, on: Move}", "{from: On, on: Enable, to: Off}, "
                          "more: {from: On, on: Enable}"),
         "RV-1219", "On has two transitions for Enable"),
        (PROTOCOL.replace("on: Move", "on: Get_Opening"), "RV-1219",
         "Get_Opening is a read command: a protocol rules the order of calls"),
        (PROTOCOL.replace("[Off, On]", "[Off, On, Broken]"), "RV-1219",
         "no transitions lead from Off to the state Broken"),
        (PROTOCOL.replace("initial: Off", "initial: Of"), "RV-0305",
         "there is no state of the protocol of Motion named `Of`"),
        (PROTOCOL.replace("on: Move", "on: Moove"), "RV-0305",
         "there is no command of Motion named `Moove`"),
        (PROTOCOL.replace("[Off, On]", "[Off, On, off]"), "RV-0303",
         "a second state of the protocol of Motion is named `off`, like `Off`: "
         "case does not count"),
    ],
)  # fmt: skip
def test_a_wrong_protocol_is_one_error(protocol: str, code: str, message: str) -> None:
    _, errors = loaded(door(protocol=protocol))
    assert [(one.code, one.message) for one in errors] == [(code, message)]


def test_the_program_is_the_same_with_and_without_a_protocol(tmp_path: Path) -> None:
    path = tmp_path / "model.yaml"
    made = []
    for text in (door(), door().replace(f", protocol: {PROTOCOL}", "")):
        path.write_text(text, encoding="utf-8")
        checked = checking.check(path)
        files = generate(checked.system, generation.claims(checked))
        made.append({name: re.sub("[0-9a-f]{64}", "digest", made) for name, made in files.items()})
    assert made[0] == made[1] and len(made[0]) > 10


def test_devices_arrays_and_other_nodes_have_protocols_too() -> None:
    text = GRIPPER.read_text(encoding="utf-8")
    finger = "provides: {Get_Width: 10 us, Set_Force: 10 us, Open_Up: 5 us}"
    rule = "protocol: {initial: Shut, states: [Shut, Open], transitions: {"
    right = "open: {from: Shut, to: Open, on: Open_Up}, press: {from: Open, on: Set_Force}}}"
    wrong = "press: {from: Shut, to: Open, on: Set_Force}, open: {from: Open, on: Open_Up}}}"
    assert text.count(finger) == 1
    assert judged(text.replace(finger, f"{finger}\n    {rule}{right}"), GRIPPER) == []
    found = judged(text.replace(finger, f"{finger}\n    {rule}{wrong}"), GRIPPER)
    assert found[0].message.startswith("Grasp calls Open_Up where Finger does not allow it: ")
    queued = "        commands: [Grip]\n"
    once = "        protocol: {initial: Unused, states: [Unused, Used], transitions: "
    once += "{grip: {from: Unused, to: Used, on: Grip}}}\n"
    assert text.count(queued) == 1
    found = judged(text.replace(queued, queued + once), GRIPPER)
    assert found[0].message.startswith("Boss calls Grip where Work does not allow it: ")


def test_a_large_protocol_that_is_followed_is_proved() -> None:
    """CiA 402 has eight states; the client goes round in a ring of them."""
    size = 8
    steps = ", ".join(
        f"t{n}: {{from: S{n}, to: S{(n + 1) % size}, on: {('Enable', 'Move', 'Disable')[n % 3]}}}"
        for n in range(size)
    )
    protocol = f"{{initial: S0, states: [{', '.join(f'S{n}' for n in range(size))}], "
    protocol += f"transitions: {{{steps}}}}}"
    calls = [
        ("{call: Enable}", "{call: Move, with: 1}", "{call: Disable}")[n % 3] for n in range(size)
    ]
    lines = "".join(
        f"          m{n}: {{from: L{n}, to: L{(n + 1) % size}, on: Open, effect: [{calls[n]}]}}\n"
        for n in range(size)
    )
    start, end = DOOR.index("        initial: Closed"), DOOR.index("    activities:\n      note")
    chart = "        initial: L0\n        states:\n"
    chart += "".join(f"          L{n}: {{}}\n" for n in range(size)) + "        transitions:\n"
    text = (DOOR[:start] + chart + lines + DOOR[end:]).replace("PROTOCOL", protocol)
    assert judged(text) == []
    assert judged(text.replace("effect: [{call: Disable}]", "effect: [{call: Ping}]", 1)) != []


def test_only_the_instances_that_are_bound_to_the_provider_are_judged() -> None:
    free = "effect: [{call: Move, with: 50}]}\n          ping: {from: Closed, on: Stop, "
    text = door(
        ("effect: [{call: Move, with: 50}]}\n          ping: {from: Closed, on: Stop, ",
         free + "guard: free, "),
        ("effect: [{call: Ping}]", "effect: [{call: Move, with: 1}]"),
        ("  Door:\n", "  Door:\n    parameters: {free: {type: Boolean}}\n"),
        ("  Door:\n", "  Loose:\n    provides:\n      Motion: {queue: 4, served_by: serve, "
         "commands: [Enable, Move, Disable, Ping], published: {Get_Opening: opening}}\n"
         "    data:\n      opening: {type: Opening, initial: 0}\n    activities:\n      serve: "
         "{period: 10 ms, wcet: 50 us, writes: [opening], body: user}\n  Door:\n"),
        ("  door_1: {component: Door, node: board}\n",
         "  door_1: {component: Door, node: board, parameters: {free: false}}\n"
         "  door_2: {component: Door, node: board, parameters: {free: true}}\n"
         "  loose_1: {component: Loose, node: board}\n"),
        ("bindings:\n", "bindings:\n  - {from: door_2.Gate, to: loose_1.Motion}\n"),
        ("drive_1.serve]", "drive_1.serve, door_2.Sequence, door_2.note, loose_1.serve]"),
    )  # fmt: skip
    assert judged(text) == []
    assert judged(text.replace("free: false", "free: true")) != []


@pytest.mark.parametrize(
    "change",
    [
        ("commands: [Enable, Move, Disable, Ping], pub", "commands: [Enable, Mvoe, Disable], pub"),
        ("Move: {kind: write,", "Move: {kind: wrote,"),
        ("Move: {kind: write,", "Move: {kinf: write,"),
        ("argument: Opening}", "argument: Openin}"),
    ],
)
def test_a_mistake_in_a_command_is_no_second_error_in_the_protocol(change: tuple[str, str]) -> None:
    _, errors = loaded(door(change))
    assert not [one for one in errors if "of Motion named" in one.message]


# --- beside an exploration of pairs of states


def _reached(start: str, steps: Iterable[tuple[tuple[str, str], str]]) -> set[str]:
    """The states that steps ((from, on), to) lead to."""
    known, each = {start}, list(steps)
    for _ in each:
        known |= {to for (at, _), to in each if at in known}
    return known


def random_client(seed: int) -> tuple[str, set[str]]:
    """A model with a random chart and protocol; the commands that pairs of their states misuse."""
    choice = random.Random(seed)
    commands = ("Enable", "Move", "Disable")
    states = ("P", "Q", "R")[: choice.randint(2, 3)]
    follows = {
        (state, command): choice.choice(states)
        for state in states
        for command in commands
        if choice.random() < 0.75 or (state, command) == ("P", "Enable")
    }
    states = tuple(one for one in states if one in _reached("P", follows.items()))
    follows = {key: to for key, to in follows.items() if key[0] in states}
    steps = ", ".join(
        f"t{n}: {{from: {at}, to: {to}, on: {command}}}"
        for n, ((at, command), to) in enumerate(follows.items())
    )
    protocol = f"{{initial: P, states: [{', '.join(states)}], transitions: {{{steps}}}}}"
    leaves = ["A", "B", "C"]
    moves = [
        (choice.choice(leaves), choice.choice(("Open", "Close", "Stop")), choice.choice(leaves),
         choice.sample(commands, choice.randint(0, 2)))
        for _ in range(5)
    ]  # fmt: skip
    moves = list({(at, event): (at, event, to, calls) for at, event, to, calls in moves}.values())
    leaves = sorted(_reached("A", (((at, ""), to) for at, _, to, _ in moves)))
    moves = [one for one in moves if one[0] in leaves]

    def argued(command: str) -> str:
        return f"{{call: {command}, with: 1}}" if command == "Move" else f"{{call: {command}}}"

    lines = "".join(
        f"          m{n}: {{from: {at}, to: {to}, on: {event}, "
        f"effect: [{', '.join(map(argued, calls))}]}}\n"
        for n, (at, event, to, calls) in enumerate(moves)
    )
    start, end = DOOR.index("        initial: Closed"), DOOR.index("    activities:\n      note")
    chart = "        initial: A\n        states:\n"
    chart += "".join(f"          {leaf}: {{}}\n" for leaf in leaves)
    chart += "        transitions:\n" if moves else ""
    text = (DOOR[:start] + chart + lines + DOOR[end:]).replace("PROTOCOL", protocol)
    seen, found, todo = {("A", "P")}, set(), [("A", "P")]
    while todo:
        leaf, state = todo.pop()
        for at, _, to, calls in moves:
            now: str | None = state
            for command in (one for one in commands if at == leaf and one in calls):
                if now is not None and (now, command) not in follows:
                    if any(one == command for _, one in follows):
                        found.add(command)
                        now = None
                elif now is not None:
                    now = follows[now, command]
            if at == leaf and now is not None and (to, now) not in seen:
                seen.add((to, now))
                todo.append((to, now))
    return text, found


@pytest.mark.parametrize("seed", seeds(20, 200))
def test_the_misuses_are_those_of_the_pairs_of_states(seed: int) -> None:
    text, expected = random_client(seed)
    system, errors = loaded(text)
    assert system is not None, errors
    found = [one for one in findings(system) if one.code in ("RV-1112", "RV-1113")]
    assert all(one.code == "RV-1112" for one in found)
    assert {one.message.split()[2] for one in found} == expected
