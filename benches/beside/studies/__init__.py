"""Studies: each measures one thing, and knows its tables and its bars.

``measure(options)`` returns plain values that JSON can hold; ``tables(found)`` the lines of Markdown that
show them, ``bars(found)`` what is asked of them.
"""

from __future__ import annotations

import importlib
from typing import Any, Protocol

from beside.options import Options
from beside.paired import Bar


class Study(Protocol):
    """A module of this package."""

    TITLE: str

    def measure(self, options: Options) -> dict[str, Any]:
        """Measures; may take minutes."""

    def tables(self, found: dict[str, Any]) -> list[str]:
        """Lines of Markdown."""

    def bars(self, found: dict[str, Any]) -> list[Bar]:
        """What is asked."""


NAMES = ("paths", "rays", "startup", "large", "growth")


def study(name: str) -> Study:
    """The study with this name."""
    module: Any = importlib.import_module(f"beside.studies.{name}")
    found: Study = module
    return found
