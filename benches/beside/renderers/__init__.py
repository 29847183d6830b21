"""Renderers behind one interface: a job in, seconds for each render out.

Each one is used in a process of its own (:mod:`beside.worker`), so that their libraries do not meet, and so
that each one's memory can be told. The order here is the order of the tables' columns.
"""

from __future__ import annotations

import importlib
import importlib.util
import os
import shutil
from dataclasses import dataclass
from pathlib import Path
from typing import Protocol


@dataclass(frozen=True)
class Job:
    """What is rendered: ``depth`` counts path edges (2: direct light).

    Russian roulette may end a path from the edge ``roulette`` on; None: it is not played.
    """

    scene: Path
    width: int
    height: int
    spp: int
    depth: int
    roulette: int | None
    threads: int

    @property
    def paths(self) -> int:
        """How many paths a render follows."""
        return self.width * self.height * self.spp


@dataclass(frozen=True)
class Timed:
    """What a render took, in seconds; ``cpu`` is None where only the renderer's own clock counts."""

    wall: float
    cpu: float | None


class Renderer(Protocol):
    """A job, loaded and compiled when it is made."""

    version: str

    def __init__(self, job: Job) -> None: ...

    def render(self, seed: int) -> Timed:
        """Renders once more."""

    def mean(self) -> list[float]:
        """The last image's mean in linear RGB."""


@dataclass(frozen=True)
class Kind:
    """A renderer that may be there.

    ``module`` is imported and ``name`` taken from it; ``plain``: it only gets scenes that
    :mod:`beside.plain` can read. ``needs``: the Python module it stands on, if any.
    """

    label: str
    module: str
    name: str
    needs: str | None
    plain: bool

    def make(self, job: Job) -> Renderer:
        """Loads the renderer and the job."""
        maker: type[Renderer] = getattr(importlib.import_module(self.module), self.name)
        return maker(job)

    def missing(self) -> str | None:
        """Why it cannot be used, with the remedy; None if it can."""
        if self.needs is not None and importlib.util.find_spec(self.needs) is None:
            return f"the Python package {self.needs} is not installed"
        if self.name == "MitsubaLlvm" and not llvm_library():
            return "there is no libLLVM: install it (Debian: libllvm19), or set DRJIT_LIBLLVM_PATH to one"
        if self.label == "pbrt-v4" and not pbrt_binary():
            return "there is no pbrt: put version 4 on the PATH, or set PBRT to the program"
        return None


def llvm_library() -> str | None:
    """The LLVM that Mitsuba's compiled variant uses."""
    from beside import llvm

    return llvm.find()


def pbrt_binary() -> str | None:
    """The program pbrt."""
    return os.environ.get("PBRT") or shutil.which("pbrt")


OURS = "steradian"
ALL = {
    OURS: Kind("Steradian", "beside.renderers.ours", "Steradian", "steradian", plain=False),
    "mitsuba-llvm": Kind("Mitsuba llvm", "beside.renderers.mitsuba3", "MitsubaLlvm", "mitsuba", plain=False),
    "mitsuba-scalar": Kind(
        "Mitsuba scalar", "beside.renderers.mitsuba3", "MitsubaScalar", "mitsuba", plain=False
    ),
    "luxcore": Kind("LuxCore", "beside.renderers.luxcore", "LuxCore", "pyluxcore", plain=True),
    "cycles": Kind("Cycles", "beside.renderers.cycles", "Cycles", "bpy", plain=True),
    "pbrt": Kind("pbrt-v4", "beside.renderers.pbrt", "Pbrt", None, plain=True),
}
