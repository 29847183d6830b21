"""What a render amounts to: the image, its error, and how it was made."""

from __future__ import annotations

import math
import os
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

from steradian import _internal

if TYPE_CHECKING:
    from numpy import float32
    from numpy.typing import NDArray


class Result:
    """An image with a standard error for every pixel and channel. Made by :func:`steradian.render`.

    Arrays are read-only, rows from the top. Standard errors come from eight replicates of the sample sequence
    that are scrambled independently, so that they are honest for Sobol' points too.
    """

    def __init__(
        self,
        film: _internal.Film,
        *,
        settings: dict[str, Any],
        seconds: float,
        cpu_seconds: float,
        stopped: str,
    ) -> None:
        self._film = film
        self.seconds = seconds
        """Wall-clock time spent sampling."""
        self.cpu_seconds = cpu_seconds
        """Processor time spent sampling, over all threads."""
        self.stopped = stopped
        """``"complete"``, ``"time"`` or ``"interrupted"``."""
        self.settings = settings
        """What decides the bits of the image, but for the range of samples; ``max_depth`` -1 is unbounded."""

    @cached_property
    def _image(self) -> _internal.Image:
        return self._film.image()

    @cached_property
    def image(self) -> NDArray[float32]:
        """(height, width, 3): mean radiance, linear RGB (BT.709 primaries)."""
        return self._image.rgb()

    @cached_property
    def stderr(self) -> NDArray[float32]:
        """(height, width, 3): standard error of ``image``; infinite with fewer than two samples."""
        return self._image.stderr()

    @cached_property
    def albedo(self) -> NDArray[float32]:
        """(height, width, 3): mean albedo at the first hit."""
        return self._image.albedo()

    @cached_property
    def normal(self) -> NDArray[float32]:
        """(height, width, 3): mean shading normal at the first hit, world space; 0 where nothing is hit."""
        return self._image.normal()

    @cached_property
    def depth(self) -> NDArray[float32]:
        """(height, width): mean distance to the first hit, scene units; infinite where nothing is hit."""
        return self._image.depth()

    @cached_property
    def alpha(self) -> NDArray[float32]:
        """(height, width): the fraction of samples that hit something."""
        return self._image.alpha()

    @property
    def width(self) -> int:
        """Pixels across."""
        return self._film.size()[0]

    @property
    def height(self) -> int:
        """Pixels down."""
        return self._film.size()[1]

    @property
    def spp(self) -> int:
        """Samples per pixel taken."""
        return self._film.spp()

    @property
    def sample_ranges(self) -> list[tuple[int, int]]:
        """The sample indices that are in, as ``(first, end)``."""
        return self._film.ranges()

    @property
    def rejected_samples(self) -> int:
        """Samples that were infinite or NaN and count as black."""
        return self._film.rejected_samples()

    @cached_property
    def mean(self) -> tuple[float, float, float]:
        """The mean of all pixels, RGB."""
        return self._image.mean()

    @cached_property
    def mean_stderr(self) -> tuple[float, float, float]:
        """The standard error of ``mean``."""
        return self._image.mean_stderr()

    @cached_property
    def mean_relative_error(self) -> float:
        """The pixels' mean standard error over the image's mean, both of luminance: 0.05 is 5 % of noise.

        Infinite with fewer than two samples per pixel, NaN for a black image.
        """
        return self._image.mean_relative_error()

    @property
    def paths_per_second(self) -> float:
        """Camera paths per second of sampling."""
        paths = self.width * self.height * self.spp
        return paths / self.seconds if self.seconds > 0.0 else math.nan

    def write(self, path: str | os.PathLike[str], *, exposure: float = 0.0, tone: str = "srgb") -> None:
        """Writes ``.exr`` (all layers, linear, settings in the header) or ``.png`` (8-bit sRGB).

        The file appears as a whole or not at all. ``exposure`` (in stops) and ``tone`` are for PNG only:
        ``"srgb"`` clips at 1, ``"reinhard"`` is L / (1 + L) on luminance (Reinhard et al. 2002),
        ``"filmic"`` is Narkowicz's fit of the ACES curve (2015).

        Raises ValueError for another extension or tone, OSError if the file cannot be written.
        """
        _internal.write_image(os.fspath(path), self._image, self._metadata(), float(exposure), tone)

    def merge(self, other: Result) -> Result:
        """Returns both results' samples together, as a new result; times add up.

        Merging runs over parts of a sample range gives the same bits as one run over all of it.
        Raises ValueError if settings differ or a sample is in both.
        """
        if not isinstance(other, Result):
            raise TypeError(f"merge takes another result, not {type(other).__name__}")
        for name in self.settings.keys() | other.settings.keys():
            mine, others = self.settings.get(name), other.settings.get(name)
            if mine != others:
                raise ValueError(f"results with different {name} cannot be merged: {mine!r} and {others!r}")
        order = ("complete", "time", "interrupted")
        return Result(
            self._film.merged(other._film),
            settings=dict(self.settings),
            seconds=self.seconds + other.seconds,
            cpu_seconds=self.cpu_seconds + other.cpu_seconds,
            stopped=max(self.stopped, other.stopped, key=order.index),
        )

    def _metadata(self) -> list[tuple[str, str | int | float]]:
        values: dict[str, str | int | float] = {
            name: ("true" if value else "false") if isinstance(value, bool) else value
            for name, value in self.settings.items()
        }
        values["spp"] = self.spp
        values["seconds"] = self.seconds
        values["stopped"] = self.stopped
        values["rejected_samples"] = self.rejected_samples
        values["mean_relative_error"] = self.mean_relative_error
        return list(values.items())

    def _repr_png_(self) -> bytes:
        return _internal.encode_png(self._image, self._metadata(), 0.0, "srgb")

    def __repr__(self) -> str:
        scene = Path(self.settings["scene"]).name
        relative = self.mean_relative_error
        if math.isnan(relative):
            error = "black"
        else:
            error = f"{100 * relative:.2g} % mean error" if math.isfinite(relative) else "error unknown"
        return f"<steradian.Result {scene}: {self.width} x {self.height}, {self.spp} spp, {error}>"
