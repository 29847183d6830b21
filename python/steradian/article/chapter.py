"""A chapter under construction: words, code that ran, plots, and what was measured.

In: what a chapter's ``tell`` function says and does, in order. Out: blocks for
:mod:`steradian.article.page`, and findings for its table. Code on the page is the source of the function
that ran, with the call that ran it, so that it can be pasted and gives the same numbers.
"""

from __future__ import annotations

import inspect
import math
import textwrap
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, TypeVar

import steradian as sr

if TYPE_CHECKING:
    from steradian.article.plots import Plot

LEVEL = 0.999
"""Every measured value has to be in its interval of this level about the exact one."""

ROUNDING = 1e-11
"""Relative: what rounding alone explains, where there is no variance."""

QUICK = 16
"""A quick run takes so many times fewer samples."""

T = TypeVar("T")


@dataclass(frozen=True)
class Finding:
    """A row of the table: what was measured, and what it should be."""

    what: str
    """HTML, short."""
    claimed: str
    """What the article says, as HTML; empty where it gives no number."""
    estimate: sr.Estimate
    exact: float
    formula: str
    """Of the exact value, as HTML; may be empty."""
    exactly: bool
    """Is there no variance, so that only rounding is allowed?"""
    chapter: str
    """The slug of the chapter that it belongs to."""

    @property
    def deviation(self) -> float:
        """From the exact value, in standard errors; NaN where there is no variance."""
        if self.exactly:
            return math.nan
        return (float(self.estimate.mean) - self.exact) / float(self.estimate.stderr)

    @property
    def holds(self) -> bool:
        """Is the exact value in the interval of :data:`LEVEL`, or nothing but rounding away?"""
        if self.exactly:
            scale = ROUNDING * max(1.0, abs(self.exact))
            return (
                abs(float(self.estimate.mean) - self.exact) <= scale and float(self.estimate.stderr) <= scale
            )
        low, high = self.estimate.interval(LEVEL)
        return bool(low <= self.exact <= high)


@dataclass(frozen=True)
class Mistake:
    """A deliberate mistake, and the check that found it."""

    what: str
    answer: sr.Estimate | None
    """What one would have believed; None if there was no answer at all."""
    exact: float
    check: str
    """The call that finds it, as HTML."""
    message: str | None
    """What the check said; None if it found nothing."""
    chapter: str

    @property
    def caught(self) -> bool:
        """Did the check find it?"""
        return self.message is not None


@dataclass(frozen=True)
class Text:
    """A paragraph, or several: HTML."""

    html: str


@dataclass(frozen=True)
class Code:
    """What ran, and what it printed."""

    source: str
    output: str


@dataclass(frozen=True)
class Plots:
    """Figures beside one another, with one caption."""

    figures: tuple[Plot, ...]
    caption: str


@dataclass(frozen=True)
class Pictures:
    """Rendered images beside one another."""

    images: tuple[tuple[bytes, str], ...]
    """PNG data, each with its caption."""
    caption: str


Block = Text | Code | Plots | Pictures | Finding | Mistake


@dataclass
class Chapter:
    """Collects what a chapter says, in order."""

    slug: str
    title: str
    seed: int
    """Of the chapter's first experiment; each further one takes the next."""
    quick: bool = False
    blocks: list[Block] = field(default_factory=list)

    def text(self, html: str) -> None:
        """Says something: paragraphs of HTML, parted by empty lines."""
        self.blocks.append(Text(textwrap.dedent(html).strip()))

    def n(self, full: int) -> int:
        """A number of samples: all of them, or fewer if it has to be quick."""
        return max(full // QUICK, 1) if self.quick else full

    def next_seed(self) -> int:
        """A seed that nobody else has."""
        self.seed += 1
        return self.seed - 1

    def run(self, function: Callable[..., T], *helpers: Callable[..., object], **arguments: object) -> T:
        """Runs an experiment with a seed of its own, and shows its source, the call, and what it returned.

        ``helpers``: functions of ours that it needs, to be shown with it.
        """
        if "seed" in inspect.signature(function).parameters:
            arguments.setdefault("seed", self.next_seed())
        result = function(**arguments)
        self.blocks.append(Code(source_of(function, *helpers, **arguments), str(result)))
        return result

    def measure(
        self,
        what: str,
        estimate: sr.Estimate,
        exact: float,
        *,
        claimed: str = "",
        formula: str = "",
        exactly: bool = False,
    ) -> None:
        """Compares what was measured with what it should be; see :class:`Finding`."""
        self.blocks.append(Finding(what, claimed, estimate, exact, formula, exactly, self.slug))

    def plot(self, *figures: Plot, caption: str) -> None:
        """Shows figures, each with a description for those who cannot see it."""
        self.blocks.append(Plots(figures, caption))

    def pictures(self, *images: tuple[bytes, str], caption: str) -> None:
        """Shows rendered images (PNG), each with its caption."""
        self.blocks.append(Pictures(images, caption))

    def mistake(
        self, what: str, answer: sr.Estimate | None, exact: float, check: str, test: Callable[[], object]
    ) -> None:
        """Runs a check that ought to raise ValueError or AssertionError, and keeps what it said."""
        try:
            test()
            message = None
        except (ValueError, AssertionError) as error:
            message = str(error)
        self.blocks.append(Mistake(what, answer, exact, check, message, self.slug))

    @property
    def findings(self) -> list[Finding]:
        """What was measured."""
        return [block for block in self.blocks if isinstance(block, Finding)]

    @property
    def mistakes(self) -> list[Mistake]:
        """The mistakes that were made."""
        return [block for block in self.blocks if isinstance(block, Mistake)]


def source_of(function: Callable[..., object], *helpers: Callable[..., object], **arguments: object) -> str:
    """A program that runs a function with these arguments and prints what it returns."""
    parts = [textwrap.dedent(inspect.getsource(part)).strip() for part in (*helpers, function)]
    call = ", ".join(f"{name}={_literal(value)}" for name, value in arguments.items())
    body = "\n\n".join(parts)
    imports = ["import numpy as np"] if "np." in body else []
    imports.append("import steradian as sr")
    return "\n".join(imports) + f"\n\n{body}\n\nprint({function.__name__}({call}))"


def _literal(value: object) -> str:
    """As a person would write it: 100_000."""
    if isinstance(value, str):
        return f'"{value}"'
    return f"{value:_}" if isinstance(value, int) and value >= 10_000 else repr(value)
