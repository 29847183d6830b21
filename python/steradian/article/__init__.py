"""The article, runnable: every experiment, and one HTML page with what came out.

In: a seed. Out: a page, and whether everything on it holds. Needs Matplotlib:
``pip install "steradian[article]"``.

Read :mod:`steradian.article.chapters` first: the list of chapters, each of which is a module that does
what it tells, in the order of the page.
"""

from __future__ import annotations

import importlib.util
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from steradian.article.chapter import Chapter, Finding, Mistake

DEFAULT_SEED = 1

SEEDS_A_CHAPTER = 1000
"""Chapters take their seeds from ranges of this length, so that no two experiments share one."""


@dataclass(frozen=True)
class Written:
    """A page, and what is on it."""

    html: str
    chapters: Sequence[Chapter]

    @property
    def findings(self) -> list[Finding]:
        """All measured values."""
        return [finding for chapter in self.chapters for finding in chapter.findings]

    @property
    def mistakes(self) -> list[Mistake]:
        """All deliberate mistakes."""
        return [mistake for chapter in self.chapters for mistake in chapter.mistakes]

    @property
    def holds(self) -> bool:
        """Does every value hold, and was every mistake caught?"""
        return all(f.holds for f in self.findings) and all(m.caught for m in self.mistakes)


def write(
    seed: int = DEFAULT_SEED,
    *,
    quick: bool = False,
    on_chapter: Callable[[int, int, str], None] | None = None,
) -> Written:
    """Runs every experiment and makes the page; the same seed gives the same values.

    - ``quick``: a sixteenth of the samples
    - ``on_chapter``: called with (index, number, title) as each chapter begins

    Raises ImportError, with the remedy, if Matplotlib is missing.
    """
    if importlib.util.find_spec("matplotlib") is None:
        raise ImportError('the article needs Matplotlib for its plots: pip install "steradian[article]"')
    from steradian.article.chapter import Chapter
    from steradian.article.chapters import CHAPTERS
    from steradian.article.page import page
    from steradian.article.plots import style

    start = time.monotonic()
    chapters = []
    with style():
        for i, module in enumerate(CHAPTERS):
            if on_chapter is not None:
                on_chapter(i, len(CHAPTERS), module.TITLE)
            slug = module.__name__.rpartition(".")[2].replace("_", "-")
            first_seed = SEEDS_A_CHAPTER * (len(CHAPTERS) * seed + i)
            chapter = Chapter(slug, module.TITLE, seed=first_seed, quick=quick)
            module.tell(chapter)
            chapters.append(chapter)
        return Written(page(chapters, seed, time.monotonic() - start), chapters)
