"""Progress on standard error: a line that is rewritten on a terminal, a few lines elsewhere."""

from __future__ import annotations

import shutil
import sys
import time
from typing import Self, TextIO

from steradian.render import Progress

REWRITE_SECONDS = 0.2
FIRST_LINE_SECONDS = 10.0
"""When output is no terminal: the first line comes after this time, each next after twice the time."""


class StatusLine:
    """How far something is: a bar that is rewritten on a terminal, elsewhere a line now and then.

    A context manager that leaves a clean line.
    """

    def __init__(self, stream: TextIO | None = None) -> None:
        self._stream = sys.stderr if stream is None else stream
        self._terminal = self._stream.isatty()
        self._next = 0.0 if self._terminal else FIRST_LINE_SECONDS
        self._start = time.monotonic()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        if self._terminal:
            self._stream.write("\r\x1b[K")
            self._stream.flush()

    def elapsed(self) -> float:
        """Seconds since it was made."""
        return time.monotonic() - self._start

    def is_due(self) -> bool:
        """Is it time to show something?"""
        return self.elapsed() >= self._next

    def show(self, text: str, done: float) -> None:
        """Shows a text, and what is done, in [0, 1]."""
        if self._terminal:
            self._next = self.elapsed() + REWRITE_SECONDS
            width = shutil.get_terminal_size().columns
            self._stream.write("\r\x1b[K" + bar(text, done, width))
        else:
            self._next = 2 * self.elapsed()
            self._stream.write(text + "\n")
        self._stream.flush()


class ProgressBar(StatusLine):
    """Shows :class:`steradian.Progress`."""

    def __init__(self, time_limit: float | None, stream: TextIO | None = None) -> None:
        super().__init__(stream)
        self._time_limit = time_limit

    def update(self, progress: Progress) -> None:
        """Shows it, if it is time to."""
        if self.is_due():
            elapsed = self.elapsed()
            text = describe(progress, elapsed, self._time_limit)
            self.show(text, fraction(progress, elapsed, self._time_limit))


def fraction(progress: Progress, elapsed: float, time_limit: float | None) -> float:
    """How much is done, in [0, 1]: of samples or of time, whichever is nearer its end."""
    by_samples = progress.samples_done / progress.samples_total if progress.samples_total else 0.0
    by_time = elapsed / time_limit if time_limit else 0.0
    return min(max(by_samples, by_time), 1.0)


def describe(progress: Progress, elapsed: float, time_limit: float | None) -> str:
    """Such as ``12 / 64 spp · 3.1 s · 13 s left · error 4.2 %``."""
    total = "" if progress.samples_total is None else f" / {progress.samples_total}"
    parts = [f"{progress.samples_done}{total} spp", duration(elapsed)]
    done = fraction(progress, elapsed, time_limit)
    if done > 0.0 and progress.samples_done > 0:
        parts.append(f"{duration(elapsed * (1 - done) / done)} left")
    if progress.mean_relative_error is not None:
        parts.append(f"error {100 * progress.mean_relative_error:.2g} %")
    return " · ".join(parts)


def bar(text: str, done: float, width: int) -> str:
    """A bar before the text, if there is room for it; never wider than the terminal."""
    room = min(width - len(text) - 4, 40)
    if room < 8:
        return text[: width - 1]
    filled = round(done * room)
    return f"{'━' * filled}{'─' * (room - filled)}  {text}"


def duration(seconds: float) -> str:
    """Such as ``3.1 s``, ``2 min 05 s``, ``1 h 10 min``."""
    if seconds < 60:
        return f"{seconds:.1f} s"
    minutes, rest = divmod(round(seconds), 60)
    if minutes < 60:
        return f"{minutes} min {rest:02} s"
    return f"{minutes // 60} h {minutes % 60:02} min"
