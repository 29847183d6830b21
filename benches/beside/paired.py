"""Statistics of runs that were taken in turn, and verdicts on them. No measuring happens here."""

from __future__ import annotations

import math
import statistics
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal


def ratio(theirs: Sequence[float], ours: Sequence[float]) -> float:
    """The median over pairs of what they take to what we take: above 1, we are faster."""
    return statistics.median(their / our for their, our in zip(theirs, ours, strict=True))


def slope(x: Sequence[float], y: Sequence[float]) -> float:
    """The exponent k of y ∝ x^k, by least squares on logarithms."""
    return statistics.linear_regression([math.log(v) for v in x], [math.log(v) for v in y]).slope


def geometric_mean(values: Sequence[float]) -> float:
    """Of positive numbers."""
    return statistics.geometric_mean(values)


@dataclass(frozen=True)
class Bar:
    """A bound, and what was measured against it."""

    name: str
    measured: float
    bound: float
    sense: Literal["at least", "at most"]
    unit: str = ""

    @property
    def passed(self) -> bool:
        """Is the bound kept? A measurement that is no number keeps none."""
        if self.sense == "at least":
            return self.measured >= self.bound
        return self.measured <= self.bound

    def as_dict(self) -> dict[str, str | float | bool]:
        """For JSON."""
        return {
            "name": self.name,
            "measured": self.measured,
            "sense": self.sense,
            "bound": self.bound,
            "unit": self.unit,
            "passed": self.passed,
        }
