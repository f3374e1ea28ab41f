# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""How drawings look: colours, fonts, and the room that text gets."""

INK, PAPER = "#222222", "#ffffff"
SHADES = ("#f3f5f7", "#e6ebf0")
"""Of what encloses, from the outside in."""
FONT = "Helvetica"
SMALL = "10"
LEFT = '<br align="left"/>'
"""Ends a line of HTML that begins at the left."""
ROOM = "\u00a0\u00a0"
"""Behind text, for fonts that are wider than the one Graphviz measures."""
