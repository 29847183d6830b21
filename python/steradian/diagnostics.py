"""What a scene has to say about itself: warnings, errors, and where they come from."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass


@dataclass(frozen=True)
class Diagnostic:
    """One thing to tell the user."""

    severity: str
    """``"note"`` (rendered as asked, but not quite as the renderer does it that the file is for),
    ``"warning"`` (rendered, but not quite as asked) or ``"error"`` (no scene)."""
    code: str
    """A stable name, such as ``mitsuba::unknown-property``."""
    message: str
    """One sentence."""
    source: str
    """The file, or the place in a dictionary; empty if it is about neither."""
    line: int
    """One-based; 0 if there is none."""
    column: int
    """One-based; 0 if there is none."""
    hint: str | None
    """A guess, such as ``did you mean "roughness"?``"""
    consequence: str | None
    """What happens instead."""
    effect: str | None
    """``"approximated"`` (something else, or nearly the same, is shown instead) or ``"ignored"`` (it is as if
    the file did not ask for it); None for an error."""
    text: str
    """All of this on one line."""

    def __str__(self) -> str:
        return self.text


class SceneWarning(UserWarning):
    """The scene is rendered, but not quite as its description asks."""


class SceneError(ValueError):
    """There is no scene. The message shows every diagnostic with the lines it speaks of."""

    def __init__(self, message: str, diagnostics: Sequence[Diagnostic] = ()) -> None:
        super().__init__(message)
        self.diagnostics = tuple(diagnostics)
        """Everything found, errors and warnings."""
