"""How much of a file is taken in: limits by their names, which ``docs/import.md`` lists."""

from __future__ import annotations

from collections.abc import Mapping
from numbers import Real

from steradian import _internal

SUFFIXES = {"K": 2**10, "M": 2**20, "G": 2**30}
"""What a number on the command line may end in."""


def checked_limits(limits: Mapping[str, float] | None) -> list[tuple[str, int]]:
    """Pairs of a name and a number. Raises TypeError for what is no number, ValueError for what is no limit.

    Example:
        >>> checked_limits({"image_texels": 2**30, "file_bytes": 1e10})
        [('image_texels', 1073741824), ('file_bytes', 10000000000)]
    """
    pairs = [(str(name), _whole(str(name), value)) for name, value in (limits or {}).items()]
    _internal.check_limits(pairs)
    return pairs


def parse_limit(text: str) -> tuple[str, int]:
    """``NAME=VALUE``, where VALUE may end in K, M or G, each 1024 of the one before.

    Example:
        >>> parse_limit("file_bytes=8G")
        ('file_bytes', 8589934592)
    """
    name, equals, number = text.partition("=")
    factor = SUFFIXES.get(number[-1:].upper(), 1)
    try:
        value = float(number if factor == 1 else number[:-1]) * factor
    except ValueError:
        value = None
    if value is None or not (name and equals):
        raise ValueError(f"{text!r} is not of the form NAME=VALUE, such as file_bytes=8G")
    [pair] = checked_limits({name: value})
    return pair


def _whole(name: str, value: float) -> int:
    if isinstance(value, bool) or not isinstance(value, Real):
        raise TypeError(f"the limit {name} is a number, not {value!r}")
    if not (0 < value < 2**64 and value == int(value)):
        raise ValueError(f"the limit {name} is a whole number above 0, not {value:g}")
    return int(value)
