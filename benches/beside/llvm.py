"""Where LLVM's library is, for Mitsuba's compiled variant, which looks in few places by itself."""

from __future__ import annotations

import ctypes.util
import os
import re
from pathlib import Path

VARIABLE = "DRJIT_LIBLLVM_PATH"
FOLDERS = ("/usr/lib/*-linux-gnu", "/usr/lib64", "/usr/lib/llvm-*/lib", "/opt/homebrew/opt/llvm/lib")


def find() -> str | None:
    """The variable's library, else the newest that is installed."""
    told = os.environ.get(VARIABLE)
    if told:
        return told
    found = [
        path
        for folder in FOLDERS
        for path in Path("/").glob(folder.lstrip("/") + "/libLLVM*")
        if version(path.name) is not None
    ]
    newest = max(found, key=lambda path: version(path.name) or (), default=None)
    return str(newest) if newest else ctypes.util.find_library("LLVM")


def version(name: str) -> tuple[int, ...] | None:
    """Of a library's file name, such as ``libLLVM.so.19.1`` or ``libLLVM-15.so.1``; None if it is none."""
    match = re.fullmatch(r"libLLVM(?:-([\d.]+))?\.(?:so|dylib)((?:\.\d+)*)", name)
    if match is None:
        return None
    numbers = [*(match[1] or "").split("."), *match[2].split(".")]
    return tuple(int(n) for n in numbers if n) or None


def point_to_it() -> None:
    """Sets the variable, before Mitsuba is loaded."""
    path = find()
    if path:
        os.environ[VARIABLE] = path
