"""``steradian verify``."""

from __future__ import annotations

import argparse
import json
import sys
from itertools import groupby
from pathlib import Path

from steradian import verification
from steradian.cli import outputs
from steradian.cli.progress import StatusLine, duration
from steradian.verification import Found, Row

FAILED = 1
MOST_LINES = 20
"""Failures that are shown; the page and --json have all."""


def verify(arguments: argparse.Namespace) -> int:
    """Runs the checks; 0 only if all hold, and every flaw is caught."""
    if arguments.list:
        return _list()
    path = Path(arguments.html) if arguments.html else None
    if path is not None:
        outputs.check_writable(path)
    quiet = arguments.quiet or arguments.json
    with StatusLine() as status:

        def show(done: int, total: int) -> None:
            if not quiet and status.is_due():
                status.show(f"{done} / {total} checks · {duration(status.elapsed())}", done / total)

        found = verification.run(
            arguments.name,
            seed=arguments.seed,
            failure_rate=arguments.failure_rate,
            threads=arguments.threads,
            on_progress=show,
        )
    if path is not None:
        outputs.write_text(path, verification.page(found))
    if arguments.json:
        print(json.dumps(found.to_json(), indent=1))
    elif not arguments.quiet:
        print(table(found))
        print(_summary(found) + (f"; wrote {path}" if path else ""))
    _complain(found)
    return 0 if found.holds else FAILED


def _list() -> int:
    for group, blocks in groupby(verification.blocks(), lambda block: block.group):
        names = ", ".join(f"{block.name} ({block.cases})" for block in blocks)
        print(f"{group}: {names}")
    return 0


def table(found: Found) -> str:
    """A line for each block: its checks, and those that fail."""
    lines = []
    width = max(len(row.block) for row in found.rows)
    for (group, block), rows in groupby(found.rows, lambda row: (row.group, row.block)):
        checks = list(rows)
        cases = max(row.cases for row in checks)
        marks = "  ".join(map(_mark, checks))
        lines.append(f"{group:12}  {block:{width}}  {cases:4} cases  {marks}")
    return "\n".join(lines)


def _mark(row: Row) -> str:
    return f"✗ {row.check} ({len(row.failures)})" if row.failures else f"✓ {row.check}"


def _summary(found: Found) -> str:
    checks = sum(row.cases for row in found.rows)
    text = f"{checks - len(found.failures)} of {checks} checks hold"
    if found.flaws:
        text += f", {len(found.flaws) - len(found.missed)} of {len(found.flaws)} deliberate flaws caught"
    return f"{text}, {duration(found.seconds)}"


def _complain(found: Found) -> None:
    lines = [f"{row.group}/{failure.case}, {row.check}: {failure.what}" for row, failure in found.failures]
    lines += [f"{flaw.case}: nothing noticed" for flaw in found.missed]
    for line in lines[:MOST_LINES]:
        print(f"error: {line}", file=sys.stderr)
    if len(lines) > MOST_LINES:
        print(f"error: and {len(lines) - MOST_LINES} more", file=sys.stderr)
