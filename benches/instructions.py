#!/usr/bin/env python3
"""Counts the instructions of a fixed set of works, and compares them with the stored counts.

    python3 benches/instructions.py                 exit code 1 if a work needs more than 2 % more than before
    python3 benches/instructions.py --update        store the counts
    python3 benches/instructions.py paths-cornell   only some works

Counts do not depend on what else the machine does, as times do. They are not times: caches that miss and
branches that are guessed wrongly cost much and count little. Needs Rust and valgrind (Debian, Ubuntu: apt
install valgrind; Fedora: dnf install valgrind), which shows programs a processor with AVX2 and without
AVX-512. Another version of the compiler counts differently.
"""

from __future__ import annotations

import argparse
import json
import platform
import re
import shutil
import subprocess
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
STORED = ROOT / "benches" / "instructions.json"
COUNTED = "*bench_instructions::counted*"
TOLERANCE = 0.02


@dataclass(frozen=True)
class Row:
    """A work's count, and what was stored for it; None if nothing was."""

    work: str
    count: int
    stored: int | None

    @property
    def change(self) -> float | None:
        """Relative to what was stored."""
        return None if self.stored is None else self.count / self.stored - 1.0

    def verdict(self, tolerance: float) -> str:
        """What the change means."""
        if self.change is None:
            return "new: --update stores it"
        if self.change > tolerance:
            return "MORE"
        return "less: --update stores it" if self.change < -tolerance else "same"


def main() -> int:
    """Counts, prints a table, and compares or stores."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("works", nargs="*", metavar="WORK", help="all unless given")
    parser.add_argument("--update", action="store_true", help="store the counts")
    parser.add_argument("--tolerance", type=float, default=TOLERANCE, help=f"relative; {TOLERANCE}")
    given = parser.parse_args()
    lacking = missing()
    if lacking:
        print(f"instructions.py: {lacking}", file=sys.stderr)
        return 2
    program = build()
    listed = subprocess.run([program, "--list"], check=True, capture_output=True, text=True)
    known = listed.stdout.split()
    unknown = [work for work in given.works if work not in known]
    if unknown:
        parser.error(f"there is no work {', '.join(unknown)}; there are {', '.join(known)}")
    stored = json.loads(STORED.read_text()) if STORED.exists() else {}
    rows = []
    print(f"{'work':<20} {'instructions':>14} {'stored':>14} {'change':>8}")
    for work in given.works or known:
        row = Row(work, count(program, work), stored.get(work))
        rows.append(row)
        print(line(row, given.tolerance), flush=True)
    if given.update:
        kept = {work: stored[work] for work in known if work in stored}
        STORED.write_text(json.dumps(kept | {row.work: row.count for row in rows}, indent=1) + "\n")
        print(f"stored in {STORED.relative_to(ROOT)}")
        return 0
    return 1 if regressions(rows, given.tolerance) else 0


def missing() -> str | None:
    """What has to be installed, in a sentence."""
    machine = platform.machine()
    if machine.lower() not in ("x86_64", "amd64"):
        return f"the stored counts are of x86-64, and this is {machine}"
    if shutil.which("valgrind") is None:
        return "valgrind is not there; Debian, Ubuntu: apt install valgrind; Fedora: dnf install valgrind"
    if shutil.which("cargo") is None:
        return "Rust's cargo is not there; install it with rustup, see https://rustup.rs"
    return None


def build() -> str:
    """The program of works, built as we ship."""
    command = ["cargo", "build", "--release", "--locked", "-p", "bench_instructions", "--message-format=json"]
    done = subprocess.run(command, cwd=ROOT, stdout=subprocess.PIPE, text=True)
    if done.returncode != 0:
        sys.exit(f"failed: {' '.join(command)}")
    made = [json.loads(line).get("executable") for line in done.stdout.splitlines() if line.startswith("{")]
    return str(next(path for path in reversed(made) if path))


def count(program: str, work: str) -> int:
    """Instructions of a work, without its preparation."""
    with tempfile.TemporaryDirectory() as folder:
        out = Path(folder) / "counts"
        options = ["--tool=callgrind", f"--toggle-collect={COUNTED}", f"--callgrind-out-file={out}"]
        done = subprocess.run(["valgrind", *options, program, work], capture_output=True, text=True)
        if done.returncode != 0:
            sys.exit(f"valgrind failed on {work}:\n{done.stderr}")
        return total(out.read_text())


def total(callgrind: str) -> int:
    """The sum in a file that callgrind has written."""
    found = re.search(r"^(?:totals|summary): (\d+)", callgrind, re.MULTILINE)
    if found is None or int(found[1]) == 0:
        sys.exit(
            "callgrind has counted nothing: was the function `counted` inlined, or were symbols stripped?"
        )
    return int(found[1])


def line(row: Row, tolerance: float) -> str:
    """A row of the table."""
    stored = "–" if row.stored is None else f"{row.stored:,}"
    change = "–" if row.change is None else f"{row.change:+.2%}"
    return f"{row.work:<20} {row.count:>14,} {stored:>14} {change:>8}  {row.verdict(tolerance)}"


def regressions(rows: list[Row], tolerance: float) -> list[Row]:
    """Rows that need more than they may."""
    return [row for row in rows if row.change is not None and row.change > tolerance]


if __name__ == "__main__":
    sys.exit(main())
