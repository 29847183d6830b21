"""Progress, on standard error."""

from __future__ import annotations

import sys
import time

_START = time.monotonic()


def say(text: str) -> None:
    """A line with the time since the start."""
    elapsed = time.monotonic() - _START
    print(f"[{elapsed // 60:2.0f}:{elapsed % 60:02.0f}] {text}", file=sys.stderr, flush=True)
