# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Functional Mock-up Units for the tests, compiled here: the oven of docs/plants.md."""

from __future__ import annotations

import subprocess
import zipfile
from pathlib import Path

SOURCE = Path(__file__).with_name("fmu") / "oven.c"

FMI_2 = """\
<?xml version="1.0" encoding="UTF-8"?>
<fmiModelDescription fmiVersion="2.0" modelName="oven" guid="{oven}">
  <CoSimulation modelIdentifier="oven" canHandleVariableCommunicationStepSize="true"/>
  <TypeDefinitions>
    <SimpleType name="Heater">
      <Enumeration><Item name="Cold" value="0"/><Item name="Hot" value="1"/></Enumeration>
    </SimpleType>
  </TypeDefinitions>
  <ModelVariables>
    <ScalarVariable name="temperature" valueReference="1" causality="output">
      <Real/></ScalarVariable>
    <ScalarVariable name="heater" valueReference="2" causality="input" variability="discrete">
      <Enumeration declaredType="Heater" start="0"/></ScalarVariable>
    <ScalarVariable name="loss" valueReference="3" causality="parameter" variability="tunable">
      <Real start="4"/></ScalarVariable>
    <ScalarVariable name="count" valueReference="4" causality="output" variability="discrete">
      <Integer/></ScalarVariable>
    <ScalarVariable name="door" valueReference="5" causality="input" variability="discrete">
      <Boolean start="false"/></ScalarVariable>
  </ModelVariables>
  <ModelStructure>
    <Outputs><Unknown index="1"/><Unknown index="4"/></Outputs>
    <InitialUnknowns><Unknown index="1"/><Unknown index="4"/></InitialUnknowns>
  </ModelStructure>
</fmiModelDescription>
"""

FMI_3 = """\
<?xml version="1.0" encoding="UTF-8"?>
<fmiModelDescription fmiVersion="3.0" modelName="oven" instantiationToken="{oven}">
  <CoSimulation modelIdentifier="oven" canHandleVariableCommunicationStepSize="true"/>
  <TypeDefinitions>
    <EnumerationType name="Heater"><Item name="Cold" value="0"/><Item name="Hot" value="1"/>
    </EnumerationType>
  </TypeDefinitions>
  <ModelVariables>
    <Float64 name="temperature" valueReference="1" causality="output"/>
    <Enumeration name="heater" valueReference="2" causality="input" variability="discrete"
                 declaredType="Heater" start="0"/>
    <Float64 name="loss" valueReference="3" causality="parameter" variability="tunable" start="4"/>
    <Int64 name="count" valueReference="4" causality="output" variability="discrete"/>
    <Float64 name="time" valueReference="0" causality="independent" variability="continuous"/>
    <Boolean name="door" valueReference="5" causality="input" variability="discrete" start="false"/>
  </ModelVariables>
  <ModelStructure>
    <Output valueReference="1"/><Output valueReference="4"/>
    <InitialUnknown valueReference="1"/>
  </ModelStructure>
</fmiModelDescription>
"""


def oven_unit(path: Path, version: int) -> Path:
    """The unit of FMI 2.0 or 3.0 in a file that is made; its path."""
    library = path.with_suffix(".so")
    switch = ["-DFMI2"] if version == 2 else []
    subprocess.run(["gcc", "-shared", "-fPIC", *switch, "-o", library, SOURCE], check=True)
    folder = "linux64" if version == 2 else "x86_64-linux"
    with zipfile.ZipFile(path, "w") as unit:
        unit.writestr("modelDescription.xml", FMI_2 if version == 2 else FMI_3)
        unit.write(library, f"binaries/{folder}/oven.so")
    return path
