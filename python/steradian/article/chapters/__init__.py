"""The chapters of the article, in order: a module each, with ``TITLE`` and ``tell``."""

from types import ModuleType

from steradian.article.chapters import (
    area_light,
    combining,
    cornell_box,
    expected_value,
    hemisphere,
    histogram,
    line,
    mistakes,
    mixture,
    sphere,
    throwing_points,
)

CHAPTERS: list[ModuleType] = [
    throwing_points,
    expected_value,
    line,
    histogram,
    sphere,
    hemisphere,
    area_light,
    mixture,
    cornell_box,
    combining,
    mistakes,
]
