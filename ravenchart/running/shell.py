# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The commands of `ravenchart shell`: lines of text carried out on a `RemoteSystem`.

The words are those of a scenario's steps: `send`, `wait_for`, `wait`, `replay`, `pull`, `release`.
"""

from __future__ import annotations

import re
import shlex
import time
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

from rich.console import Console
from rich.markup import escape
from rich.table import Table

from ravenchart import rounded
from ravenchart.hw_can.bench.peer import FrameValues, Value
from ravenchart.hw_can.bench.quantities import time_of

from .chart_states import in_words
from .remote import PATIENCE, RemoteSystem
from .vocabulary import BusVocabulary, WordError, hint_of

USAGES: Mapping[str, tuple[str, str]] = {
    "send": ("NAME [FIELD=VALUE ...]", "send a message, or a command of one"),
    "wait_for": ("NAME VALUE [TIME]", f"wait for a value or state (at most {PATIENCE:g} s)"),
    "wait": ("TIME", "let time pass: 500 ms, 2 s"),
    "status": ("[NAME ...]", "last values of messages, states of charts"),
    "replay": ("FILE", "send the frames of a log that come from outside"),
    "pull": ("DRIVE low|high", "press a limit switch of a simulated drive"),
    "release": ("DRIVE", "let go of its limit switches"),
    "help": ("[NAME]", "show this, or the fields or states of a name"),
    "quit": ("", "end (Ctrl-D)"),
}
"""Each command: what stands behind it, and what it does."""

_WHOLE = re.compile(r"[+-]?\d[\d_]*")
_FRACTION = re.compile(r"[+-]?\d[\d_]*\.\d+")


@dataclass(slots=True)
class Shell:
    """Carries out lines; what they answer is printed to ``out``."""

    robot: RemoteSystem
    out: Console

    @property
    def words(self) -> BusVocabulary:
        """The messages of the bus, with their fields and values."""
        return self.robot.vocabulary

    def do(self, line: str) -> bool:
        """Carry out a line; False where it asks for the end.

        Raises WordError, NoAnswerError and BenchError, whose text is for the user.
        """
        try:
            verb, *told = shlex.split(line, comments=True) or [""]
        except ValueError as fault:
            raise WordError(f"the line cannot be read: {str(fault).lower()}") from None
        if verb in ("", "quit", "exit"):
            return verb == ""
        actions: Mapping[str, Callable[[Sequence[str]], None]] = {
            "send": self._send,
            "wait_for": self._wait_for,
            "wait": self._wait,
            "status": self._status,
            "replay": self._replay,
            "pull": self._pull,
            "release": self._release,
            "help": self._help,
        }
        if verb not in actions:
            known = verb in self.words.commands or verb in self.words.messages
            hint = f"write `send {verb}`" if known else hint_of(verb, USAGES)
            raise WordError(f"there is no command `{verb}`", hint)
        actions[verb](told)
        return True

    # --- the commands

    def _send(self, told: Sequence[str]) -> None:
        name, *given = self._at_least("send", told, 1)
        fields: dict[str, Value] = {}
        for word in given:
            field, equals, text = word.partition("=")
            if not equals:
                raise WordError(f"`{word}` is not `FIELD=VALUE`", usage("send"))
            if field in fields:
                raise WordError(f"`{field}` is given twice")
            fields[field] = value_of(text)
        sent = self.robot.send(name, **fields)
        self._say(f"sent {sent.message}: {shown(sent.values)}")

    def _wait_for(self, told: Sequence[str]) -> None:
        name, text, *limit = self._at_least("wait_for", told, 2)
        timeout = _time(limit, "wait_for") if limit else PATIENCE
        took = self.robot.wait_for(name, value_of(text), timeout)
        self._say(f"{name} is {text} after {rounded.up(rounded.of_seconds(took))}")

    def _wait(self, told: Sequence[str]) -> None:
        time.sleep(_time(self._at_least("wait", told, 1), "wait"))

    def _status(self, told: Sequence[str]) -> None:
        messages, charts = self._named(told)
        last, seen = self.robot.status, self.robot.charts
        if not told:
            messages = [m for m in self.words.messages if m in last or self._is_sent(m)]
            charts = [*seen]
        table = _columns("message", "age s", "values")
        for name in messages:
            age = _age(self.robot.age(name)) if name in last else "-"
            values = self._with_units(name, last[name]) if name in last else "none came"
            table.add_row(name, age, escape(values))
        if messages:
            self.out.print(table)
        table = _columns("chart", "age s", "state")
        for name in charts:
            age = _age(time.monotonic() - seen[name].at) if name in seen else "-"
            table.add_row(name, age, in_words(seen[name]) if name in seen else "not seen")
        if charts:
            self.out.print(table)

    def _named(self, told: Sequence[str]) -> tuple[list[str], list[str]]:
        """The messages and the charts of these names."""
        messages: list[str] = []
        charts: list[str] = []
        for name in told:
            chart = None if name in self.words.messages else self.words.chart(name)
            if chart is not None:
                charts.append(chart.name)
            elif name in self.words.messages:
                messages.append(name)
            else:
                known = [*self.words.messages, *self.words.charts]
                raise WordError(f"there is no message or chart `{name}`", hint_of(name, known))
        return messages, charts

    def _replay(self, told: Sequence[str]) -> None:
        (file,) = self._exactly("replay", told, 1)
        count = self.robot.replay(Path(file))
        self._say(f"{count} frames sent")

    def _pull(self, told: Sequence[str]) -> None:
        drive, switch = self._exactly("pull", told, 2)
        ends: Mapping[str, Literal["low", "high"]] = {"low": "low", "high": "high"}
        if switch not in ends:
            raise WordError(f"there is no limit switch `{switch}`", usage("pull"))
        self.robot.pull(drive, ends[switch])

    def _release(self, told: Sequence[str]) -> None:
        (drive,) = self._exactly("release", told, 1)
        self.robot.release(drive)

    def _help(self, told: Sequence[str]) -> None:
        words = self.words
        if not told:
            for verb, (arguments, does) in USAGES.items():
                self._say(f"{f'{verb} {arguments}':<31} {does}")
            self._say(f"\nto send: {', '.join([*words.commands, *words.outside()]) or 'nothing'}")
            own = [one for one in words.observable() if self._is_sent(one.partition(".")[0])]
            own += self.words.charts
            self._say(f"to wait for: {', '.join(own) or 'nothing'}")
            return
        for name in told:
            message = words.commands[name][0] if name in words.commands else name
            if name in USAGES:
                self._say(f"{name} {USAGES[name][0]}".rstrip() + f": {USAGES[name][1]}")
            elif message in words.messages:
                self._say(f"{message}:")
                for field, signal in words.fields(message).items():
                    self._say(f"  {field}: {words.range_of(message, signal)}")
            elif (chart := words.chart(name)) is not None:
                self._say(f"{chart.name}: one of {', '.join(chart.states)}")
            else:
                known = [*USAGES, *words.commands, *words.messages, *words.charts]
                wrong = f"there is no command, message or chart `{name}`"
                raise WordError(wrong, hint_of(name, known))

    # --- what they share

    def _say(self, text: str) -> None:
        self.out.print(text, markup=False)

    def _is_sent(self, message: str) -> bool:
        """Whether a node of the model sends it."""
        return message not in self.words.outside()

    def _with_units(self, message: str, values: FrameValues) -> str:
        units = {name: one.unit for name, one in self.words.fields(message).items()}
        named = {name: value for name, value in values.items() if name in units}
        told = (f"{n} {v}{f' {units[n]}' if units[n] else ''}" for n, v in named.items())
        return ", ".join(told)

    def _at_least(self, verb: str, told: Sequence[str], count: int) -> Sequence[str]:
        if len(told) < count:
            raise WordError(f"`{verb}` is incomplete", usage(verb))
        return told

    def _exactly(self, verb: str, told: Sequence[str], count: int) -> Sequence[str]:
        if len(told) > count:
            raise WordError(f"`{told[count]}` is too much", usage(verb))
        return self._at_least(verb, told, count)

    # --- completion

    def completions(self, before: str, begun: str) -> list[str]:
        """The words that ``begun`` may become, after the text ``before`` it on the line."""
        verb, *told = before.replace("=", " = ").split() or [""]
        if not verb:
            found: Iterable[str] = USAGES
        else:
            found = self._words_of(verb, told)
        return sorted(one for one in found if one.startswith(begun))

    def _words_of(self, verb: str, told: Sequence[str]) -> Iterable[str]:
        words = self.words
        match verb, [*told]:
            case ("send", []):
                return [*words.commands, *words.outside()]
            case ("send", [name, *given]):
                message = words.commands.get(name, (name, ""))[0]
                if message not in words.outside():
                    return []
                fields = words.fields(message)
                if given and given[-1] == "=":
                    return self._values(f"{message}.{given[-2]}")
                own = words.commands.get(name, ("", ""))[1]
                return [f"{one}=" for one in fields if one != own and one not in given]
            case ("wait_for", []):
                return [*words.observable(), *words.charts]
            case ("wait_for", [name]):
                return self._values(name)
            case ("status", _):
                return [*words.messages, *words.charts]
            case ("help", _):
                return [*USAGES, *words.commands, *words.messages, *words.charts]
            case ("pull", []) | ("release", []):
                return self.robot.drives
            case ("pull", [_]):
                return ("low", "high")
        return []

    def _values(self, name: str) -> list[str]:
        """The names that a field's values have, or the states of a chart."""
        try:
            chart = self.words.chart(name)
            if chart is not None:
                return [*chart.states]
            _, signal = self.words.signal(name)
        except WordError:
            return []
        return [str(choice) for choice in (signal.choices or {}).values()]


def _age(seconds: float) -> str:
    return rounded.age(rounded.of_seconds(seconds))


def _columns(name: str, age: str, what: str) -> Table:
    table = Table(box=None, pad_edge=False, padding=(0, 2, 0, 0), header_style="dim")
    table.add_column(name, no_wrap=True)
    table.add_column(age, justify="right", no_wrap=True)
    table.add_column(what, overflow="fold")
    return table


def usage(verb: str) -> str:
    """How a command is written."""
    return f"write `{f'{verb} {USAGES[verb][0]}'.rstrip()}`"


def value_of(text: str) -> Value:
    """A number where it reads as one, with `_` between digits as it likes; else a name."""
    if _WHOLE.fullmatch(text):
        return int(text)
    return float(text) if _FRACTION.fullmatch(text) else text


def shown(values: Mapping[str, Value]) -> str:
    """``a 1, b 2``"""
    return ", ".join(f"{name} {value}" for name, value in values.items())


def _time(told: Sequence[str], verb: str) -> float:
    text = " ".join(told)
    try:
        return time_of(text)
    except ValueError as fault:
        raise WordError(f"`{text}` is no time: it must be {fault}", usage(verb)) from None
