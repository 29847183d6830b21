"""What is wrong with an integrand, or with the density that should sample it."""

from __future__ import annotations

from collections.abc import Sequence


class IntegrandError(ValueError):
    """The integrand returned a number that is infinite or none.

    ``x``: the first point where it does; ``value``: what it returned there; ``count``: at how many
    points so far.
    """

    def __init__(
        self, message: str, x: Sequence[float] = (), value: float = float("nan"), count: int = 0
    ) -> None:
        super().__init__(message)
        self.x = list(x)
        self.value = value
        self.count = count


class SupportError(ValueError):
    """A density is 0 where the integrand is not, so that samples would miss a part of the integral.

    ``x``: such a point; ``value``: the integrand there.
    """

    def __init__(
        self, message: str, x: Sequence[float] = (), value: float = float("nan"), count: int = 1
    ) -> None:
        super().__init__(message)
        self.x = list(x)
        self.value = value
        self.count = count


class IntegrationWarning(UserWarning):
    """The answer may be less sure than it says."""
