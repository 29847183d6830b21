"""Can the outputs be written? Asked before an hour of rendering, not after."""

from __future__ import annotations

import errno
import os
import tempfile
from collections.abc import Callable, Sequence
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
        check_writable(path, _internal.check_format)
    return paths


def check_writable(path: Path, check_name: Callable[[str], None] = lambda name: None) -> None:
    """Raises OSError if a file cannot be written there, and what ``check_name`` raises for its name."""
    if path.is_dir():
        raise IsADirectoryError(errno.EISDIR, "is a directory, not a file to write", str(path))
    check_name(str(path))
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


def write_text(path: Path, text: str) -> None:
    """Writes a file whole or not at all; raises OSError."""
    with tempfile.NamedTemporaryFile("w", encoding="utf-8", dir=path.parent, delete=False) as file:
        try:
            file.write(text)
            file.close()
            # The file is private so far; a new file has the permissions that the user's mask leaves.
            os.chmod(file.name, path.stat().st_mode if path.exists() else 0o666 & ~_mask())
            os.replace(file.name, path)
        except BaseException:
            os.unlink(file.name)
            raise


def _mask() -> int:
    mask = os.umask(0)
    os.umask(mask)
    return mask
