"""Markdown tables."""

from __future__ import annotations

import textwrap
import unicodedata
from collections.abc import Iterable, Sequence


def table(header: Sequence[str], rows: Iterable[Sequence[str]]) -> list[str]:
    """Lines of a table, its columns aligned as read in a terminal; all but the first to the right."""
    cells = [list(header), *(list(row) for row in rows)]
    widths = [max(_width(row[i]) for row in cells) for i in range(len(header))]

    def line(row: Sequence[str]) -> str:
        padded = [
            cell + " " * (width - _width(cell)) if i == 0 else " " * (width - _width(cell)) + cell
            for i, (cell, width) in enumerate(zip(row, widths, strict=True))
        ]
        return "| " + " | ".join(padded) + " |"

    rule = ["-" * widths[0], *("-" * (width - 1) + ":" for width in widths[1:])]
    return [line(cells[0]), "| " + " | ".join(rule) + " |", *(line(row) for row in cells[1:])]


def _width(text: str) -> int:
    """Places that a text takes in a terminal."""
    return sum(unicodedata.combining(c) == 0 for c in text)


def paragraph(text: str) -> list[str]:
    """Lines of a text, and an empty one after it."""
    return [*textwrap.wrap(text, 110, break_long_words=False, break_on_hyphens=False), ""]


def number(value: float | None) -> str:
    """With three digits that matter; a dash for None."""
    if value is None:
        return "–"
    if value == 0.0 or not abs(value) < 1e15:
        return str(value)
    if abs(value) >= 100:
        return f"{value:,.0f}"
    return f"{value:#.3g}".rstrip(".")
