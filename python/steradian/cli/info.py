"""``steradian info``."""

from __future__ import annotations

import argparse
import math
from typing import Any

from steradian.cli.loading import load
from steradian.cli.report import print_json

FAILED = 1


def info(arguments: argparse.Namespace) -> int:
    """Says what is in a scene; the exit code."""
    scene = load(arguments)
    if scene is None:
        return FAILED
    values = scene.info()
    if arguments.json:
        print_json(values)
    else:
        print(describe(values))
    return 0


def describe(values: dict[str, Any]) -> str:
    """A few lines for people."""
    camera, film, settings = values["camera"], values["film"], values["settings"]
    depth = "unbounded" if settings["max_depth"] == -1 else f"{settings['max_depth']} edges"
    crop = film["crop_of"]
    part = "" if crop is None else f" of {crop[0]} x {crop[1]} from column {crop[2]}, row {crop[3]}"
    bounds = values["bounds"]
    rows = [
        ("scene", values["scene"]),
        ("film", f"{film['width']} x {film['height']} pixels{part}, {film['filter']} filter"),
        ("camera", _camera(camera)),
        ("asks for", f"{settings['spp']} spp, depth {depth}"),
        ("shapes", f"{values['shapes']} ({values['triangles']} triangles, {values['instances']} instances)"),
        ("materials", str(values["materials"])),
        ("textures", str(values["textures"])),
        ("lights", str(values["lights"])),
        ("bounds", "empty" if bounds is None else f"{_point(bounds[0])} to {_point(bounds[1])}"),
        ("memory", f"{values['memory_bytes'] / 2**20:.1f} MiB"),
        ("loaded in", f"{values['load_seconds']:.2f} s"),
        ("approximated", _codes(values["approximated"])),
        ("ignored", _codes(values["ignored"])),
    ]
    if values["variants"]:
        rows.insert(-3, ("variants", ", ".join(values["variants"])))
    return "\n".join(f"{name:12} {text}" for name, text in rows)


def _codes(counts: dict[str, int]) -> str:
    """How many, and what they are about; what is said of each is on standard error."""
    if not counts:
        return "nothing"
    return f"{sum(counts.values())}: " + ", ".join(f"{count} x {code}" for code, count in counts.items())


def _camera(camera: dict[str, Any]) -> str:
    place = f"at {_point(camera['position'])} towards {_point(camera['direction'])}"
    if camera["projection"] == "orthographic":
        return f"{place}, orthographic, {camera['width']:.4g} wide"
    if camera["projection"] == "spherical":
        return f"{place}, all around"
    blades = f" of {camera['blades']} blades" if camera["blades"] else ""
    lens = f", lens radius {camera['aperture_radius']:g}{blades}" if camera["aperture_radius"] else ""
    return f"{place}, {camera['fov_x_deg']:.4g} degrees wide{lens}"


def _point(values: list[float]) -> str:
    return "(" + ", ".join(f"{v:.4g}" if math.isfinite(v) else str(v) for v in values) + ")"
