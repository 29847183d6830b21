"""``steradian article``."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

from steradian.article import Written, write
from steradian.cli import outputs

FAILED = 1


def article(arguments: argparse.Namespace) -> int:
    """Runs the experiments and writes the page; 0 only if all of it holds."""
    path = Path(arguments.output)
    outputs.check_writable(path)

    def on_chapter(index: int, number: int, title: str) -> None:
        if not arguments.quiet:
            print(f"{index + 1:2}/{number}  {title}", file=sys.stderr, flush=True)

    try:
        written = write(arguments.seed, quick=arguments.quick, on_chapter=on_chapter)
    except ImportError as error:
        print(f"error: {error}", file=sys.stderr)
        return FAILED
    outputs.write_text(path, written.html)
    if not arguments.quiet:
        print(_summary(written, path))
    for line in _complaints(written):
        print(f"error: {line}", file=sys.stderr)
    if arguments.open:
        import webbrowser  # half of the start-up time, and seldom wanted

        webbrowser.open(path.resolve().as_uri())
    return 0 if written.holds else FAILED


def _summary(written: Written, path: Path) -> str:
    held = sum(finding.holds for finding in written.findings)
    caught = sum(mistake.caught for mistake in written.mistakes)
    of_values, of_mistakes = len(written.findings), len(written.mistakes)
    return f"{held} of {of_values} values hold, {caught} of {of_mistakes} mistakes caught; wrote {path}"


def _complaints(written: Written) -> list[str]:
    """What does not hold, a line each."""
    from steradian.article.page import plain

    values = [
        f"{plain(finding.what)} ({finding.chapter}): {finding.estimate}, not {finding.exact:.9g}"
        for finding in written.findings
        if not finding.holds
    ]
    return values + [f"{mistake.what}: not caught" for mistake in written.mistakes if not mistake.caught]
