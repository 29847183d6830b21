"""All that was measured as one page of Markdown."""

from __future__ import annotations

from typing import Any

from beside.paired import Bar
from beside.studies import NAMES, study
from beside.table import number, paragraph, table

INTRODUCTION = """\
Written by `python3 benches/run.py`, which makes an environment of its own, installs the peers and measures
everything side by side in one run; figures of different runs do not compare. What is equal, and what cannot
be, is said in [benches/README.md](../benches/README.md)."""


def page(results: dict[str, Any]) -> str:
    """The text of the page."""
    machine = results["machine"]
    small = " **of small sizes, which say little**" if results["quick"] else ""
    before = machine["load_before"]
    busy = "Nobody counts the machine's load" if before is None else f"The machine's load was {before:.1f}"
    lines = [
        "# Beside other renderers",
        "",
        INTRODUCTION,
        "",
        *paragraph(
            f"{machine['processor']}, {machine['cores']} cores, {machine['system']}; {results['date']}; "
            f"commit {results['commit']}; medians of {results['runs']} runs{small}. {busy} when it began."
        ),
    ]
    if results["missing"]:
        lines += ["Not there, and so not measured:", ""]
        lines += [f"- {label}: {why}" for label, why in results["missing"].items()]
        lines.append("")
    lines += ["## Verdicts", "", *verdicts(all_bars(results)), ""]
    for name in NAMES:
        if name in results["studies"]:
            one = study(name)
            lines += [f"## {one.TITLE}", "", *one.tables(results["studies"][name])]
            if name == "growth":
                lines += ["![Processor time by samples, pixels and triangles](growth.svg)", ""]
    for name, why in results["failed"].items():
        lines += [f"The study `{name}` failed: {why}", ""]
    return "\n".join(lines).rstrip() + "\n"


def all_bars(results: dict[str, Any]) -> list[Bar]:
    """Of all studies that were made."""
    return [
        bar
        for name in NAMES
        if name in results["studies"]
        for bar in study(name).bars(results["studies"][name])
    ]


def verdicts(bars: list[Bar]) -> list[str]:
    """A row for each bound."""
    rows = [
        [
            bar.name,
            f"{number(bar.measured)} {bar.unit}".strip(),
            f"{bar.sense} {bar.bound:g} {bar.unit}".strip(),
            "kept" if bar.passed else "**missed**",
        ]
        for bar in bars
    ]
    return table(["bar", "measured", "asked", ""], rows)
