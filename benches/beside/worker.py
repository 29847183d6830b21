"""A process that holds one renderer and one job: ``python -m beside.worker RENDERER JOB``.

Lines of JSON go out on the standard output that it was started with: first what it is, then an answer to
each line of standard input. A seed is answered by what a render took, ``mean`` by the mean of its image,
the end of input by the memory that all of it needed. Whatever the renderer itself prints goes to standard
error.
"""

from __future__ import annotations

import json
import os
import re
import resource
import sys
import time
from dataclasses import asdict
from pathlib import Path
from typing import Any

from beside.renderers import ALL, Job

MEAN = "mean"


def main() -> None:
    """Serves one job."""
    name, text = sys.argv[1:]
    fields = json.loads(text)
    job = Job(**{**fields, "scene": Path(fields["scene"])})
    out = os.fdopen(os.dup(1), "w")
    os.dup2(2, 1)

    def say(message: dict[str, Any]) -> None:
        out.write(json.dumps(message) + "\n")
        out.flush()

    start = time.perf_counter()
    renderer = ALL[name].make(job)
    say({"version": renderer.version, "load_seconds": time.perf_counter() - start})
    for line in sys.stdin:
        if line.strip() == MEAN:
            say({"mean": renderer.mean()})
        else:
            say(asdict(renderer.render(int(line))))
    say({"peak_mib": peak_mib()})
    # Some libraries end badly when the interpreter takes them apart.
    out.close()
    os._exit(0)


def peak_mib() -> float:
    """The most memory that this process, or one that it started, had at a time."""
    children = resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss
    # What ``getrusage`` says of this process starts with what its parent had.
    status = Path("/proc/self/status")
    if status.exists():
        own = re.search(r"VmHWM:\s*(\d+) kB", status.read_text())
        if own is not None:
            return max(int(own[1]), children) / 1024
    own_peak = max(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss, children)
    return float(own_peak) / (1 << 20 if sys.platform == "darwin" else 1 << 10)


if __name__ == "__main__":
    main()
