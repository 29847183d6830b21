"""Time to a relative error, by budgets that double."""

from __future__ import annotations

import math
import statistics
import time
import warnings
from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
import vegas

import steradian as sr
from integrals.families import DIM, Case

SMALLEST, LARGEST = 1 << 10, 1 << 24
ENOUGH = 6.0
"""A tool that takes so many times ours without having reached the last goal is not run any longer."""
GOALS = (1e-3, 1e-4)


def ours(case: Case, n: int, seed: int) -> float:
    """sr.adapt with a budget of n evaluations."""
    return float(sr.adapt(case.f, over=[(0, 1)] * DIM, n=n, seed=seed).estimate)


def vegas_warmed(case: Case, n: int, seed: int) -> float:
    """As the manual of vegas advises: five iterations to adapt, thrown away, and ten that count."""
    integrator = _integrator(seed)
    f = vegas.lbatchintegrand(case.f)
    integrator(f, nitn=5, neval=n / 15)
    return float(integrator(f, nitn=10, neval=n / 15).mean)


def vegas_plain(case: Case, n: int, seed: int) -> float:
    """Ten iterations, all of which count."""
    return float(_integrator(seed)(vegas.lbatchintegrand(case.f), nitn=10, neval=n / 10).mean)


def _integrator(seed: int) -> vegas.Integrator:
    integrator = vegas.Integrator([[0, 1]] * DIM)
    integrator.ran_array_generator = np.random.default_rng(seed).random
    return integrator


@dataclass
class Track:
    """What a tool reached with which budgets."""

    run: Callable[[Case, int, int], float]
    n: list[int] = field(default_factory=list)
    error: list[float] = field(default_factory=list)
    seconds: list[float] = field(default_factory=list)

    def is_done(self, longest: float) -> bool:
        """Is the last goal reached, or has it taken too long?"""
        return bool(self.error) and (self.error[-1] < min(GOALS) or self.seconds[-1] > longest)

    def time_to(self, goal: float) -> tuple[float, bool]:
        """Seconds to an error, by a line between logarithms, and was it reached? The longest if not."""
        for i, error in enumerate(self.error):
            if error <= goal:
                if i == 0:
                    return self.seconds[0], True
                low, high = math.log(self.error[i - 1]), math.log(max(error, 1e-300))
                part = (low - math.log(goal)) / (low - high)
                t = (1 - part) * math.log(self.seconds[i - 1]) + part * math.log(self.seconds[i])
                return math.exp(t), True
        return self.seconds[-1], False


def race(case: Case, seeds: int) -> dict[str, Track]:
    """All tools, in turn at each budget and seed, until each is done."""
    tracks = {"ours": Track(ours), "warmed": Track(vegas_warmed), "plain": Track(vegas_plain)}
    n = SMALLEST
    while n <= LARGEST:
        goal, known = tracks["ours"].time_to(min(GOALS)) if n > SMALLEST else (math.inf, False)
        longest = ENOUGH * goal if known else math.inf
        running = [track for track in tracks.values() if not track.is_done(longest)]
        if not running:
            break
        errors: dict[int, list[float]] = {id(track): [] for track in running}
        seconds: dict[int, list[float]] = {id(track): [] for track in running}
        for seed in range(seeds):
            for track in running:
                with warnings.catch_warnings():
                    warnings.simplefilter("ignore")  # too few points, said at each of many tries
                    start = time.perf_counter()
                    value = track.run(case, n, seed)
                    seconds[id(track)].append(time.perf_counter() - start)
                errors[id(track)].append(value / case.exact - 1)
        for track in running:
            track.n.append(n)
            track.error.append(math.sqrt(statistics.fmean(e * e for e in errors[id(track)])))
            track.seconds.append(statistics.median(seconds[id(track)]))
        n *= 2
    return tracks
