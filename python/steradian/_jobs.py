"""Waiting for compiled work so that Ctrl-C still works."""

from __future__ import annotations

from collections.abc import Callable
from typing import Protocol

POLL_SECONDS = 0.05
"""Python looks at signals between two of these waits."""


class Job(Protocol):
    """Work on a thread of its own, outside the interpreter's lock."""

    def wait(self, seconds: float) -> bool:
        """Waits at most so long; is it done?"""


def wait(job: Job, each: Callable[[], None] | None = None) -> None:
    """Returns when ``job`` is done. ``each`` is called about 20 times a second, on this thread.

    KeyboardInterrupt comes through; the job then goes on by itself.
    """
    while not job.wait(POLL_SECONDS):
        if each is not None:
            each()
