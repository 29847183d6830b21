"""The compiled core. Private: use the names of ``steradian`` itself."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

__version__: str
MAX_THREADS: int

class Scene:
    """A compiled scene. Read-only."""

    def settings(self) -> dict[str, Any]:
        """The fields of ``steradian.scene.SceneSettings``."""
    def info(self) -> dict[str, Any]:
        """Camera, film, counts, bounds (two corners, or None) and memory."""

class LoadJob:
    """A scene being loaded, on a thread of its own."""

    def wait(self, seconds: float) -> bool:
        """Waits at most so long; is it done?"""
    def result(self, color: bool) -> tuple[Scene | None, list[dict[str, Any]], str, float]:
        """The scene if there is one, diagnostics, their text for people, seconds taken. Once."""

class RenderJob:
    """A render under way, on a thread of its own. Dropping it cancels it."""

    def __init__(self, scene: Scene, request: Mapping[str, Any]) -> None:
        """``request``: the fields of ``Request`` in crates/sr_python/src/render.rs."""
    def wait(self, seconds: float) -> bool:
        """Waits at most so long; is it done?"""
    def progress(self) -> tuple[int, float, float | None]:
        """Samples per pixel done, seconds, mean relative error if known."""
    def cancel(self) -> None:
        """Asks it to stop soon."""
    def result(self) -> tuple[Film, str, float]:
        """The film, why it ended, seconds of sampling. Once."""

class Film:
    """Accumulated samples. Read-only."""

    def size(self) -> tuple[int, int]:
        """Width and height in pixels."""
    def spp(self) -> int:
        """Samples per pixel."""
    def ranges(self) -> list[tuple[int, int]]:
        """The sample indices that are in, as (first, end)."""
    def rejected_samples(self) -> int:
        """Samples that were not finite."""
    def image(self) -> Image:
        """Means and errors."""
    def merged(self, other: Film) -> Film:
        """The samples of both. Raises ValueError if sizes differ or a sample is in both."""

class Image:
    """Means, standard errors and features; arrays are read-only copies, rows from the top."""

    def rgb(self) -> NDArray[np.float32]:
        """(height, width, 3): mean radiance."""
    def stderr(self) -> NDArray[np.float32]:
        """(height, width, 3): its standard error."""
    def albedo(self) -> NDArray[np.float32]:
        """(height, width, 3)."""
    def normal(self) -> NDArray[np.float32]:
        """(height, width, 3): world space."""
    def depth(self) -> NDArray[np.float32]:
        """(height, width): distance, scene units."""
    def alpha(self) -> NDArray[np.float32]:
        """(height, width): the fraction of samples that hit something."""
    def mean(self) -> tuple[float, float, float]:
        """Of all pixels, RGB."""
    def mean_stderr(self) -> tuple[float, float, float]:
        """Of that mean."""
    def mean_relative_error(self) -> float:
        """Mean standard error over mean, of luminance."""

def load_file(path: str, defines: Sequence[tuple[str, str]], threads: int) -> LoadJob:
    """Starts to load a file; ``threads`` of 0 are all."""

def load_dict(dict: Mapping[str, Any], threads: int) -> LoadJob:
    """Starts to load a dictionary."""

def normalize_strategy(expression: str) -> str:
    """The normal form; ValueError names the place and the remedy."""

def normalize_sampler(name: str) -> str:
    """The normal form; ValueError names the choices."""

def tones() -> list[str]:
    """The names of the tone curves."""

def check_film_size(width: int, height: int) -> None:
    """Raises ValueError for a film that is empty or too large."""

def film_bytes(width: int, height: int) -> int:
    """The memory that a render of this size needs for its film at least."""

def check_format(path: str) -> None:
    """Raises ValueError unless the extension is that of a format."""

def write_image(
    path: str,
    image: Image,
    metadata_values: Sequence[tuple[str, str | int | float]],
    exposure: float,
    tone: str,
) -> None:
    """Writes the format that the name asks for, whole or not at all."""

def encode_png(
    image: Image, metadata_values: Sequence[tuple[str, str | int | float]], exposure: float, tone: str
) -> bytes:
    """PNG data."""
