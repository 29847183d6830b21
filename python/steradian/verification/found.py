"""What checks found."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Any, NamedTuple


class Block(NamedTuple):
    """Something that is checked."""

    group: str
    """Such as bsdf, light, distribution."""
    name: str
    cases: int
    """How many parameters, and places it is seen from."""


@dataclass(frozen=True)
class Failure:
    """A case that failed a check."""

    case: str
    """The block, its parameters, and from where it is seen."""
    what: str
    """What is wrong."""
    drawn: list[float] | None
    """Of directions: shares of samples in 48 × 96 cells of equal solid angle, rows from +Z down."""
    expected: list[float] | None
    """What the density says that these shares are."""


@dataclass(frozen=True)
class Row:
    """A check on all cases of a block."""

    group: str
    block: str
    check: str
    cases: int
    least_p: float
    """The smallest p-value; 1 if chance does not decide this check."""
    seconds: float
    """Of work, on one core."""
    failures: list[Failure]


@dataclass(frozen=True)
class Flaw:
    """A block that is wrong on purpose."""

    case: str
    caught_by: str | None
    """The first check that it failed; None if nothing noticed."""


@dataclass(frozen=True)
class Found:
    """The outcome of a run."""

    rows: list[Row]
    flaws: list[Flaw]
    level: float
    """A p-value below this fails, so that the whole run raises a false alarm no more often than asked."""
    tests: int
    """How many tests chance decided."""
    failure_rate: float
    """How often a run may raise a false alarm."""
    seed: int
    seconds: float

    @property
    def failures(self) -> list[tuple[Row, Failure]]:
        """All cases that fail, with their rows."""
        return [(row, failure) for row in self.rows for failure in row.failures]

    @property
    def missed(self) -> list[Flaw]:
        """Flaws that no check caught."""
        return [flaw for flaw in self.flaws if not flaw.caught_by]

    @property
    def holds(self) -> bool:
        """Does everything that is right pass, and is everything that is wrong caught?"""
        return not self.failures and not self.missed

    def to_json(self) -> dict[str, Any]:
        """For tools; pictures are left out."""
        rows = [asdict(row) for row in self.rows]
        for row in rows:
            row["failures"] = [{"case": f["case"], "what": f["what"]} for f in row["failures"]]
        return {
            "holds": self.holds,
            "seed": self.seed,
            "failure_rate": self.failure_rate,
            "level": self.level,
            "tests": self.tests,
            "seconds": self.seconds,
            "rows": rows,
            "flaws": [asdict(flaw) for flaw in self.flaws],
        }
