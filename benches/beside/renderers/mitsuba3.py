"""Mitsuba 3, in a compiled variant (vectors of paths) and in the scalar one (one path at a time).

The scene's own camera with a box filter, with which Mitsuba is fastest; ``path`` samples lights and BSDFs
under the power heuristic, as we do. Its ``rr_depth`` counts as ours does.
"""

from __future__ import annotations

import importlib.metadata
import time
from typing import Any

from beside import llvm
from beside.renderers import Job, Timed

NEVER = 1 << 30
"""A depth that no path reaches."""


class _Mitsuba:
    """A job in the variant that a subclass names."""

    version = importlib.metadata.version("mitsuba")
    variant: str

    def __init__(self, job: Job) -> None:
        llvm.point_to_it()
        import drjit as dr
        import mitsuba as mi

        mi.set_variant(self.variant)
        dr.set_thread_count(job.threads)
        self.dr: Any = dr
        self.mi: Any = mi
        self.job = job
        self.scene = mi.load_file(str(job.scene))
        self.sensor = self.scene.sensors()[0]
        parameters = mi.traverse(self.sensor)
        parameters["film.size"] = (job.width, job.height)
        parameters.update()
        roulette = NEVER if job.roulette is None else job.roulette
        self.integrator = mi.load_dict({"type": "path", "max_depth": job.depth, "rr_depth": roulette})
        self.image: Any = None

    def render(self, seed: int) -> Timed:
        """Renders once more."""
        wall, cpu = time.perf_counter(), time.process_time()
        self.image = self.mi.render(
            self.scene,
            sensor=self.sensor,
            integrator=self.integrator,
            spp=self.job.spp,
            seed=self.mi.UInt32(seed),
        )
        self.dr.eval(self.image)
        self.dr.sync_thread()
        return Timed(time.perf_counter() - wall, time.process_time() - cpu)

    def mean(self) -> list[float]:
        """The last image's mean in linear RGB."""
        import numpy as np

        return [float(x) for x in np.array(self.image)[..., :3].mean(axis=(0, 1), dtype="f8")]


class MitsubaLlvm(_Mitsuba):
    """Compiled for this processor by LLVM."""

    variant = "llvm_ad_rgb"


class MitsubaScalar(_Mitsuba):
    """One path at a time."""

    variant = "scalar_rgb"
