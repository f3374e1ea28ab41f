# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The plants of a scenario compared with its model, and with the class or unit of each."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from contextlib import closing

from cantools.database.can import Message as DbcMessage
from cantools.database.can import Signal as DbcSignal

from ravenchart.gen.files.located import FormPath
from ravenchart.hw_can.bench.forms import PlantForm
from ravenchart.hw_can.bench.plant_stations import outgoing, plant_of
from ravenchart.hw_can.bench.plants import Plant, PlantError
from ravenchart.hw_can.bench.reading import MISFIT, UNKNOWN, Source
from ravenchart.hw_can.bench.scenario import Scenario
from ravenchart.hw_can.bench.steps import ExpectOutput, SetInput

FindSignal = Callable[[str, FormPath], tuple[DbcMessage, DbcSignal] | None]
"""The message and field of ``message.field``; reported where there is none."""


def check_plants(
    scenario: Scenario, source: Source, signal: FindSignal, outside: Sequence[str]
) -> None:
    """Report what a plant cannot be, or names that its code or the model does not have.

    ``outside`` are the messages that no node of the model sends: a plant sends no others. Each
    plant is made once, and closed.
    """
    for name, form in scenario.plants.items():
        place = ("plants", name)
        for item, text in form.inputs.items():
            signal(text, (*place, "inputs", item))
        found = [signal(text, (*place, "outputs", text)) for text in form.outputs]
        if None not in found:
            messages = {one[0].name: one[0] for one in found if one is not None}
            _check_messages(messages, form, source, place, outside)
        try:
            plant = plant_of(form, scenario.folder)
        except PlantError as fault:
            key = "class" if form.fmu is None else "fmu"
            source.wrong(MISFIT, (*place, key), f"the plant {name} cannot be loaded: {fault}")
            continue
        with closing(plant):
            _check_names(name, form, plant, scenario, source)


def _check_messages(
    messages: Mapping[str, DbcMessage],
    form: PlantForm,
    source: Source,
    place: FormPath,
    outside: Sequence[str],
) -> None:
    """Messages from outside, with a value for each of their fields."""
    for name, fields in outgoing(form).items():
        first = (*place, "outputs", f"{name}.{next(iter(fields))}")
        missing = [one.name for one in messages[name].signals if one.name not in fields]
        if name not in outside:
            hint = f"the messages from outside: {', '.join(outside) or 'none'}"
            source.wrong(MISFIT, first, f"a node of the model sends {name}", hint, key=True)
        elif missing:
            told = f"{name} has the field `{missing[0]}` too, and no output fills it"
            source.wrong(MISFIT, first, told, f"add `{name}.{missing[0]}`", key=True)


def _check_names(
    name: str, form: PlantForm, plant: Plant, scenario: Scenario, source: Source
) -> None:
    """Inputs and outputs that the plant has, in its form and in the steps."""
    inputs = f"the inputs of {name}: {', '.join(plant.inputs) or 'none'}"
    outputs = f"the outputs of {name}: {', '.join(plant.outputs) or 'none'}"

    def report(one: str, kind: str, hint: str, path: FormPath, *, key: bool = False) -> None:
        source.wrong(UNKNOWN, path, f"{name} has no {kind} `{one}`", hint, key=key)

    for one in form.inputs:
        if one not in plant.inputs:
            report(one, "input", inputs, ("plants", name, "inputs", one), key=True)
    for text, one in form.outputs.items():
        if one not in plant.outputs:
            report(one, "output", outputs, ("plants", name, "outputs", text))
    for index, step in enumerate(scenario.steps):
        match step:
            case SetInput() if step.plant == name and step.name not in plant.inputs:
                report(step.name, "input", inputs, ("steps", index, "set"))
            case ExpectOutput() if step.plant == name and step.name not in plant.outputs:
                report(step.name, "output", outputs, ("steps", index, "expect_output"))
