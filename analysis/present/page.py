# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Shared parts of the pages of reports: filters, contents, and the page around them."""

from __future__ import annotations

import re
from collections.abc import Mapping
from itertools import count
from typing import Any

from jinja2 import (
    BaseLoader,
    ChoiceLoader,
    Environment,
    PackageLoader,
    StrictUndefined,
    select_autoescape,
)
from markupsafe import Markup

from ravenchart import rounded
from ravenchart.analysis import units
from ravenchart.analysis.core.tasks import with_full_jobs

PLACE = "<!-- contents -->"
"""The mark at which the page has its contents."""

HEADING = re.compile(r"<h2>(.*?)</h2>", re.DOTALL)
"""The heading of a section."""


def environment(*own: BaseLoader) -> Environment:
    """The environment of all pages: templates of one's own, and those of this folder."""
    return Environment(
        loader=ChoiceLoader([*own, PackageLoader("ravenchart.analysis.present")]),
        autoescape=select_autoescape(default=True),
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )


def page(template: str, context: Mapping[str, Any]) -> str:
    """The HTML text of a template, its contents included."""
    pages = environment()
    pages.filters |= {
        "us": both,
        "left": left,
        "only_us": units.microseconds,
        "duration": units.duration,
        "percent": rounded.percent,
        "factor": rounded.factor,
        "plain_load": lambda task: with_full_jobs(task).utilisation,
    }
    return _with_contents(pages.get_template(template).render(context))


def both(ns: int) -> Markup:
    """A time in us and, from 1 ms on, in ms beside it, with the exact value for sorting."""
    return _cell(ns, ns)


def left(ns: int) -> Markup:
    """The same of a slack, which is rounded down."""
    return _cell(ns, ns // units.TENTH * units.TENTH)


def _cell(ns: int, shown: int) -> Markup:
    beside = Markup("")
    if abs(ns) >= units.MS:
        beside = Markup(' <small class="ms">{} ms</small>').format(units.milliseconds(shown))
    return Markup('<data value="{}">{}</data>{}').format(ns, units.microseconds(shown), beside)


def _with_contents(text: str) -> str:
    """The page, each section with a name, and the list of all sections at `PLACE`."""
    number = count(1)
    entries: list[str] = []

    def named(found: re.Match[str]) -> str:
        name = f"section-{next(number)}"
        entries.append(f'<li><a href="#{name}">{found[1]}</a></li>')
        return f'<h2 id="{name}">{found[1]}</h2>'

    marked = HEADING.sub(named, text)
    return marked.replace(PLACE, "\n".join(entries), 1)
