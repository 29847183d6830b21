"""A pbrt scene rendered at one wavelength after another, with spectra in place of its RGB colors.

pbrt-v4 renders spectra, and makes them from RGB colors (Jakob & Hanika 2019, "A Low-Dimensional Function
Space for Efficient Spectral Upsampling"). Here colors are multiplied as they are. Where the two differ, and
pictures rendered at single wavelengths agree with pbrt's, colors are the reason, and nothing else is. The
spectra are solved for here once more, apart from ``sr_spectra``.
"""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

import steradian as sr

TABLES = Path(__file__).resolve().parent.parent / "crates/sr_spectra/src/cie.rs"
WAVELENGTHS = 360.0 + 5.0 * np.arange(95)
# x̄, ȳ, z̄ to linear sRGB (IEC 61966-2-1).
RGB_FROM_XYZ = np.array(
    [[3.240479, -1.537150, -0.498535], [-0.969256, 1.875991, 0.041556], [0.055648, -0.204043, 1.057311]]
)

NUMBER = r"([-+.\de]+)"
TOKEN = re.compile(
    r"\b(AreaLightSource|LightSource|Material|MakeNamedMaterial|Shape|Texture)\b"
    rf'|"rgb (\S+)"\s*\[\s*{NUMBER}\s+{NUMBER}\s+{NUMBER}\s*\]'
)


def table(name: str) -> NDArray[np.float64]:
    """A table of the CIE, every 5 nm from 360 nm."""
    found = re.search(rf"const {name}: \[f64; LEN\] = \[(.*?)\];", TABLES.read_text(), re.DOTALL)
    assert found is not None
    return np.array([float(number) for number in re.findall(NUMBER, found[1])])


def responses() -> NDArray[np.float64]:
    """(3, 95): what a reflectance of 1 at each wavelength adds to a color under D65. Rows add up to 1."""
    seen = RGB_FROM_XYZ @ np.stack([table(axis) for axis in "XYZ"]) * table("D65")
    return seen / seen.sum(axis=1, keepdims=True)


RESPONSES = responses()


def smooth_reflectance(rgb: NDArray[np.float64]) -> NDArray[np.float64]:
    """(95,): the spectrum ½ + t / (2 √(1 + t²)), t a parabola of the wavelength, of a color in [0, 1]."""
    if rgb.min() == rgb.max():
        return np.full(95, rgb[0])
    x = (WAVELENGTHS - 595.0) / 235.0
    powers = np.stack([x * x, x, np.ones_like(x)])
    wanted = rgb.clip(1e-4, 1 - 1e-4)
    mean = wanted.mean()
    c = np.array([0.0, 0.0, (mean - 0.5) / np.sqrt(mean * (1 - mean))])
    damping = 1e-4

    def spectrum(c: NDArray[np.float64]) -> NDArray[np.float64]:
        t = c @ powers
        return 0.5 + t / (2 * np.sqrt(1 + t * t))

    for _ in range(200):
        rest = RESPONSES @ spectrum(c) - wanted
        if np.abs(rest).max() < 1e-9:
            break
        slope = (RESPONSES * (0.5 * (1 + (c @ powers) ** 2) ** -1.5)) @ powers.T
        square = slope.T @ slope
        step = np.linalg.solve(square + damping * np.trace(square) * np.eye(3), slope.T @ rest)
        closer = np.abs(RESPONSES @ spectrum(c - step) - wanted).max() < np.abs(rest).max()
        c, damping = (c - step, damping * 0.3) if closer else (c, damping * 4)
    assert np.abs(RESPONSES @ spectrum(c) - wanted).max() < 1e-3, rgb
    return spectrum(c)


def at_wavelength(text: str, wavelength: float) -> str:
    """A scene with the value of each RGB color's spectrum, three times."""
    parts, last, is_light = [], 0, False
    for match in TOKEN.finditer(text):
        parts.append(text[last : match.start()])
        last = match.end()
        if match[1]:
            is_light = "Light" in match[1]
            parts.append(match[0])
            continue
        rgb = np.array([float(match[i]) for i in (3, 4, 5)])
        # Lights and indices may be above 1: pbrt takes a reflectance times twice the largest number.
        scale = 2 * rgb.max() if (is_light or match[2] in ("eta", "k")) and rgb.max() > 0 else 1.0
        value = scale * np.interp(wavelength, WAVELENGTHS, smooth_reflectance(rgb / scale))
        parts.append(f'"rgb {match[2]}" [ {value} {value} {value} ]')
    return "".join([*parts, text[last:]])


def render_by_wavelength(
    scene: Path, scratch: Path, size: tuple[int, int], spp: int, step: float = 20.0
) -> NDArray[np.float64]:
    """(height, width, 3): the picture in linear sRGB, from one at each ``step`` nm."""
    text = re.sub(r"(?m)#.*$", "", scene.read_text())
    picture, total = np.zeros((size[1], size[0], 3)), np.zeros(3)
    for seed, wavelength in enumerate(np.arange(400.0, 720.0, step)):
        file = scratch / "wavelength.pbrt"
        file.write_text(at_wavelength(text, wavelength))
        grey = sr.render(sr.load(file, search_paths=[scene.parent]), spp=spp, size=size, seed=seed).image
        response = np.array([np.interp(wavelength, WAVELENGTHS, row) for row in RESPONSES])
        picture += grey.astype(np.float64) * response
        total += response
    return picture / total
