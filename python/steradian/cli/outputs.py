"""Can the outputs be written? Asked before an hour of rendering, not after."""

from __future__ import annotations

import errno
import os
import tempfile
from collections.abc import Sequence
from pathlib import Path

from steradian import _internal


def resolve(asked: Sequence[str] | None, scene: str) -> list[Path]:
    """The files to write: those asked for, or the scene's name with ``.exr`` in the current folder.

    Raises ValueError or OSError for the first that cannot be written.
    """
    paths = (
        [Path(name) for name in asked] if asked else [Path(Path(scene).stem or "scene").with_suffix(".exr")]
    )
    for path in paths:
        _check(path)
    return paths


def _check(path: Path) -> None:
    if path.is_dir():
        raise IsADirectoryError(errno.EISDIR, "is a directory, not a file to write", str(path))
    _internal.check_format(str(path))
    folder = path.parent
    if not folder.is_dir():
        raise FileNotFoundError(errno.ENOENT, f"cannot be written: there is no folder {folder}", str(path))
    if path.exists() and not os.access(path, os.W_OK):
        raise PermissionError(errno.EACCES, "cannot be written: the file is read-only", str(path))
    try:
        with tempfile.TemporaryFile(dir=folder):
            pass
    except OSError as error:
        raise type(error)(
            error.errno, f"cannot be written: the folder does not take files ({error.strerror})", str(path)
        ) from None
