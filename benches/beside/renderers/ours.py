"""Steradian: the default strategy, independent samples."""

from __future__ import annotations

import time

import steradian as sr
from beside.renderers import Job, Timed


class Steradian:
    """Our own; a render's time includes the way through Python."""

    version = sr.__version__

    def __init__(self, job: Job) -> None:
        self.job = job
        self.scene = sr.load(job.scene, threads=job.threads)
        self.result: sr.Result | None = None

    def render(self, seed: int) -> Timed:
        """Renders once more."""
        job = self.job
        wall, cpu = time.perf_counter(), time.process_time()
        self.result = sr.render(
            self.scene,
            spp=job.spp,
            size=(job.width, job.height),
            max_depth=job.depth,
            roulette_depth=-1 if job.roulette is None else job.roulette,
            sampler="independent",
            seed=seed,
            threads=job.threads,
        )
        return Timed(time.perf_counter() - wall, time.process_time() - cpu)

    def mean(self) -> list[float]:
        """The last image's mean in linear RGB."""
        assert self.result is not None
        return list(self.result.mean)
