"""Scenes to the files of other renderers."""

from __future__ import annotations

import os
import warnings
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from steradian import _internal, _jobs
from steradian.diagnostics import Diagnostic, SceneError, SceneWarning
from steradian.limits import checked_limits
from steradian.scene import as_text, checked_folders, checked_threads


@dataclass(frozen=True)
class Converted:
    """What was written.

    Example:
        >>> from pathlib import Path
        >>> done = Converted((Path("box/mesh.ply"), Path("box.xml")), diagnostics=(), seconds=0.1)
        >>> done.scene.name, done.approximations
        ('box.xml', ())
    """

    files: tuple[Path, ...]
    """All files: meshes, images, and the scene itself as the last one."""
    diagnostics: tuple[Diagnostic, ...]
    """What loading and writing had to say."""
    seconds: float
    """Reading, converting and writing, in seconds."""

    @property
    def scene(self) -> Path:
        """The scene's own file."""
        return self.files[-1]

    @property
    def approximations(self) -> tuple[Diagnostic, ...]:
        """What the format cannot say, and what was written instead."""
        return tuple(d for d in self.diagnostics if d.code.startswith("convert::"))


def convert(
    source: str | os.PathLike[str] | Mapping[str, Any],
    out: str | os.PathLike[str],
    *,
    defines: Mapping[str, Any] | None = None,
    search_paths: Iterable[str | os.PathLike[str]] = (),
    variant: str | None = None,
    limits: Mapping[str, float] | None = None,
    own_plugins: bool = False,
    overwrite: bool = False,
    threads: int | None = None,
) -> Converted:
    """Writes a scene in another format.

    Meshes and images go to a folder beside ``out``, of its name without the extension.

    Example:
        >>> import tempfile
        >>> scene = {
        ...     "type": "scene",
        ...     "camera": {"type": "perspective", "fov": 40},
        ...     "sky": {"type": "constant"},
        ...     "ball": {"type": "sphere", "center": [0, 0, 4]},
        ... }
        >>> with tempfile.TemporaryDirectory() as folder:
        ...     done = convert(scene, f"{folder}/ball.xml")
        ...     done.scene.name, done.scene.read_text().count("<shape")
        ('ball.xml', 1)

    Args:
        source: what :func:`steradian.load` takes.
        out: a file whose name ends in ``.xml`` (Mitsuba 3), ``.pbrt`` (pbrt-v4), ``.gltf`` or ``.glb``
            (glTF 2.0).
        defines: values for the file's ``$name``, over its own defaults.
        search_paths: folders for files that are neither beside the scene nor where it says.
        variant: which of the file's sets of materials is written, as in :func:`steradian.load`.
        limits: how much is taken in, as for :func:`steradian.load`.
        own_plugins: may XML name what Steradian has and Mitsuba has not? Then Mitsuba does not read it;
            otherwise the nearest that Mitsuba has is written.
        overwrite: may files that are there be replaced? Those that the scene is read from never are.
        threads: threads to use; all available cores unless given.

    Warns:
        SceneWarning: for everything that is not written, or not read, quite as the description asks.

    Raises:
        SceneError: if there is no scene.
        FileExistsError: if a file is there already and ``overwrite`` is not set.
        ValueError: if the format is not known, or a file would be replaced that the scene is read from.
    """
    converted, found, report = convert_with_diagnostics(
        source,
        out,
        defines=defines,
        search_paths=search_paths,
        variant=variant,
        limits=limits,
        own_plugins=own_plugins,
        overwrite=overwrite,
        threads=threads,
    )
    if converted is None:
        raise SceneError(report.strip(), found)
    for diagnostic in found:
        if diagnostic.severity == "warning":
            warnings.warn(diagnostic.text, SceneWarning, stacklevel=2)
    return converted


def convert_with_diagnostics(
    source: str | os.PathLike[str] | Mapping[str, Any],
    out: str | os.PathLike[str],
    *,
    defines: Mapping[str, Any] | None = None,
    search_paths: Iterable[str | os.PathLike[str]] = (),
    variant: str | None = None,
    limits: Mapping[str, float] | None = None,
    own_plugins: bool = False,
    overwrite: bool = False,
    threads: int | None = None,
    color: bool = False,
) -> tuple[Converted | None, tuple[Diagnostic, ...], str]:
    """As :func:`convert`, but what is wrong with a scene is returned, with its text for people."""
    texts = {str(name): as_text(value) for name, value in (defines or {}).items()}
    threads = checked_threads(threads)
    folders = checked_folders(search_paths)
    most = checked_limits(limits)
    path = os.fspath(out)
    if isinstance(source, Mapping):
        if texts:
            raise ValueError("a dictionary has no $names: put the values in, instead of giving defines")
        if variant is not None:
            raise ValueError("a dictionary has no variants")
        job = _internal.convert_dict(dict(source), folders, most, path, own_plugins, overwrite, threads)
    else:
        name = os.fspath(source)
        pairs = list(texts.items())
        job = _internal.convert_file(
            name, pairs, folders, variant, most, path, own_plugins, overwrite, threads
        )
    _jobs.wait(job)
    files, found, report, seconds = job.result(color)
    diagnostics = tuple(Diagnostic(**fields) for fields in found)
    if files is None:
        return None, diagnostics, report
    return Converted(tuple(Path(file) for file in files), diagnostics, seconds), diagnostics, report
