# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Diagnostics: what is wrong with a model, where, and what to do about it.

A wrong model is a value, never an exception. Codes are stable: a code is not
given a second meaning, and one that falls out of use is not given again.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from enum import Enum

from .origins import Origin


class Severity(Enum):
    """An error stops generation, a warning does not."""

    ERROR = "error"
    WARNING = "warning"


GROUPS: Mapping[str, str] = {
    "01": "Files and YAML",
    "02": "Form",
    "03": "Names, types and values",
    "04": "Expressions and flows",
    "05": "Components and charts",
    "06": "Instances, connections and messages",
    "07": "Processors and timing",
    "08": "The system",
    "09": "Deadlines",
    "10": "Simulation",
    "11": "Behaviour",
    "12": "Commands and devices",
    "13": "Scenarios",
    "14": "Requirements",
    "15": "Stacks and memory",
}

CODES: Mapping[str, str] = {
    "RV-0101": "A model file cannot be read.",
    "RV-0102": "A model file is larger than 4 MiB, or there are more than 100 of them.",
    "RV-0103": "A model file is not UTF-8 text.",
    "RV-0104": "A model file has no content.",
    "RV-0105": "A model file holds a tab; YAML indents with spaces only.",
    "RV-0106": "A model file is not well-formed YAML.",
    "RV-0107": "Mappings and lists are nested more than 64 deep.",
    "RV-0108": "Anchors and aliases are not part of the language: what is written is what counts.",
    "RV-0109": "A mapping has the same key twice.",
    "RV-0110": "YAML tags are not part of the language.",
    "RV-0111": "A model file holds more than one YAML document.",
    "RV-0112": "A file includes itself, directly or through others.",
    "RV-0113": "A key is not plain text.",
    "RV-0201": "A key is unknown here.",
    "RV-0202": "A key that is required is missing.",
    "RV-0203": "A value has the wrong kind: a list where a mapping is wanted, text for a number.",
    "RV-0204": "A number is outside the range that the key allows.",
    "RV-0205": "A duration is not well-formed, or outside the range that the key allows.",
    "RV-0206": "A size is not well-formed, or outside the range that the key allows.",
    "RV-0207": "A bit rate is not well-formed, or outside the range that CAN allows.",
    "RV-0208": "A value is not one of the words that the key allows.",
    "RV-0209": "A list or mapping has too few or too many elements.",
    "RV-0210": "A key has no meaning together with, or without, another one.",
    "RV-0211": "A requirement id is not well-formed, or an element names it twice.",
    "RV-0301": "A name is not an Ada identifier of at most 60 letters, digits and underscores.",
    "RV-0302": "A name is a reserved word of Ada.",
    "RV-0303": "Two elements of one scope have the same name; case does not count.",
    "RV-0304": "A name would clash with another in the generated program.",
    "RV-0305": "A name is not declared.",
    "RV-0306": "A reference does not have the form owner.name.",
    "RV-0310": "A range is empty.",
    "RV-0311": "A field of a record is a record.",
    "RV-0312": "A value does not belong to its type.",
    "RV-0313": "A record's value does not give every field once.",
    "RV-0314": "A parameter is not set and has no default.",
    "RV-0401": "An expression is not well-formed.",
    "RV-0402": "An expression is too long or too deeply nested.",
    "RV-0403": "A name in an expression denotes nothing that can be read there.",
    "RV-0404": "An operand has the wrong type.",
    "RV-0405": "Two operands count different units.",
    "RV-0406": "A divisor may be zero.",
    "RV-0407": "A value may leave the range of its target.",
    "RV-0408": "An intermediate result may need more than 64 bits.",
    "RV-0409": "A function is unknown, or has the wrong number of arguments.",
    "RV-0410": "An enumeration literal is unknown, or its type cannot be determined.",
    "RV-0411": "A flow sets what is not a data item, or sends on what is not an output port.",
    "RV-0412": "A data item has two writers.",
    "RV-0413": "One step or execution may send twice on the same port.",
    "RV-0414": "An activity does not declare what its flow reads, writes, sends, calls or raises.",
    "RV-0415": "A record is sent incompletely, or is set or sent as a whole from another type.",
    "RV-0416": "A region asks for a state of its own that its source decides, or during a step.",
    "RV-0417": "A comparison has one outcome: it reads nothing, or compares a value with itself.",
    "RV-0418": "A value is set to itself.",
    "RV-0419": "`old` stands outside of `ensures`, or is not about a data item that is written.",
    "RV-0420": "A contract names what its activity does not read, write or send.",
    "RV-0421": "`sent` stands outside of `ensures`, or every execution sends on its port.",
    "RV-0501": "An initial state is not inside the state or region that names it.",
    "RV-0502": "A transition has several triggers, or neither trigger, target nor effect.",
    "RV-0503": "An internal transition has a target other than its source.",
    "RV-0504": "A region that is triggered by events has no queue.",
    "RV-0505": "A state or pseudostate is unreachable.",
    "RV-0506": "The safe state cannot be reached from every state.",
    "RV-0507": "A transition is never taken: an earlier one always takes its event.",
    "RV-0508": "A transition is never taken: its condition is always false.",
    "RV-0509": "Nothing raises an event that a region waits for.",
    "RV-0510": "No region waits for an event.",
    "RV-0511": "The port region is missing, or there is no input port for it.",
    "RV-0512": "An output port is never sent on.",
    "RV-0513": "A component has nothing to run.",
    "RV-0514": "A pseudostate, region or final state is named where only a state can be.",
    "RV-0515": "A transition that leaves a pseudostate has a trigger.",
    "RV-0516": "`else` is given where it has no meaning, or twice.",
    "RV-0517": "No transition leaves a choice or junction.",
    "RV-0518": "Choices and junctions lead in a circle: such a step would never end.",
    "RV-0519": "A join does not join states of different regions and lead on by one transition.",
    "RV-0520": "A fork does not enter states in different regions of one orthogonal state.",
    "RV-0521": "A history is misplaced, given twice, or has a wrong default transition.",
    "RV-0522": "A transition leaves a final state or a terminate pseudostate.",
    "RV-0523": "A local transition does not lead from a composite state to one inside it.",
    "RV-0524": "A completion transition is never taken: its source never completes.",
    "RV-0525": "A state defers an event that its own transition always takes.",
    "RV-0526": "A region defers events, but has no `deferred`.",
    "RV-0527": "Something other than a do activity raises `done`.",
    "RV-0528": "An event that carries a value gets none, one of another type, or one too many.",
    "RV-0529": "Two regions of a state take one event, and one of them leaves the state.",
    "RV-0530": "One step may raise more events than the limit.",
    "RV-0531": "A transition has too many ways through junctions.",
    "RV-0532": "An event is deferred, and no transition takes it afterwards.",
    "RV-0533": "A do activity raises `done`, and nothing waits for it.",
    "RV-0534": "Nothing reads a parameter, or nothing uses a data item.",
    "RV-0535": "The groups of a port region do not divide the input ports of the component.",
    "RV-0601": "A connection does not lead from an output port to an input port.",
    "RV-0602": "An input port has no source.",
    "RV-0603": "An input port has two sources.",
    "RV-0604": "An output port is not connected.",
    "RV-0605": "The two ends of a connection or message have different types.",
    "RV-0606": "A connection or message joins the wrong nodes.",
    "RV-0607": "A CAN identifier is outside its range, or used twice on its bus.",
    "RV-0608": "A message has neither sender nor receiver in the system.",
    "RV-0609": "A message's period is missing, or given although it is its sender's.",
    "RV-0610": "A payload does not fit into the 64 bits of a CAN frame, or the 512 of CAN FD.",
    "RV-0611": "A message may be sent more often than once in its period.",
    "RV-0612": "A chain has no limit.",
    "RV-0613": "The data rate of a bus is below its bit rate.",
    "RV-0614": "A signal cannot be laid out or coded as it is given.",
    "RV-0615": "Two signals share bits of a frame, or one reaches beyond its end.",
    "RV-0616": "No frame has that length, or the message does not fit it.",
    "RV-0617": "Transmit buffers by priority do not hold what a node sends.",
    "RV-0618": "A fault of a bus cannot be noticed, or recovery from it requested.",
    "RV-0619": "A message cannot be protected from end to end as it is given.",
    "RV-0620": "A message cannot have that transmission mode.",
    "RV-0621": "A message cannot be authenticated as it is given.",
    "RV-0622": "A name in databases is malformed, or used twice.",
    "RV-0626": "A value cannot be sent in several frames as it is given.",
    "RV-0627": "Arrays of different sizes are joined element by element.",
    "RV-0701": "An activity, region or port region is allocated to no processor.",
    "RV-0702": "An activity, region or port region is allocated twice.",
    "RV-0703": "A worst-case execution time or a deadline is longer than the period.",
    "RV-0704": "A period in a table is no multiple of the processor's period.",
    "RV-0705": "A sporadic processor does not hold exactly the reception of its bus.",
    "RV-0706": "A bus with received messages is not served by exactly one processor.",
    "RV-0707": "A processor's table holds an activity of an instance on another node.",
    "RV-0708": "The offset of a processor or the phase of a row does not fit its period.",
    "RV-0709": "A critical section is longer than what executes it.",
    "RV-0710": "A processor is on a core that its node does not have.",
    "RV-0711": "Tasks of several cores share what only tasks of one core can share.",
    "RV-0712": "The silence of a processor is not supervised, or cannot be.",
    "RV-0713": "Only a processor itself waits for the event that its silence raises.",
    "RV-0714": "A bus with `watch` is not watched by exactly one row on each of its nodes.",
    "RV-0715": "A port, interface or region cannot release a processor.",
    "RV-0716": "A processor that a queue releases does not hold the rows for it.",
    "RV-0717": "Values that another processor sees before a logical execution time ends.",
    "RV-0718": "An interrupt does not release one processor that it can release.",
    "RV-0801": "A section without which there is no system is missing or empty.",
    "RV-0802": "Something cannot reach from one node to another yet.",
    "RV-0803": "Something that the system has once is given twice.",
    "RV-0804": "The model is checked and analysed, but not generated yet.",
    "RV-0805": "A component contains itself.",
    "RV-0806": "A key has no meaning in a component with instances inside it, or without them.",
    "RV-0807": "A port or interface of a composite component leads to nothing, or wrongly.",
    "RV-0808": "A reference ends at a composite instance, or leads past its ports and interfaces.",
    "RV-0809": "A model has several deployments, and none of them is chosen.",
    "RV-0810": "A port or data item cannot be recorded.",
    "RV-0811": "A library has no version, or what only a system has.",
    "RV-0901": "A task or message may miss its deadline.",
    "RV-0902": "The response time of a task or message has no bound.",
    "RV-0903": "The messages of a bus need more than all of its time.",
    "RV-0904": "No way leads from one element of a chain to the next.",
    "RV-0905": "A chain may take longer than its limit.",
    "RV-0906": "A queue is shorter than what may wait in it at once.",
    "RV-0907": "Nothing bounds what may wait in a queue.",
    "RV-0908": "No order of a bus's identifiers was found that meets all deadlines.",
    "RV-0909": "A time-out of a transfer may pass although no frame is lost.",
    "RV-0910": "A bus is too slow: a higher bit rate meets all limits that are exceeded.",
    "RV-0911": "A node may not hand its trace and snapshots to a monitor in time.",
    "RV-0912": "A trace is shorter than what may wait in it until it is emptied.",
    "RV-1001": "A file of events cannot be read, or is no list.",
    "RV-1002": "An entry of a file of events has an unknown form.",
    "RV-1003": "A time in a file of events is not well-formed, or before the one above it.",
    "RV-1004": "A file of events names what the system does not have.",
    "RV-1005": "A value in a file of events is missing, unwanted, or not one of its type.",
    "RV-1006": "A file of events does not end with the last instant.",
    "RV-1007": "A simulation came to a pseudostate from which no segment leads on.",
    "RV-1008": "The interpreter cannot execute commands of devices or tasks.",
    "RV-1009": "The interpreter leaves out activities that the user writes.",
    "RV-1010": "A file of events raises from outside what `check` takes to come from inside only.",
    "RV-1101": "No data lead into a state.",
    "RV-1102": "No data enable a transition.",
    "RV-1103": "Two transitions with one source and trigger can both be taken; the first is.",
    "RV-1104": "A step can get stuck in a choice or junction.",
    "RV-1105": "A state ignores an event that all states beside it expect.",
    "RV-1106": "The safe state cannot be reached, guards considered.",
    "RV-1107": "A livelock: steps without event or time-out can go on for ever.",
    "RV-1108": "An invariant is violated.",
    "RV-1109": "An invariant is not proved.",
    "RV-1110": "The check of behaviour was not finished.",
    "RV-1111": "An invariant is checked on the model, and is no contract of the code.",
    "RV-1112": "A client may call a command in a state of the protocol that does not allow it.",
    "RV-1113": "A client is not shown to follow the protocol of an interface.",
    "RV-1201": "A command in the dictionary lacks a type that its kind needs, or has one more.",
    "RV-1202": "A command is per axis, but has no scalar type that an axis could have a value of.",
    "RV-1203": "A required interface is bound to nothing, or twice.",
    "RV-1204": "The provider bound to an interface lacks a required command or event.",
    "RV-1205": "A required interface works on another number of axes than what it is bound to.",
    "RV-1206": "A command is called that is read, or called with an argument too many or too few.",
    "RV-1207": "The fallback of a command does not fit the command.",
    "RV-1208": "A key has no meaning for a command of that kind.",
    "RV-1209": "A provided interface is incomplete, or answers a command in the wrong way.",
    "RV-1210": "A device is not exactly one of a piece of equipment, an array and a facade.",
    "RV-1212": "Two members of a facade provide a command, or the wrong one is chosen.",
    "RV-1213": "The replies of the members of an array cannot be given as one.",
    "RV-1214": "A reply or value from another node has no limit of its time, or a device has one.",
    "RV-1215": "An event stands among commands, or its port does not fit.",
    "RV-1216": "Registers of a device overlap, or lie where no register can.",
    "RV-1217": "A parameter of a device has no value, or a value has no parameter.",
    "RV-1218": "The devices of a node take too long to start.",
    "RV-1219": "A protocol of an interface is incomplete or ambiguous.",
    "RV-1301": "A scenario cannot be read, or is no mapping.",
    "RV-1302": "A key in a scenario is missing, or has no place there.",
    "RV-1303": "A value in a scenario is not of the form that its key takes.",
    "RV-1304": "A scenario names what neither it nor the system has.",
    "RV-1305": "A value in a scenario is not one of the field of its message.",
    "RV-1306": "Parts of a scenario do not fit together.",
    "RV-1401": "A list of requirements cannot be read.",
    "RV-1402": "An id in a list of requirements is not well-formed, or given twice.",
    "RV-1403": "No element of the model names a requirement.",
    "RV-1404": "An element, scenario or test names a requirement that the list lacks.",
    "RV-1405": "No scenario or test names a requirement, or none of its tests passed.",
    "RV-1406": "A claim about the elements of a requirement is not met, or there is none.",
    "RV-1501": "A stack is smaller than the longest path of its task.",
    "RV-1502": "Subprograms call each other in a circle, so a stack has no bound.",
    "RV-1503": "A call goes through a pointer, so what it takes of a stack is not known.",
    "RV-1504": "A frame has a size that is computed at run time, and no bound is known.",
}
"""Every code with what it says; docs/errors.md is written from this table."""


@dataclass(frozen=True, slots=True)
class Diagnostic:
    """One finding about a model.

    ``notes`` show other places, ``hint`` says what to do.
    """

    code: str
    severity: Severity
    origin: Origin
    message: str
    notes: tuple[tuple[Origin, str], ...] = ()
    hint: str | None = None

    @property
    def is_error(self) -> bool:
        """Whether it stops generation."""
        return self.severity is Severity.ERROR


def error(
    code: str,
    origin: Origin,
    message: str,
    *,
    notes: Iterable[tuple[Origin, str]] = (),
    hint: str | None = None,
) -> Diagnostic:
    """An error with that code at that place."""
    return Diagnostic(code, Severity.ERROR, origin, message, tuple(notes), hint)


def warning(
    code: str,
    origin: Origin,
    message: str,
    *,
    notes: Iterable[tuple[Origin, str]] = (),
    hint: str | None = None,
) -> Diagnostic:
    """A warning with that code at that place."""
    return Diagnostic(code, Severity.WARNING, origin, message, tuple(notes), hint)


def in_order(
    diagnostics: Iterable[Diagnostic], files: Iterable[str] = ()
) -> tuple[Diagnostic, ...]:
    """The diagnostics by file (as read), line and column, each once."""
    rank = {name: index for index, name in enumerate(files)}

    def key(item: Diagnostic) -> tuple[int, Origin, str, str]:
        return (rank.get(item.origin.file, len(rank)), item.origin, item.code, item.message)

    return tuple(sorted(dict.fromkeys(diagnostics), key=key))


Sources = Mapping[str, tuple[str, ...]]
"""The lines of each file, by its name as given."""

UNREADY = "RV-0804"
"""The model is checked and analysed, but not generated yet."""

MARGIN = 120
"""Longest excerpt of a line, in characters."""


def render(diagnostic: Diagnostic, sources: Sources) -> str:
    """The diagnostic as compilers print it, with the line it speaks of."""
    head = f"{diagnostic.origin}: {diagnostic.severity.value}: {diagnostic.message}"
    lines = [
        f"{head} [{diagnostic.code}]",
        *_excerpt(diagnostic.origin, sources),
        *(f"{origin}: note: {text}" for origin, text in diagnostic.notes),
    ]
    if diagnostic.hint is not None:
        lines.append(f"{diagnostic.origin}: hint: {diagnostic.hint}")
    return "\n".join(_printable(line) for line in lines)


MOST = 100
"""Diagnostics that are printed of one file; the rest is counted."""


UNDECLARED = ("RV-0305", "RV-0403", "RV-0411")
"""Of a name that is not declared: each use has one, and they are printed once."""

LISTED = 4
"""Further uses of such a name whose locations are printed."""


def render_all(diagnostics: Sequence[Diagnostic], sources: Sources) -> str:
    """Each as `render` has it, one below the other; of very many the first."""
    alike: dict[object, list[Diagnostic]] = {}
    for number, one in enumerate(diagnostics):
        same = one.code in UNDECLARED
        alike.setdefault((one.code, one.message, one.hint) if same else number, []).append(one)
    found = list(alike.values())
    lines = [render(_with_places(*same), sources) for same in found[:MOST]]
    if len(found) > MOST:
        left = sum(len(same) for same in found[MOST:])
        lines.append(f"{left:,} more errors or warnings are not shown")
    return "\n".join(lines)


def _with_places(first: Diagnostic, *others: Diagnostic) -> Diagnostic:
    """The first with a note of where else the same is wrong."""
    if not others:
        return first
    places = ", ".join(str(one.origin) for one in others[:LISTED])
    more = f" and {len(others) - LISTED} more" if len(others) > LISTED else ""
    return replace(first, notes=(*first.notes, (first.origin, f"also at {places}{more}")))


def _excerpt(origin: Origin, sources: Sources) -> tuple[str, ...]:
    """The source line with a caret under the column; nothing where there is no such line."""
    lines = sources.get(origin.file, ())
    if not 1 <= origin.line <= len(lines):
        return ()
    line = lines[origin.line - 1]
    column = min(origin.column, len(line) + 1)
    start = 0 if len(line) <= MARGIN else max(0, column - 1 - MARGIN // 2)
    shown = line[start : start + MARGIN]
    return (f"{origin.line:5} | {shown}".rstrip(), f"      | {' ' * (column - 1 - start)}^")


def _printable(text: str) -> str:
    """The text with everything that could disturb a terminal replaced."""
    return "".join(char if char.isprintable() else " " if char == "\t" else "?" for char in text)
