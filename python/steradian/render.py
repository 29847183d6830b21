"""Rendering: settings in, a :class:`steradian.Result` out."""

from __future__ import annotations

import math
import time as clock
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Literal

from steradian import _internal, _jobs, _memory
from steradian.result import Result
from steradian.scene import Scene, checked_threads
from steradian.strategy import Density, Strategy, strategy as as_strategy

MAX_SPP = 2**31 - 1
"""The most samples per pixel."""


@dataclass(frozen=True)
class Progress:
    """How far a render is."""

    samples_done: int
    """Samples per pixel so far."""
    samples_total: int | None
    """Samples per pixel in the end; None if only time ends the render."""
    seconds: float
    """Since sampling began."""
    mean_relative_error: float | None
    """As :attr:`steradian.Result.mean_relative_error`, from a moment ago; None at first."""


def render(
    scene: Scene,
    *,
    spp: int | None = None,
    time: float | None = None,
    strategy: str | Density | Strategy | None = None,
    sampler: str = "sobol",
    max_depth: int | None = None,
    roulette_depth: int | None = None,
    hide_emitters: bool | None = None,
    size: tuple[int, int] | None = None,
    seed: int = 0,
    threads: int | None = None,
    first_sample: int = 0,
    on_progress: Callable[[Progress], None] | None = None,
    on_interrupt: Literal["raise", "return"] = "raise",
) -> Result:
    """Renders a scene.

    The same scene, settings and seed give the same bits, for any number of threads; samples 0 to 31 merged
    with samples 32 to 63 (``first_sample=32``) give the bits of samples 0 to 63.

    Args:
        scene: from :func:`steradian.load`.
        spp: samples per pixel; the scene's own number if neither this nor ``time`` is given.
        time: stop after so many seconds of sampling, but not before each pixel has a sample; whichever of
            ``spp`` and ``time`` comes first.
        strategy: how directions are chosen, such as ``0.5 * sr.cosine + 0.5 * sr.light`` or its text;
            ``sr.mis(sr.bsdf, sr.light)`` unless given.
        sampler: ``"sobol"`` (Owen-scrambled) or ``"independent"``.
        max_depth: longest path in edges: 1 emitters only, 2 direct light, -1 unbounded; the scene's
            unless given.
        roulette_depth: edges before Russian roulette may end a path; at most 1024, which -1 stands for; the
            scene's unless given.
        hide_emitters: do emitters seen directly stay black? The scene's unless given.
        size: (width, height) in pixels; the scene's unless given.
        seed: 0 to 2^64 - 1.
        threads: all available cores unless given.
        first_sample: index of the first sample; for runs that will be merged.
        on_progress: called on this thread a few times a second.
        on_interrupt: on Ctrl-C, ``"raise"`` KeyboardInterrupt, or ``"return"`` what is there, with
            ``result.stopped == "interrupted"``. A second Ctrl-C raises in any case.

    Raises:
        TypeError: if ``scene`` is none.
        ValueError: if a setting makes no sense.
        MemoryError: if the film is larger than the machine's memory.
    """
    if not isinstance(scene, Scene):
        raise TypeError(f"render takes a scene, not {type(scene).__name__}; load it first: sr.load(...)")
    own = scene.settings
    width, height = _checked_size((own.width, own.height) if size is None else size)
    if on_interrupt not in ("raise", "return"):
        raise ValueError(f'on_interrupt is "raise" or "return", not {on_interrupt!r}')
    first_sample = _checked_integer("first_sample", first_sample, 0, MAX_SPP - 1)
    count, total = _sample_count(spp, time, own.spp, first_sample)
    settings: dict[str, Any] = {
        "scene": scene.name,
        "width": width,
        "height": height,
        "strategy": str(as_strategy("mis(bsdf, light)" if strategy is None else strategy)),
        "sampler": _internal.normalize_sampler(sampler),
        "seed": _checked_integer("seed", seed, 0, 2**64 - 1),
        "max_depth": _checked_depth("max_depth", own.max_depth if max_depth is None else max_depth),
        "roulette_depth": _checked_depth(
            "roulette_depth", own.roulette_depth if roulette_depth is None else roulette_depth
        ),
        "hide_emitters": bool(own.hide_emitters if hide_emitters is None else hide_emitters),
        "version": _internal.__version__,
    }
    _memory.check_film(width, height)

    cpu_before = clock.process_time()
    request = {
        **settings,
        "first_sample": first_sample,
        "count": count,
        "time_limit": time,
        "threads": checked_threads(threads),
        "watch_error": on_progress is not None,
    }
    job = _internal.RenderJob(scene._compiled, request)
    interrupted = _run(job, total, on_progress)
    if interrupted and on_interrupt == "raise":
        raise KeyboardInterrupt
    film, stopped, seconds = job.result()
    return Result(
        film,
        settings=settings,
        seconds=seconds,
        cpu_seconds=clock.process_time() - cpu_before,
        stopped=stopped,
    )


def _run(job: _internal.RenderJob, total: int | None, on_progress: Callable[[Progress], None] | None) -> bool:
    """Waits for the end; was it Ctrl-C that brought it?"""

    def report() -> None:
        if on_progress is not None:
            done, seconds, error = job.progress()
            on_progress(Progress(done, total, seconds, error))

    try:
        _jobs.wait(job, report)
    except KeyboardInterrupt:
        job.cancel()
        _jobs.wait(job)
        return True
    except BaseException:
        job.cancel()
        raise
    report()
    return False


def _sample_count(
    spp: int | None, time: float | None, own_spp: int, first_sample: int
) -> tuple[int, int | None]:
    """Samples to take at most, and the number to show as the total."""
    if time is not None and not (time > 0.0 and math.isfinite(time)):
        raise ValueError(f"time is a positive number of seconds, not {time}")
    most = MAX_SPP - first_sample
    if spp is not None:
        spp = _checked_integer("spp", spp, 1, most)
        return spp, spp
    if time is not None:
        return most, None
    return own_spp, own_spp


def _checked_size(size: tuple[int, int]) -> tuple[int, int]:
    try:
        if isinstance(size, str):
            raise TypeError
        width, height = size
    except (TypeError, ValueError):
        raise ValueError(f"size is (width, height) in pixels, such as (640, 360), not {size!r}") from None
    _internal.check_film_size(
        _checked_integer("width", width, 1, 2**32 - 1), _checked_integer("height", height, 1, 2**32 - 1)
    )
    return int(width), int(height)


def _checked_depth(name: str, value: int) -> int:
    if value == -1:
        return -1
    try:
        return _checked_integer(name, value, 1, 2**31 - 1)
    except ValueError:
        raise ValueError(f"{name} counts path edges: at least 1, or -1 for no limit, not {value}") from None


def _checked_integer(name: str, value: int, low: int, high: int) -> int:
    try:
        integer = value.__index__()
    except AttributeError:
        raise TypeError(f"{name} is a whole number, not {value!r}") from None
    if not low <= integer <= high:
        raise ValueError(f"{name} is a whole number from {low} to {high}, not {value}")
    return integer
