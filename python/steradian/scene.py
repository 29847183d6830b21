"""Scenes: from a file or a dictionary to something that can be rendered."""

from __future__ import annotations

import os
import warnings
from collections import Counter
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any

from steradian import _internal, _jobs
from steradian.diagnostics import Diagnostic, SceneError, SceneWarning
from steradian.limits import checked_limits


@dataclass(frozen=True)
class SceneSettings:
    """What the scene itself asks for; the arguments of :func:`steradian.render` override it."""

    width: int
    """Pixels across."""
    height: int
    """Pixels down."""
    spp: int
    """Samples per pixel."""
    max_depth: int
    """Longest path in edges: 1 emitters only, 2 direct light, -1 unbounded."""
    roulette_depth: int
    """Edges before Russian roulette may end a path; -1: not before the 1024th."""
    hide_emitters: bool
    """Do emitters that the camera sees directly stay black?"""


class Scene:
    """A compiled scene: read-only, shared by any number of renders. Made by :func:`load`."""

    def __init__(
        self, compiled: _internal.Scene, name: str, diagnostics: tuple[Diagnostic, ...], load_seconds: float
    ) -> None:
        self._compiled = compiled
        self.name = name
        """The file's path as it was given, or ``"<dict>"``."""
        self.diagnostics = diagnostics
        """What loading had to say."""
        self.load_seconds = load_seconds
        """Reading, decoding and compiling, in seconds."""

    @property
    def settings(self) -> SceneSettings:
        """What the scene itself asks for."""
        return SceneSettings(**self._compiled.settings())

    def info(self) -> dict[str, Any]:
        """Camera, film, counts, bounds, memory and what is not as asked, as plain values for ``json``."""
        return {
            "scene": self.name,
            "load_seconds": self.load_seconds,
            **self._compiled.info(),
            "approximated": self._codes("approximated"),
            "ignored": self._codes("ignored"),
            "diagnostics": [vars(d) for d in self.diagnostics],
        }

    def _codes(self, effect: str) -> dict[str, int]:
        """How often each code of diagnostics of an effect occurs, the most frequent first."""
        return dict(Counter(d.code for d in self.diagnostics if d.effect == effect).most_common())

    def __repr__(self) -> str:
        return f"<steradian.Scene {self.name}: {self._compiled.info()['triangles']} triangles>"


@dataclass(frozen=True)
class Loaded:
    """A scene, or why there is none; with the text of all diagnostics."""

    scene: Scene | None
    diagnostics: tuple[Diagnostic, ...]
    report: str


def load(
    source: str | os.PathLike[str] | Mapping[str, Any],
    *,
    defines: Mapping[str, Any] | None = None,
    search_paths: Iterable[str | os.PathLike[str]] = (),
    environment: str | os.PathLike[str] | None = None,
    variant: str | None = None,
    limits: Mapping[str, float] | None = None,
    threads: int | None = None,
) -> Scene:
    """Loads a scene.

    Args:
        source: a Mitsuba XML file (0.5, 2 or 3), a pbrt-v4 or glTF 2.0 file, a mesh (OBJ, PLY, STL), or a
            dictionary in the manner of Mitsuba's ``load_dict``:
            ``{"type": "scene", "camera": {"type": "perspective", ...}, "box": {"type": "cube", ...}}``.
            Placements are 4x4 arrays or :class:`steradian.Transform`. A mesh may be given as
            ``{"type": "mesh", "vertices": (n, 3), "faces": (m, 3), "normals": (n, 3), "uvs": (n, 2)}``, the
            last two optional; v counts from the top row of an image. A bitmap may be given as
            ``{"type": "bitmap", "data": (height, width, 3)}``: uint8 is sRGB-encoded, floats are linear.
        defines: values for the file's ``$name``, over its own defaults.
        search_paths: folders for files that are neither beside the scene (for a dictionary, in the current
            folder) nor where it says, in this order.
        environment: an image of latitude and longitude (HDR or EXR), +Y up, put around the scene, as
            Mitsuba's ``envmap``; then no default light is needed. A scene with an environment of its own is
            lit by both, which is said.
        variant: which of the file's sets of materials is shown (glTF's KHR_materials_variants), by its name;
            ``info()["variants"]`` has the names. Without it, the one that the file shows by itself.
        limits: how much is taken in, such as ``{"image_texels": 2**30}``, over the defaults in
            ``docs/import.md``. An error about a limit names it.
        threads: threads to decode and compile with; all available cores unless given.

    Warns:
        SceneWarning: for everything that is not done quite as the description asks.

    Raises:
        SceneError: if there is no scene; the message says why, with file, line and remedy.
        ValueError: if there is no limit of a name, or it cannot be set so.
        NotADirectoryError: if one of ``search_paths`` is no folder.
        KeyboardInterrupt: on Ctrl-C, while loading.
    """
    loaded = load_with_diagnostics(
        source,
        defines=defines,
        search_paths=search_paths,
        environment=environment,
        variant=variant,
        limits=limits,
        threads=threads,
    )
    if loaded.scene is None:
        raise SceneError(loaded.report.strip(), loaded.diagnostics)
    for diagnostic in loaded.diagnostics:
        if diagnostic.severity == "warning":
            warnings.warn(diagnostic.text, SceneWarning, stacklevel=2)
    return loaded.scene


def load_with_diagnostics(
    source: str | os.PathLike[str] | Mapping[str, Any],
    *,
    defines: Mapping[str, Any] | None = None,
    search_paths: Iterable[str | os.PathLike[str]] = (),
    environment: str | os.PathLike[str] | None = None,
    variant: str | None = None,
    limits: Mapping[str, float] | None = None,
    threads: int | None = None,
    color: bool = False,
) -> Loaded:
    """As :func:`load`, but what is wrong is returned; ``color`` adds ANSI escapes to the report."""
    texts = {str(name): as_text(value) for name, value in (defines or {}).items()}
    folders = checked_folders(search_paths)
    most = checked_limits(limits)
    around = None if environment is None else os.fspath(environment)
    if isinstance(source, Mapping):
        name = "<dict>"
        if texts:
            raise ValueError("a dictionary has no $names: put the values in, instead of giving defines")
        if variant is not None:
            raise ValueError("a dictionary has no variants")
        job = _internal.load_dict(dict(source), folders, around, most, checked_threads(threads))
    else:
        name = os.fspath(source)
        pairs = list(texts.items())
        job = _internal.load_file(name, pairs, folders, around, variant, most, checked_threads(threads))
    _jobs.wait(job)
    compiled, found, report, seconds = job.result(color)
    diagnostics = tuple(Diagnostic(**fields) for fields in found)
    scene = None if compiled is None else Scene(compiled, name, diagnostics, seconds)
    return Loaded(scene, diagnostics, report)


def checked_threads(threads: int | None) -> int:
    """A number of threads; 0 stands for all available cores. Raises ValueError if it makes no sense."""
    if threads is None:
        return 0
    if not 1 <= threads <= _internal.MAX_THREADS:
        raise ValueError(f"threads are 1 to {_internal.MAX_THREADS}, not {threads}")
    return int(threads)


def checked_folders(search_paths: Iterable[str | os.PathLike[str]]) -> list[str]:
    """The folders' names; a name by itself is not a list of names."""
    if isinstance(search_paths, str | os.PathLike):
        raise TypeError(f"search_paths is a list of folders: [{os.fspath(search_paths)!r}]")
    folders = [os.fspath(path) for path in search_paths]
    for folder in folders:
        if not os.path.isdir(folder):
            raise NotADirectoryError(f"{folder} is not a folder to look for files in")
    return folders


def as_text(value: Any) -> str:
    """As the file would spell it."""
    if isinstance(value, bool):
        return "true" if value else "false"
    return str(value)
