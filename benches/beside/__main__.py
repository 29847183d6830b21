"""Measures, prints and stores; what ``benches/run.py`` starts in the environment that it has made."""

from __future__ import annotations

import argparse
import datetime
import json
import subprocess
import sys
from pathlib import Path
from typing import Any

from beside import arguments, generated, machine, report
from beside.options import ROOT, Options
from beside.renderers import ALL, OURS
from beside.say import say
from beside.studies import NAMES, growth, study


def main() -> int:
    """Does what is asked; 1 if a study failed."""
    parser = arguments.parser()
    parser.add_argument("--prepared", type=Path, required=True, help=argparse.SUPPRESS)
    given = parser.parse_args()
    prepared = json.loads(given.prepared.read_text())
    missing: dict[str, str] = dict(prepared["missing"])
    options = _options(given, prepared, missing)
    results: dict[str, Any] = {
        "date": datetime.datetime.now(datetime.UTC).strftime("%Y-%m-%d %H:%M UTC"),
        "commit": _commit(),
        "machine": {**machine.describe(), "load_before": machine.load()},
        "quick": options.quick,
        "runs": options.runs,
        "threads": options.threads,
        "missing": missing,
        "studies": {},
        "failed": {},
    }
    folder = _folder(given, options)
    for name in given.only or NAMES:
        try:
            results["studies"][name] = study(name).measure(options)
        except (OSError, RuntimeError, subprocess.SubprocessError) as error:
            results["failed"][name] = str(error)
            say(f"{name} failed: {error}")
        # After each: what took minutes is not lost if a later one is interrupted.
        text = report.page(results)
        _store(results, text, folder)
    say(f"wrote {folder / 'beside.md'} and beside.json")
    if given.json:
        json.dump(results, sys.stdout, indent=1)
        print()
    else:
        print(text)
    return 1 if results["failed"] else 0


def _options(given: argparse.Namespace, prepared: dict[str, Any], missing: dict[str, str]) -> Options:
    """What can be done; what cannot is added to ``missing``."""
    there = []
    for name, kind in ALL.items():
        if name != OURS and given.peers is not None and name not in given.peers:
            continue
        why = kind.missing()
        if why is None:
            there.append(name)
        else:
            missing.setdefault(kind.label, why)
    embree = prepared["embree"]
    return Options(
        quick=given.quick,
        runs=given.runs or (2 if given.quick else 7),
        threads=given.threads,
        renderers=tuple(there),
        scenes=given.scenes,
        also=tuple(given.also),
        ray_bench=Path(prepared["ray_bench"]) if prepared["ray_bench"] else None,
        embree=Path(embree) if embree else None,
    )


def _folder(given: argparse.Namespace, options: Options) -> Path:
    """Where the page goes: to the documentation only if everything was measured."""
    if given.output is not None:
        folder: Path = given.output
        return folder
    return generated.FOLDER if options.quick or given.only or given.peers is not None else ROOT / "docs"


def _store(results: dict[str, Any], text: str, folder: Path) -> None:
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "beside.md").write_text(text, encoding="utf-8")
    (folder / "beside.json").write_text(json.dumps(results, indent=1) + "\n", encoding="utf-8")
    if "growth" in results["studies"]:
        growth.plot(results["studies"]["growth"], folder / "growth.svg")


def _commit() -> str:
    """What was measured; with a plus sign if files differ from it."""
    command = ["git", "-C", str(ROOT), "describe", "--always", "--dirty=+", "--exclude=*"]
    done = subprocess.run(command, capture_output=True, text=True)
    return done.stdout.strip() if done.returncode == 0 else "unknown"


if __name__ == "__main__":
    sys.exit(main())
