"""Paths per second on a Cornell box, side by side with Mitsuba 3 in one run.

    python benches/cornell_box.py [--size 512] [--spp 16] [--runs 7] [--depth 8] [--threads 2]

Prints one table: each renderer's median, and the median of the ratios of runs that were taken in turn, so
that a machine whose speed drifts does not favour either. The same scene, depth, strategy (BSDF and light
sampling, power heuristic), independent samples, no Russian roulette.

Needs ``steradian`` and ``mitsuba`` (``pip install mitsuba==3.9.1``) in one environment, and LLVM for
Mitsuba's vectorised variant (Debian: ``libllvm19``; elsewhere set ``DRJIT_LIBLLVM_PATH``).
"""

from __future__ import annotations

import argparse
import importlib.metadata
import json
import statistics
import time
from collections.abc import Callable
from pathlib import Path

import steradian as sr

SCENE = Path(__file__).resolve().parent.parent / "scenes" / "cornell-box.xml"


def steradian_run(size: int, spp: int, depth: int, threads: int) -> Callable[[int], float]:
    """A function from a seed to the seconds that one render takes."""
    scene = sr.load(SCENE)

    def run(seed: int) -> float:
        start = time.perf_counter()
        sr.render(
            scene,
            spp=spp,
            size=(size, size),
            max_depth=depth,
            roulette_depth=None,
            sampler="independent",
            seed=seed,
            threads=threads,
        )
        return time.perf_counter() - start

    return run


def mitsuba_run(size: int, spp: int, depth: int, threads: int) -> Callable[[int], float]:
    """The same for Mitsuba's ``llvm_ad_rgb``; kernels are compiled before the clock starts."""
    import drjit as dr
    import mitsuba as mi

    mi.set_variant("llvm_ad_rgb")
    dr.set_thread_count(threads)
    scene = mi.load_file(str(SCENE), res=size, spp=spp)
    sensor = mi.load_dict(
        {
            "type": "perspective",
            "fov": 39.3077,
            "to_world": mi.ScalarTransform4f().look_at(
                origin=[2.78, 2.73, -8], target=[2.78, 2.73, 0], up=[0, 1, 0]
            ),
            "film": {"type": "hdrfilm", "width": size, "height": size, "rfilter": {"type": "box"}},
            "sampler": {"type": "independent", "sample_count": spp},
        }
    )
    integrator = mi.load_dict({"type": "path", "max_depth": depth, "rr_depth": 1_000_000})

    def run(seed: int) -> float:
        start = time.perf_counter()
        image = mi.render(scene, sensor=sensor, integrator=integrator, spp=spp, seed=seed)
        dr.eval(image)
        dr.sync_thread()
        return time.perf_counter() - start

    return run


def main() -> None:
    """Times both in turn and prints the table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    for name, default in (("size", 512), ("spp", 16), ("runs", 7), ("depth", 8), ("threads", 2)):
        parser.add_argument(f"--{name}", type=int, default=default)
    parser.add_argument("--json", action="store_true", help="print one JSON object instead of the table")
    given = parser.parse_args()
    settings = (given.size, given.spp, given.depth, given.threads)
    ours, theirs = steradian_run(*settings), mitsuba_run(*settings)
    ours(0), theirs(0)  # warm up: threads, caches, compiled kernels
    times = [(ours(seed), theirs(seed)) for seed in range(1, given.runs + 1)]
    paths = given.size**2 * given.spp / 1e6
    rates = [[paths / seconds for seconds in column] for column in zip(*times, strict=True)]
    ratio = statistics.median(their / our for our, their in times)
    table = {
        "scene": SCENE.stem,
        **vars(given),
        "steradian_mpaths_per_second": statistics.median(rates[0]),
        "mitsuba_mpaths_per_second": statistics.median(rates[1]),
        "ratio": ratio,
        "mitsuba": importlib.metadata.version("mitsuba"),
    }
    if given.json:
        print(json.dumps(table))
        return
    print(f"{SCENE.stem}, {given.size}², {given.spp} spp, depth {given.depth}, {given.threads} threads")
    for name, column in zip(("steradian", f"mitsuba {table['mitsuba']} llvm"), rates, strict=True):
        low, middle, high = min(column), statistics.median(column), max(column)
        print(f"  {name:22} {middle:6.3f} million paths/s   ({low:.3f} to {high:.3f})")
    print(f"  ratio                  {ratio:6.3f}   (median of {given.runs} pairs)")


if __name__ == "__main__":
    main()
