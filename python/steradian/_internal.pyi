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

class ConvertJob:
    """A scene being converted, on a thread of its own."""

    def wait(self, seconds: float) -> bool:
        """Waits at most so long; is it done?"""
    def result(self, color: bool) -> tuple[list[str] | None, list[dict[str, Any]], str, float]:
        """The files if there was a scene, diagnostics, their text for people, seconds taken. Once."""

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

def check_limits(named: Sequence[tuple[str, int]]) -> None:
    """Raises ValueError unless there are such limits and they can be set so."""

def load_file(
    path: str,
    defines: Sequence[tuple[str, str]],
    search_paths: Sequence[str],
    environment: str | None,
    variant: str | None,
    limits: Sequence[tuple[str, int]],
    threads: int,
) -> LoadJob:
    """Starts to load a file; ``threads`` of 0 are all."""

def load_dict(
    dict: Mapping[str, Any],
    search_paths: Sequence[str],
    environment: str | None,
    limits: Sequence[tuple[str, int]],
    threads: int,
) -> LoadJob:
    """Starts to load a dictionary."""

def convert_file(
    path: str,
    defines: Sequence[tuple[str, str]],
    search_paths: Sequence[str],
    variant: str | None,
    limits: Sequence[tuple[str, int]],
    out: str,
    own_plugins: bool,
    overwrite: bool,
    threads: int,
) -> ConvertJob:
    """Starts to convert a file; ``threads`` of 0 are all."""

def convert_dict(
    dict: Mapping[str, Any],
    search_paths: Sequence[str],
    limits: Sequence[tuple[str, int]],
    out: str,
    own_plugins: bool,
    overwrite: bool,
    threads: int,
) -> ConvertJob:
    """Starts to convert a dictionary."""

def check_target(path: str) -> None:
    """Raises ValueError unless the name's extension is that of a format to convert to."""

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

class Density:
    """A density and how to sample it. Points are rows, (n, dim), in any order of memory."""

    def space(self) -> str:
        """What it is a density of."""
    def is_real(self) -> bool:
        """Is every coordinate a length of its own?"""
    def dim(self) -> int:
        """Coordinates of a point."""
    def uniforms(self) -> int:
        """Uniforms that a sample consumes."""
    def sample(self, u: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """(n, uniforms) → points (n, dim) and densities (n,), 0 where nothing is drawn."""
    def pdf(self, x: NDArray[np.float64]) -> NDArray[np.float64]:
        """(n, dim) → (n,)."""
    def has_inverse(self) -> bool:
        """Can samples be traced back to their uniforms?"""
    def invert(self, x: NDArray[np.float64]) -> NDArray[np.float64]:
        """(n, dim) → (n, uniforms); NaN outside the support. TypeError if that is not possible."""
    def has_cdf(self) -> bool:
        """Is the distribution function known?"""
    def cdf(self, x: NDArray[np.float64]) -> NDArray[np.float64]:
        """(n,) → (n,). TypeError if it is not known."""
    def icdf(self, u: NDArray[np.float64]) -> NDArray[np.float64]:
        """(n,) → (n,). TypeError if it is not known."""
    def support(self) -> list[tuple[float, float]]:
        """(low, high) of each coordinate."""
    def domain(self) -> list[tuple[float, float]] | None:
        """Where an integrand should be covered, if that is known."""
    def mean(self) -> list[float] | None:
        """The expected point, if it is known."""

class Native:
    """A compiled function, which any thread may call."""

    def __init__(self, address: int, call: str, data: int, owner: object) -> None:
        """``address`` must be that of a function of the kind ``call``, which ``owner`` keeps alive."""
    def with_data(self, data: int) -> Native:
        """The same with the address of its data."""

class Integral:
    """An integral, or several, with what is known of their errors."""

    mean: list[float]
    stderr: list[float]
    covariance: list[float]
    dof: int
    n: int
    nans: int
    not_drawn: int
    largest_share: float
    effective_n: float
    tail_index: float | None
    has_heavy_tail: bool
    ended_by_cap: bool
    seconds: float
    contradicted: tuple[int, float, float] | None

def integrate(density: Density, f: object, request: Mapping[str, Any]) -> Integral:
    """``request``: the fields of ``Request`` in crates/sr_python/src/integrate/run.rs."""

def mis_integrate(
    densities: Sequence[Density], counts: Sequence[int], heuristic: str, f: object, request: Mapping[str, Any]
) -> Integral:
    """As ``integrate``, with samples of several densities."""

def ris_integrate(
    source: Density, target: object, candidates: int, f: object, request: Mapping[str, Any]
) -> Integral:
    """As ``integrate``, with samples that are chosen among candidates."""

class Adapted:
    """An integral, the density that was learned for it, and whether what was seen on the way agrees."""

    integral: Integral
    parts: tuple[
        list[tuple[list[list[float]], list[float], list[float]]], list[int], list[tuple[int, float] | None]
    ]
    rounds: list[tuple[list[float], list[float], int, float, int, int]]
    chi2: float
    dof: int
    n: int
    q: float

def adapt(over: Density, f: object, request: Mapping[str, Any]) -> Adapted:
    """As ``integrate``, with a density that is learned over another."""

def learned(
    over: Density,
    components: Sequence[tuple[Sequence[Sequence[float]], Sequence[float], Sequence[float]]],
    shares: Sequence[int],
    strata: Sequence[tuple[int, float] | None],
) -> Density:
    """A density that was learned before."""

def points(sequence: str, dim: int, n: int, seed: int, replicate: int, first: int) -> NDArray[np.float64]:
    """(n, dim) points of a sequence."""

def chi2(density: Density, samples: int, cells: int, seed: int) -> tuple[float, float, float, str]:
    """Do samples follow their density? Statistic, degrees of freedom, p-value, remark."""

def ks(x: NDArray[np.float64], cdf: NDArray[np.float64]) -> tuple[float, float, float, str]:
    """Were ascending numbers (n,) drawn with a cdf of these values (n,)? As :func:`chi2`."""

def student_t(p: float, dof: float) -> float:
    """The number that Student's t stays below with probability ``p``."""

def format_uncertain(mean: float, stderr: float) -> str:
    """``25.0013 ± 0.0046``."""

def foreign_density(
    object: object,
    name: str,
    space: str,
    dim: int,
    uniforms: int,
    support: Sequence[tuple[float, float]],
) -> Density:
    """A density whose ``_sample_rows`` and ``_pdf_rows`` are Python's; ``name`` is for messages."""

def uniform(low: float, high: float) -> Density: ...
def uniform_box(sides: Sequence[tuple[float, float]]) -> Density: ...
def linear(low: float, high: float, at_low: float, at_high: float) -> Density: ...
def tent(low: float, peak: float, high: float) -> Density: ...
def exponential(rate: float) -> Density: ...
def normal(mean: float, sd: float) -> Density: ...
def power(exponent: float, low: float, high: float) -> Density: ...
def truncated(of: Density, low: float, high: float) -> Density: ...
def product(factors: Sequence[Density]) -> Density: ...
def mixture(components: Sequence[Density], weights: Sequence[float]) -> Density: ...
def piecewise_constant(edges: NDArray[np.float64], counts: NDArray[np.float64]) -> Density: ...
def piecewise_linear(x: NDArray[np.float64], y: NDArray[np.float64]) -> Density: ...
def discrete(weights: NDArray[np.float64]) -> Density: ...
def alias(weights: NDArray[np.float64]) -> Density: ...
def tabulated_2d(values: NDArray[np.float64], low: Sequence[float], high: Sequence[float]) -> Density: ...
def from_pdf(f: object, low: float, high: float, tolerance: float) -> tuple[Density, float, float]:
    """``f``: (n,) → (n,). The density, its error and the integral of ``f``."""

def disk(radius: float) -> Density: ...
def uniform_sphere() -> Density: ...
def uniform_hemisphere(axis: Sequence[float]) -> Density: ...
def cosine_hemisphere(axis: Sequence[float]) -> Density: ...
def cone(axis: Sequence[float], angle: float) -> Density: ...
def von_mises_fisher(mean_direction: Sequence[float], kappa: float) -> Density: ...
def visible_normals(wo: Sequence[float], alpha: Sequence[float]) -> Density: ...
def area_light(
    corner: Sequence[float], edge1: Sequence[float], edge2: Sequence[float], seen_from: Sequence[float]
) -> Density: ...
def spherical_triangle(a: Sequence[float], b: Sequence[float], c: Sequence[float]) -> Density: ...
def spherical_rectangle(
    corner: Sequence[float], edge1: Sequence[float], edge2: Sequence[float], seen_from: Sequence[float]
) -> Density: ...
def affine(of: Density, matrix: NDArray[np.float64], offset: NDArray[np.float64]) -> Density:
    """``matrix``: row after row."""

class VerifyJob:
    """Checks of all building blocks that run."""

    @staticmethod
    def start(
        names: Sequence[str], seed: int, failure_rate: float, flaws: bool, threads: int
    ) -> VerifyJob: ...
    def wait(self, seconds: float) -> bool: ...
    def progress(self) -> tuple[int, int]: ...
    def cancel(self) -> None: ...
    def take(
        self,
    ) -> tuple[
        list[
            tuple[
                str,
                str,
                str,
                int,
                float,
                float,
                list[tuple[str, str, tuple[list[float], list[float]] | None]],
            ]
        ],
        float,
        int,
        list[tuple[str, str | None]],
    ]: ...

def verify_blocks() -> list[tuple[str, str, int]]:
    """Group and name of every block, and how many cases it has."""

def find_numpy() -> None:
    """Looks up NumPy's functions, which must not be interrupted."""
