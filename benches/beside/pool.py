"""The other end of :mod:`beside.worker`: renderers in processes of their own, asked in turn."""

from __future__ import annotations

import json
import subprocess
import sys
import tempfile
from dataclasses import asdict
from types import TracebackType
from typing import Any

from beside.renderers import ALL, Job, Timed
from beside.worker import MEAN


class WorkerFailed(RuntimeError):
    """The process ended before it answered; the message is the end of what it said."""


class Worker:
    """A renderer with a job, in a process of its own; a context manager."""

    def __init__(self, name: str, job: Job) -> None:
        self.name, self.job = name, job
        self.label = ALL[name].label
        self._errors = tempfile.TemporaryFile()  # noqa: SIM115 (closed with the worker)
        text = json.dumps({**asdict(job), "scene": str(job.scene)})
        self._process = subprocess.Popen(
            [sys.executable, "-m", "beside.worker", name, text],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=self._errors,
            text=True,
        )
        try:
            hello = self._answer()
        except WorkerFailed:
            self.close()
            raise
        self.version: str = hello["version"]
        self.load_seconds: float = hello["load_seconds"]

    def render(self, seed: int) -> Timed:
        """Renders once more."""
        return Timed(**self._ask(str(seed)))

    def mean(self) -> list[float]:
        """The last image's mean in linear RGB."""
        mean: list[float] = self._ask(MEAN)["mean"]
        return mean

    def finish(self) -> float:
        """Peak memory in MiB; ends the process."""
        assert self._process.stdin is not None
        self._process.stdin.close()
        peak: float = self._answer()["peak_mib"]
        return peak

    def close(self) -> None:
        """Ends the process, whatever it does."""
        self._process.kill()
        self._process.wait()
        for pipe in (self._process.stdin, self._process.stdout):
            if pipe is not None:
                pipe.close()
        self._errors.close()

    def __enter__(self) -> Worker:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    def _ask(self, line: str) -> dict[str, Any]:
        assert self._process.stdin is not None
        try:
            self._process.stdin.write(line + "\n")
            self._process.stdin.flush()
        except BrokenPipeError:
            raise WorkerFailed(self._last_words()) from None
        return self._answer()

    def _answer(self) -> dict[str, Any]:
        assert self._process.stdout is not None
        line = self._process.stdout.readline()
        if not line:
            raise WorkerFailed(self._last_words())
        answer: dict[str, Any] = json.loads(line)
        return answer

    def _last_words(self) -> str:
        self._process.wait()
        self._errors.seek(0)
        lines = self._errors.read().decode(errors="replace").strip().splitlines()
        return lines[-1] if lines else f"exit code {self._process.returncode}"
