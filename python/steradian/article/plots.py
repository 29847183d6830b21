"""Figures in one calm style, as SVG that follows the page's colours, also in the dark."""

from __future__ import annotations

import io
import re
from contextlib import AbstractContextManager
from typing import TYPE_CHECKING, Any

import matplotlib
from matplotlib.figure import Figure

if TYPE_CHECKING:
    from matplotlib.axes import Axes

Plot = tuple[Figure, str]
"""A figure, and what a person who cannot see it should know."""

INK = "#1b1d21"
FAINT = "#c9ccd2"
BLUE = "#1f6fb2"
ORANGE = "#d05a0e"
GREEN = "#2b8a4b"
PURPLE = "#8b4fb0"

# Colours that the page's style sheet decides on.
_VARIABLES = {
    INK: "var(--ink)",
    FAINT: "var(--rule)",
    BLUE: "var(--blue)",
    ORANGE: "var(--orange)",
    GREEN: "var(--green)",
    PURPLE: "var(--purple)",
}

_STYLE: Any = {
    "svg.fonttype": "path",
    "svg.hashsalt": "steradian",
    "font.family": "DejaVu Sans",
    "font.size": 10.5,
    "axes.titlesize": 10.5,
    "axes.edgecolor": INK,
    "axes.labelcolor": INK,
    "axes.titlecolor": INK,
    "axes.linewidth": 0.8,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": True,
    "axes.axisbelow": True,
    "grid.color": FAINT,
    "grid.linewidth": 0.6,
    "text.color": INK,
    "xtick.color": INK,
    "ytick.color": INK,
    "lines.linewidth": 1.8,
    "legend.frameon": False,
    "legend.fontsize": 9.5,
    "figure.constrained_layout.use": True,
}


def style() -> AbstractContextManager[None]:
    """The style of all figures: they have to be made and drawn within it."""
    return matplotlib.rc_context(_STYLE)


def figure(width: float = 4.3, height: float = 3.1, **axes: Any) -> tuple[Figure, Axes]:
    """A figure with one pair of axes; ``axes`` are its properties, such as ``xlabel``. Inches."""
    made = Figure(figsize=(width, height))
    return made, made.subplots(subplot_kw=axes)


def disk(title: str) -> tuple[Figure, Axes]:
    """A figure of the unit disk, without axes: the sphere or hemisphere seen from above."""
    made, axes = figure(3.0, 3.3, title=title, aspect="equal", xlim=(-1.05, 1.05), ylim=(-1.05, 1.05))
    axes.set_axis_off()
    axes.add_patch(matplotlib.patches.Circle((0, 0), 1, fill=False, color=INK, linewidth=0.8))
    return made, axes


def svg(made: Figure, name: str, alt: str) -> str:
    """The figure as an ``<svg>`` element. ``name`` keeps its identifiers apart from those of others."""
    data = io.StringIO()
    made.savefig(data, format="svg", transparent=True, metadata={"Date": None, "Creator": None})
    text = data.getvalue()
    text = text[text.index("<svg") :]
    text = re.sub(r"<metadata>.*?</metadata>", "", text, flags=re.DOTALL)
    text = re.sub(r'\bid="', f'id="{name}-', text)
    text = re.sub(r'(href="#|url\(#)', rf"\g<1>{name}-", text)
    for colour, variable in _VARIABLES.items():
        text = text.replace(colour, variable)
    label = alt.replace("&", "&amp;").replace('"', "&quot;").replace("<", "&lt;")
    width = made.get_figwidth() * 96
    # Two of the usual size stand beside one another on a wide page.
    size = f"flex: 1 1 {0.8 * width:.0f}px; max-width: min({width:.0f}px, 100%)"
    return text.replace("<svg ", f'<svg role="img" aria-label="{label}" style="{size}" ', 1)
