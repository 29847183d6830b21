"""What a command has to say at the end: a summary for people, one object for programs."""

from __future__ import annotations

import json
import math
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from steradian.cli.progress import duration
from steradian.result import Result


def as_json(result: Result, load_seconds: float, paths: Sequence[Path]) -> dict[str, Any]:
    """Everything about a render that is not an image."""
    return {
        **{k: v for k, v in result.settings.items()},
        "spp": result.spp,
        "seconds": result.seconds,
        "load_seconds": load_seconds,
        "cpu_seconds": result.cpu_seconds,
        "paths_per_second": result.paths_per_second,
        "mean": list(result.mean),
        "mean_stderr": list(result.mean_stderr),
        "mean_relative_error": result.mean_relative_error,
        "rejected_samples": result.rejected_samples,
        "stopped": result.stopped,
        "output": [str(path) for path in paths],
    }


def print_json(value: dict[str, Any]) -> None:
    """One object, valid JSON: what is not finite is null."""
    print(json.dumps(_finite(value), allow_nan=False))


def summary(result: Result, load_seconds: float, paths: Sequence[Path]) -> str:
    """A few lines, with error bars."""
    settings = result.settings
    depth = "unbounded" if settings["max_depth"] == -1 else settings["max_depth"]
    mean = ", ".join(measured(m, e) for m, e in zip(result.mean, result.mean_stderr, strict=True))
    lines = [
        f"{result.width} x {result.height}, {result.spp} spp, depth {depth}, {settings['strategy']}, "
        f"{settings['sampler']}, seed {settings['seed']}",
        f"sampled in {duration(result.seconds)} (processor {duration(result.cpu_seconds)}, "
        f"load {duration(load_seconds)}), {result.paths_per_second / 1e6:.3g} million paths/s",
        f"mean {mean}",
        f"mean error of a pixel {percent(result.mean_relative_error)}",
    ]
    if result.rejected_samples:
        lines.append(f"{result.rejected_samples} samples were not finite and count as black")
    lines += [f"wrote {path}" for path in paths]
    return "\n".join(lines)


def measured(mean: float, stderr: float) -> str:
    """A mean with the digits that its error leaves, such as ``0.2513 ± 0.0004``."""
    if not (math.isfinite(stderr) and stderr > 0.0):
        return f"{mean:.4g} ± {'0' if stderr == 0.0 else 'unknown'}"
    digits = max(0, -math.floor(math.log10(stderr)))
    return f"{mean:.{digits}f} ± {stderr:.{digits}f}"


def percent(relative: float) -> str:
    """Such as ``4.2 %``."""
    return f"{100 * relative:.2g} %" if math.isfinite(relative) else "unknown"


def _finite(value: Any) -> Any:
    if isinstance(value, float):
        return value if math.isfinite(value) else None
    if isinstance(value, dict):
        return {k: _finite(v) for k, v in value.items()}
    if isinstance(value, list | tuple):
        return [_finite(v) for v in value]
    return value
