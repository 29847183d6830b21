"""Measuring beside other renderers; ``benches/run.py`` is the way in."""
