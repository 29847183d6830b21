"""Is there memory for a film?"""

from __future__ import annotations

import os
import sys

from steradian import _internal


def check_film(width: int, height: int) -> None:
    """Raises MemoryError if a film of this size is larger than the machine's memory."""
    need = _internal.film_bytes(width, height)
    have = physical_bytes()
    if have is not None and need > have:
        raise MemoryError(
            f"a film of {width} x {height} pixels needs about {need / 2**30:.1f} GiB; "
            f"this machine has {have / 2**30:.1f} GiB; choose a smaller size"
        )


def physical_bytes() -> int | None:
    """The machine's memory in bytes; None if the system does not tell."""
    if sys.platform == "win32":
        import ctypes

        kilobytes = ctypes.c_ulonglong(0)
        if ctypes.windll.kernel32.GetPhysicallyInstalledSystemMemory(ctypes.byref(kilobytes)):
            return kilobytes.value * 1024
        return None
    try:
        return os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE")
    except (ValueError, OSError):
        return None
