"""An environment for the benches: ``.venv-bench`` with the peers, Steradian itself, and ``bench_rays``.

In: nothing but Python, pip and Rust. Out: :class:`Prepared`, with the reason for everything that is missing.
Nothing is installed twice; the system's Python stays as it is.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
from dataclasses import asdict, dataclass, field

import dev
from beside.options import ROOT

VENV = ROOT / ".venv-bench"
PYTHON = dev.python_of(VENV)
NEEDED = ("numpy", "matplotlib")
PEERS = {
    "Mitsuba 3": "mitsuba==3.9.1",
    "LuxCore": "pyluxcore==2.11.2",
    "Cycles": "bpy==4.5.15",
    "Embree": "embreex==4.4.0.post1",
}
"""Each is installed by itself, so that one that this Python or system lacks does not keep others away."""


@dataclass
class Prepared:
    """What the measuring process has to know."""

    missing: dict[str, str] = field(default_factory=dict)
    ray_bench: str | None = None
    embree: str | None = None

    def as_json(self) -> str:
        """To be handed over."""
        return json.dumps(asdict(self))


def prepare() -> Prepared:
    """Makes the environment, or brings it up to date. Ends the program if Steradian cannot be built."""
    dev.check_tools()
    dev.make_venv(VENV)
    out = Prepared()
    dev.once(VENV / "tools.txt", "\n".join(NEEDED), "installing NumPy and matplotlib", list(NEEDED), PYTHON)
    for label, requirement in PEERS.items():
        why = _install(label, requirement)
        if why is not None:
            out.missing[label] = why
    dev.once(VENV / "steradian.txt", dev.source_hash(), "building steradian", [str(ROOT)], PYTHON)
    out.ray_bench = _build_ray_bench()
    libraries = sorted(VENV.glob("lib/python*/site-packages/embreex.libs/libembree4*"))
    out.embree = os.environ.get("EMBREE") or (str(libraries[0]) if libraries else None)
    if out.embree is None:
        out.missing.setdefault("Embree", "its library was not found; set EMBREE to libembree4")
    else:
        out.missing.pop("Embree", None)
    return out


def _install(label: str, requirement: str) -> str | None:
    """Installs a peer; why it could not be, or None."""
    stamp = VENV / f"{requirement.split('==')[0]}.txt"
    if stamp.exists() and stamp.read_text(encoding="utf-8") == requirement:
        return None
    dev.say(f"installing {label}")
    command = [*dev.pip(PYTHON), "install", "--disable-pip-version-check", requirement]
    done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode != 0:
        errors = [line for line in done.stderr.splitlines() if line.startswith("ERROR")]
        return f"`pip install {requirement}` failed" + (f": {errors[-1]}" if errors else "")
    stamp.write_text(requirement, encoding="utf-8")
    return None


def _build_ray_bench() -> str:
    """The program that meets rays, built as we ship."""
    dev.say("building bench_rays")
    command = ["cargo", "build", "--release", "--locked", "-p", "bench_rays", "--message-format=json"]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True)
    if done.returncode != 0:
        sys.stderr.write(done.stderr)
        sys.exit(f"failed: {' '.join(command)}")
    made = [json.loads(line).get("executable") for line in done.stdout.splitlines() if line.startswith("{")]
    return str(next(path for path in reversed(made) if path))
