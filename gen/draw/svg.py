# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Drawings of Graphviz as the project keeps them: without a version, with the DOT text's digest."""

from __future__ import annotations

import hashlib
import re

_NOISE = re.compile(r"<!DOCTYPE.*?>\s*|<!--.*?-->\s*", re.DOTALL)
_OPENING = re.compile(r"<svg\b([^>]*)>")


def finished(svg: str, dot: str) -> str:
    """The drawing without comments, its description naming the DOT text that it shows.

    Spaces are kept, for they indent. Older versions of Graphviz write a colour
    ``transparent``, which SVG 1.1 does not know.
    """
    clean = _NOISE.sub("", svg).replace('"transparent"', '"none"')
    head = f'<svg xml:space="preserve"\\1>\n<desc>{mark(dot)}</desc>'
    return _OPENING.sub(head, clean, count=1)


def mark(dot: str) -> str:
    """The description of a drawing: equal for equal DOT texts alone."""
    return f"ravenchart draw, DOT sha256 {hashlib.sha256(dot.encode()).hexdigest()}"
