# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The declared form in the generated specs, against the charts of the model."""

from __future__ import annotations

import re
from collections.abc import Sequence
from pathlib import Path

from . import ada
from .ada import Token, alternatives, cases, elements, enumeration, split, words
from .chart import TOP, Chart, Line, Region, domain_of, key_of
from .findings import Report, UnusableError
from .model import Model

Words = tuple[str, ...]

OTHERS = "and or not if then else abs min max clamp fresh stale neverreceived in event true false"
KEYWORDS = frozenset(OTHERS.split())
"""Words of the expression language that have other forms in Ada."""
NUMBER = re.compile(r"\b0[xX][0-9A-Fa-f_]+\b")
"""A number of the expression language that is not decimal."""
STOPS = words("if D = Ending then (others => Ravenchart.Timers.Stopped) else")
"""The condition before the elements of time-outs."""
SIGNS = ("<", "<=", ">", ">=", "/=")


def check_component(model: Model, component: str, folder: Path, report: Report) -> None:
    """All charts of a component."""
    form = model.section("components").map(component)
    for name, region in form.map("regions").maps():
        root, home = model.home(component, folder)
        spec = _spec(home, f"{root}-{component}")
        chart = Chart(name, region, form.map("activities"))
        _Comparison(chart, ada.read(spec), spec, report).states()
        path = spec.with_name(f"{spec.stem}-{name.lower()}.ads")
        _Comparison(chart, ada.read(path), path, report, ada.read(spec)).lines()


def _spec(folder: Path, stem: str) -> Path:
    """The spec of a component; its name may have got a kind where Ada needs it."""
    for tail in ("", "_type"):
        path = folder / f"{stem.lower()}{tail}.ads"
        if path.is_file():
            return path
    raise UnusableError(f"{folder / stem.lower()}.ads is missing: generate the program again")


class _Comparison:
    """One chart and one file."""

    def __init__(
        self,
        chart: Chart,
        items: Sequence[Token],
        path: Path,
        report: Report,
        states: Sequence[Token] | None = None,
    ) -> None:
        self.chart, self.items, self.path, self.report = chart, items, path, report
        self.package = f"{chart.name}_States"
        self.declared = _inside(items if states is None else states, self.package)
        self.regions = chart.concurrent_regions()
        self.several = len(self.regions) > 1
        self.literals = {
            token.low
            for region in self.regions
            for token in enumeration(self.declared, _type_of(region))
        } | {items[1].low for items in self._subtypes()}

    def _subtypes(self) -> list[list[Token]]:
        """`subtype NAME is TYPE range FIRST .. LAST` in the package of states."""
        parts = split(self.declared, ";")
        return [part for part in parts if len(part) == 8 and part[0].low == "subtype"]

    def agree(self, kind: str, line: int, holds: bool, text: str) -> None:
        """One comparison in this file."""
        self.report.agree(kind, self.path, line, holds, text)

    # --- states

    def literal(self, vertex: str) -> str:
        """A state as Ada names it."""
        own = vertex.lower()
        kind = f"{own}_state"
        return kind if own not in self.literals and kind in self.literals else own

    def states(self) -> None:
        """The enumerations of leaves, and the composites as ranges of them."""
        line = self.declared[0].line if self.declared else 1
        for region in self.regions:
            found = enumeration(self.declared, _type_of(region))
            at = found[0].line if found else line
            said = [token.low for token in found]
            wanted = [self.literal(name) for name in self.chart.leaves(region)]
            for name in wanted:
                place = said.index(name) if name in said else 0
                here = found[place].line if found else at
                text = f"the state {name} is not among the leaves {_type_of(region)}"
                self.agree("states", here, name in said, text)
            for token in found:
                text = f"{token.text} is no state of the model in {self.chart.name}"
                self.agree("states", token.line, token.low in wanted, text)
            if sorted(said) == sorted(wanted):
                text = f"the leaves are not in the order of the model: {', '.join(wanted)}"
                self.agree("states", at, said == wanted, text)
        ranges = {part[1].low: part for part in self._subtypes()}
        composites = [v for v in self.chart.vertices.values() if v.is_range]
        for vertex in composites:
            leaves = [self.literal(name) for name in self.chart.leaves(vertex.inside[0])]
            part = ranges.pop(self.literal(vertex.name), None)
            said = [part[5].low, part[7].low] if part else []
            text = f"{vertex.name} is {' .. '.join(said) or 'missing'}, by the model "
            text += f"{leaves[0]} .. {leaves[-1]}"
            at = part[0].line if part else line
            self.agree("states", at, said == [leaves[0], leaves[-1]], text)
        for part in ranges.values():
            text = f"{part[1].text} is no composite state of the model"
            self.agree("states", part[0].line, False, text)

    # --- lines

    def lines(self) -> None:
        """The functions of the declared form, line by line."""
        wanted = self.chart.lines()
        tables = {name: cases(self.items, name) for name in ("Enabled", "In_Source", "Target")}
        listed = enumeration(self.items, "Selection")
        said = [token.low for token in listed]
        names = [self._name(line, said) for line in wanted]
        domains = [line.domain for line in wanted]
        order = ["initial_entry", *names, "none"]
        for token in listed:
            text = f"{token.text} is no transition of {self.chart.name} in the model"
            self.agree("transitions", token.line, token.low in order, text)
        at = listed[0].line if listed else 1
        for name, line in zip(names, wanted, strict=True):
            where = f"{line.place.file}:{line.place.line}"
            text = f"the transition {name} of the model ({where}) is missing"
            self.agree("transitions", at, name in said, text)
        if sorted(said) == sorted(order):
            text = f"the order of precedence is not that of the model: {', '.join(order)}"
            self.agree("transitions", at, said == order, text)
        self._extra(tables, order)
        self._asks_for_source(bool(wanted))
        start = tables["Target"].get("initial_entry")
        begins = {name: self._line_of(table) for name, table in tables.items()}
        self._target("initial_entry", start, self.chart.entered(TOP, []), begins["Target"])
        for name, line in zip(names, wanted, strict=True):
            source, enabled = tables["In_Source"].get(name), tables["Enabled"].get(name)
            self._source(name, line, source, begins["In_Source"])
            self._enabled(name, line, enabled, begins["Enabled"])
            target = tables["Target"].get(name)
            if line.restores:
                self._restored(name, line, target, begins["Target"])
            else:
                self._target(name, target, line.target or {}, begins["Target"])
        self._domains({"initial_entry": "beginning"} | dict(zip(names, domains, strict=True)))
        self._timers()
        self._occurrences(wanted)

    def _line_of(self, table: dict[str, tuple[Token, list[Token]]]) -> int:
        """Where a function begins."""
        first = next(iter(table.values()), None)
        return 1 if first is None else first[0].line

    def _name(self, line: Line, said: list[str]) -> str:
        """A line as Ada names it."""
        own = line.name.lower()
        return f"{own}_transition" if own not in said and f"{own}_transition" in said else own

    def _extra(
        self, tables: dict[str, dict[str, tuple[Token, list[Token]]]], order: list[str]
    ) -> None:
        """Lines of functions that are no transitions; a chart without any has `None`."""
        for name, table in tables.items():
            for choice, (token, _) in table.items():
                text = f"{name} has a line for {token.text}, which the model does not have"
                empty = choice == "none" and len(order) == 2
                holds = choice in order[:-1] or empty
                self.agree("transitions", token.line, holds, text)

    def active(self, holder: str, vertex: str) -> list[Words]:
        """The conditions for a state to be active, or one inside it."""
        at = self.chart.at(vertex)
        region = TOP if at.kind == "terminate" else self.chart.concurrent_region(vertex)
        leaf = f"{holder}.{key_of(region)}" if self.several else holder
        sign = "in" if at.is_range else "="
        own = words(f"{leaf} {sign} {self.package}.{self.literal(vertex)}")
        return [*(self.active(holder, region[0]) if region[0] is not None else []), own]

    def _sources(self, line: Line) -> set[Words]:
        holder = "Configuration" if self.several else "Leaf"
        return {one for source in line.sources for one in self.active(holder, source)}

    def _asks_for_source(self, fires: bool) -> None:
        """That no transition is enabled where it does not start."""
        begins, table = alternatives(self.items, "Enabled")
        holder = "Configuration" if self.several else "Leaf"
        said = tuple(token.low for token in begins)
        text = "Enabled does not ask for the source of a transition"
        holds = said == words(f"(In_Source (T, Self.{holder}) and then") or not fires
        at = begins[0].line if begins else self._line_of(table)
        self.agree("sources", at, holds, text)

    def _source(
        self, name: str, line: Line, found: tuple[Token, list[Token]] | None, at: int
    ) -> None:
        wanted = self._sources(line)
        said = set(_conjuncts(found[1])) if found else set()
        here = found[0].line if found else at
        text = f"In_Source of {name} is {_shown(said)}, by the model {_shown(wanted)}"
        self.agree("sources", here, said == wanted, text)

    def _enabled(
        self, name: str, line: Line, found: tuple[Token, list[Token]] | None, at: int
    ) -> None:
        parts = _conjuncts(found[1]) if found else []
        here = found[0].line if found else at
        now = [part for part in parts if part[:1] == ("now",)]
        said = {word for part in now for word in part[2:] if word != "|"}
        wanted = set(line.triggers)
        text = f"Enabled of {name} has the trigger {', '.join(sorted(said)) or 'none'}, "
        text += f"by the model {', '.join(sorted(wanted))}"
        plain = len(now) == 1 and now[0][1] in ("=", "in")
        self.agree("triggers", here, plain and said == wanted, text)
        rest = [part for part in parts if part not in now]
        text = f"Enabled of {name} has {'a' if rest else 'no'} guard, and the model "
        text += "none" if rest else "one"
        self.agree("triggers", here, bool(rest) == line.conditional, text)
        self._guards(name, line, [word for part in rest for word in part], here)

    def _guards(self, name: str, line: Line, said: list[str], at: int) -> None:
        """Names, numbers and signs of guards; how they are put together is not compared."""
        parts = [part for word in said for part in word.replace("_", "").split(".")]
        guards = NUMBER.sub(lambda found: str(int(found[0], 0)), " and ".join(line.guards))
        wanted = [w.replace("_", "") for word in words(guards) for w in word.split(".")]
        names = [w for w in wanted if w[0].isalpha() and w not in KEYWORDS]
        lost = [w for w in names if not any(part.startswith(w) for part in parts)]
        counted = {w for w in wanted if w[0].isdigit() or w in SIGNS}
        lost += [w for w in sorted(counted) if wanted.count(w) > parts.count(w)]
        if guards:
            text = f"the guard `{guards}` of {name}: Enabled does not have {', '.join(lost)}"
            self.agree("guards", at, not lost, text)

    def _target(
        self,
        name: str,
        found: tuple[Token, list[Token]] | None,
        leaves: dict[str, str],
        at: int,
    ) -> None:
        wanted = {
            region if self.several else "top": words(f"{self.package}.{self.literal(leaf)}")
            for region, leaf in leaves.items()
        }
        said = self._configuration(found[1]) if found else None
        if said is not None and self.chart.ends(leaves.get("top")):
            said = {"top": said.get("top", ())}  # where all has ended, other leaves mean nothing
            wanted = {"top": wanted["top"]}
        here = found[0].line if found else at
        shown = "missing" if found is None else " ".join(t.text for t in found[1])
        by_model = ", ".join(f"{key} => {''.join(value)}" for key, value in wanted.items())
        text = f"Target of {name} is {shown}, by the model {by_model or 'as before'}"
        self.agree("targets", here, said == wanted, text)

    def _configuration(self, items: list[Token]) -> dict[str, Words]:
        """The leaves of an aggregate, or the one leaf; none where all is kept."""
        low = [token.low for token in items]
        if low == ["configuration" if self.several else "leaf"]:
            return {}
        if not self.several or low[0] != "(":
            return {"top": tuple(low)}
        inner = items[1:-1]
        is_delta = low[1:4] == ["configuration", "with", "delta"]
        found = {
            part[0].low: tuple(token.low for token in part[2:])
            for part in split(inner[3:] if is_delta else inner, ",")
        }
        whole = set(found) == {key_of(region) for region in self.regions}
        return found if is_delta != whole else {"incomplete": ()}

    def _restored(
        self, name: str, line: Line, found: tuple[Token, list[Token]] | None, at: int
    ) -> None:
        """The leaf in the region of a history is given by the function that restores it."""
        here = found[0].line if found else at
        said = self._configuration(found[1]) if found else {}
        region = key_of(self.chart.concurrent_region(line.sources[0])) if self.several else "top"
        wanted = words(f"{line.restores} (Past)")
        text = f"Target of {name} is not {line.restores} (Past) in {region}"
        self.agree("targets", here, said.get(region) == wanted, text)

    def _occurrences(self, lines: list[Line]) -> None:
        """Each event of the queue is the occurrence of its name, any other is none."""
        table = cases(self.items, "To_Occurrence")
        events = {one for line in lines for one in line.triggers if one.startswith("on_")}
        for choice, (token, result) in table.items():
            event = choice.rpartition(".")[2]
            said = " ".join(t.low for t in result)
            own = {f"on_{event}", f"on_{event.removesuffix('_event')}"}
            text = f"To_Occurrence makes {said} of {token.text}"
            holds = said == "conditions" if choice == "others" else said in own
            self.agree("triggers", token.line, holds, text)
            events.discard(said)
        text = f"To_Occurrence has no line for {', '.join(sorted(events))}"
        at = self._line_of(table)
        self.agree("triggers", at, not events, text)

    def _domains(self, wanted: dict[str, str]) -> None:
        """The regions in which transitions leave and enter, where the program asks for them."""
        table = cases(self.items, "Domain_Of")
        for name, domain in wanted.items() if table else ():
            found = table.pop(name, None)
            said = " ".join(token.low for token in found[1]) if found else "missing"
            at = found[0].line if found else 1
            text = f"Domain_Of of {name} is {said}, by the model {domain}"
            self.agree("domains", at, said == domain, text)
        for choice, (token, _) in table.items():
            text = f"Domain_Of has a line for {token.text}, which the model does not have"
            self.agree("domains", token.line, choice in ("none", "others"), text)

    def _timers(self) -> None:
        """Each time-out: its executions, and the state that it belongs to."""
        first, table = elements(self.items, "Timers_After")
        wanted = self.chart.timers()
        domains = {token.low for token in enumeration(self.items, "Domain")}
        if wanted and "ending" in domains:
            text = "time-outs do not stop where the region ends"
            self.agree("timers", self._line_of(table), tuple(t.low for t in first) == STOPS, text)
        for number, (one, counts) in enumerate(wanted, 1):
            found = table.pop(str(number), None)
            if found is None:
                self.agree("timers", 1, False, f"the time-out of {one.name} is missing")
                continue
            parts = list(split(found[1][2:-1], ","))
            started = tuple(t.low for t in parts[-1])
            text = f"the time-out of {one.name} is not {counts[0]} executions"
            listed = ", ".join(map(str, counts))
            clean = tuple(word.replace("_", "") if word[0].isdigit() else word for word in started)
            wanted_words = words(f"Ravenchart.Timers.Started ({listed})")
            self.agree("timers", found[0].line, clean == wanted_words, text)
            text = f"the time-out of {one.name} goes on from another one"
            own = tuple(t.low for t in parts[0])
            self.agree("timers", found[0].line, own == words(f"Timers ({number})"), text)
            after = set(_conjuncts(parts[3])) if len(parts) == 5 else set()
            states = set(self.active("After", one.source))
            text = f"the time-out of {one.name} does not start with {one.source}"
            self.agree("timers", found[0].line, after == states, text)
            before = set(_conjuncts(parts[2])) if len(parts) == 5 else set()
            states = {words("D /= Beginning"), *self.active("Before", one.source)}
            around = {domain_of(region) for region in self.chart.around(one.source)} & domains
            wanted_ends = around | {"everything", "beginning"}
            said = {t.low for t in parts[1]} - {"d", "=", "in", "|"}
            text = f"the time-out of {one.name} does not end with {one.source}: wanted "
            text += ", ".join(sorted(wanted_ends))
            self.agree("timers", found[0].line, before == states and said == wanted_ends, text)
        for token, _ in table.values():
            self.agree("timers", token.line, False, "a time-out that the model does not have")


def _type_of(region: Region) -> str:
    """The type of a region's leaves."""
    return "Leaf" if region[0] is None else f"{region[1]}_Leaf"


def _inside(items: Sequence[Token], package: str) -> list[Token]:
    """The declarations of a nested package."""
    for place in range(len(items)):
        head = [t.low for t in items[place : place + 3]]
        if head == ["package", package.lower(), "is"]:
            end = next(
                n
                for n in range(place, len(items))
                if items[n].low == "end" and items[n + 1].low == package.lower()
            )
            return list(items[place + 3 : end])
    return []


def _conjuncts(items: list[Token]) -> list[Words]:
    """The operands of a conjunction."""
    flat = [token for token in items if token.low != "then"]
    depth = 0
    parts: list[list[str]] = [[]]
    for token in flat:
        depth += {"(": 1, ")": -1}.get(token.text, 0)
        if depth == 0 and token.low == "and":
            parts.append([])
        else:
            parts[-1].append(token.low)
    return [tuple(part) for part in parts]


def _shown(conditions: set[Words]) -> str:
    return " and ".join(sorted(" ".join(one) for one in conditions)) or "missing"
