"""Renders to be timed beside one another: the same scene, size, samples, depth and strategy.

In: a scene file and settings. Out: functions from a seed to the seconds that a render takes. Sampling is by
BSDFs and lights under the power heuristic, with independent samples.
"""

from __future__ import annotations

import importlib.metadata
import statistics
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import steradian as sr

#: A render with a seed; returns seconds.
Run = Callable[[int], float]
#: A description of a sensor, made with the module ``mitsuba``.
Sensor = Callable[[Any], dict[str, Any]]


@dataclass(frozen=True)
class Work:
    """What is rendered. ``roulette_depth`` of ``None``: no Russian roulette."""

    scene: Path
    width: int
    height: int
    spp: int
    depth: int
    roulette_depth: int | None
    threads: int

    @property
    def paths(self) -> float:
        """Millions of paths."""
        return self.width * self.height * self.spp / 1e6


def native_size(scene: Path) -> tuple[int, int]:
    """Width and height that a scene file asks for."""
    image = sr.render(sr.load(scene), spp=1, max_depth=1).image
    height, width = image.shape[:2]
    return width, height


def steradian_run(work: Work) -> Run:
    """Our render."""
    scene = sr.load(work.scene)

    def run(seed: int) -> float:
        start = time.perf_counter()
        sr.render(
            scene,
            spp=work.spp,
            size=(work.width, work.height),
            max_depth=work.depth,
            roulette_depth=work.roulette_depth,
            sampler="independent",
            seed=seed,
            threads=work.threads,
        )
        return time.perf_counter() - start

    return run


def mitsuba_run(work: Work, variant: str = "llvm_ad_rgb", sensor: Sensor | None = None) -> Run:
    """Mitsuba's, in one of its variants, through the scene's own sensor or another one."""
    import drjit as dr
    import mitsuba as mi

    mi.set_variant(variant)
    if variant.startswith("llvm"):
        dr.set_thread_count(work.threads)
    scene = mi.load_file(str(work.scene))
    view = mi.load_dict(sensor(mi)) if sensor else scene.sensors()[0]
    params = mi.traverse(view)
    params["film.size"] = (work.width, work.height)
    params.update()
    roulette = 1_000_000 if work.roulette_depth is None else work.roulette_depth
    integrator = mi.load_dict({"type": "path", "max_depth": work.depth, "rr_depth": roulette})

    def run(seed: int) -> float:
        start = time.perf_counter()
        image = mi.render(scene, sensor=view, integrator=integrator, spp=work.spp, seed=mi.UInt32(seed))
        dr.eval(image)
        dr.sync_thread()
        return time.perf_counter() - start

    return run


def mitsuba_version() -> str:
    """Which Mitsuba is installed."""
    return importlib.metadata.version("mitsuba")


@dataclass(frozen=True)
class Comparison:
    """Rates in millions of paths a second, one for each pair of renders, and the median of their ratios."""

    ours: list[float]
    theirs: list[float]
    ratio: float


def in_turn(work: Work, ours: Run, theirs: Run, runs: int) -> Comparison:
    """Times two renders in turn, so that a machine whose speed drifts does not favour either."""
    ours(0), theirs(0)  # warm up: threads, caches, compiled kernels
    times = [(ours(seed), theirs(seed)) for seed in range(1, runs + 1)]
    rates = [[work.paths / seconds for seconds in column] for column in zip(*times, strict=True)]
    return Comparison(rates[0], rates[1], statistics.median(their / our for our, their in times))
