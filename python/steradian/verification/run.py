"""Running the checks."""

from __future__ import annotations

import difflib
import time
from collections.abc import Callable, Sequence

from steradian import _internal, _jobs
from steradian.verification.found import Block, Failure, Flaw, Found, Row

FAILURE_RATE = 1e-3
"""How often a run may raise a false alarm, unless asked otherwise."""


def blocks() -> list[Block]:
    """All that can be checked."""
    return [Block(*block) for block in _internal.verify_blocks()]


def run(
    names: Sequence[str] = (),
    *,
    seed: int = 1,
    failure_rate: float = FAILURE_RATE,
    flaws: bool = True,
    threads: int = 0,
    on_progress: Callable[[int, int], object] | None = None,
) -> Found:
    """Checks the blocks that have one of the ``names``, or all.

    - ``names``: of groups, of blocks, or parts of a case's name
    - ``seed``: of all samples; each case has samples of its own, whichever others are checked
    - ``failure_rate``: the chance of any false alarm, divided among all tests (Šidák)
    - ``flaws``: check as well that blocks which are wrong on purpose are caught
    - ``on_progress``: is called with how many checks are done, and of how many

    Raises ValueError for a name that nothing has, and for a rate that is not between 0 and 1.
    """
    if not 0 < failure_rate < 1:
        raise ValueError(f"failure_rate is {failure_rate}; it must be between 0 and 1")
    began = time.monotonic()
    job = _internal.VerifyJob.start(list(names), seed, failure_rate, flaws, threads)
    if job.progress()[1] == 0:
        raise ValueError(_nothing_named(names))

    def tell() -> None:
        if on_progress is not None:
            on_progress(*job.progress())

    try:
        _jobs.wait(job, tell)
    except BaseException:
        job.cancel()
        raise
    rows, level, tests, broken = job.take()
    return Found(
        rows=[_row(*row) for row in rows],
        flaws=[Flaw(case, caught_by) for case, caught_by in broken],
        level=level,
        tests=tests,
        failure_rate=failure_rate,
        seed=seed,
        seconds=time.monotonic() - began,
    )


def _row(
    group: str,
    block: str,
    check: str,
    cases: int,
    least_p: float,
    seconds: float,
    failures: list[tuple[str, str, tuple[list[float], list[float]] | None]],
) -> Row:
    found = [Failure(case, what, *(picture or (None, None))) for case, what, picture in failures]
    return Row(group, block, check, cases, least_p, seconds, found)


def _nothing_named(names: Sequence[str]) -> str:
    known = sorted({name for block in blocks() for name in (block.group, block.name)})
    asked = " or ".join(repr(name) for name in names)
    close = [match for name in names for match in difflib.get_close_matches(name, known, n=2)]
    hint = f"; did you mean {' or '.join(repr(name) for name in close)}?" if close else ""
    return f"nothing is named {asked}{hint} (steradian verify --list shows all)"
