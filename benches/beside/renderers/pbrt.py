"""pbrt-v4, if the user has it: the program that ``PBRT`` names, or ``pbrt`` on the path.

It is started for each render. What a render of one sample takes (reading, building the tree, writing) is
measured beside it and subtracted. Wavelengths and roulette are pbrt's own; its image is mirrored.
"""

from __future__ import annotations

import array
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from beside import meshes, plain
from beside.renderers import Job, Timed, pbrt_binary


class Pbrt:
    """A scene file, and two processes for each render."""

    version = ""

    def __init__(self, job: Job) -> None:
        self.job = job
        self.folder = tempfile.TemporaryDirectory()
        self.path = Path(self.folder.name)
        (self.path / "scene.pbrt").write_text(scene_text(plain.read(job.scene), job, self.path))

    def render(self, seed: int) -> Timed:
        """Renders once more; all samples but the first are timed, and their time is scaled to all."""
        spp = max(2, self.job.spp)
        one, whole = self._run(seed, 1), self._run(seed, spp)
        return Timed((whole - one) * self.job.spp / (spp - 1), None)

    def _run(self, seed: int, spp: int) -> float:
        command = [str(pbrt_binary()), "--quiet", "--nthreads", str(self.job.threads), "--spp", str(spp)]
        start = time.perf_counter()
        subprocess.run(
            [*command, "--seed", str(seed), "--outfile", "image.pfm", "scene.pbrt"],
            cwd=self.path,
            check=True,
            capture_output=True,
        )
        return time.perf_counter() - start

    def mean(self) -> list[float]:
        """The last image's mean in linear RGB."""
        return pfm_mean((self.path / "image.pfm").read_bytes())


def pfm_mean(data: bytes) -> list[float]:
    """Of a color image in the portable float map format."""
    _, _, scale, rest = data.split(b"\n", 3)
    pixels = array.array("f", rest)
    if (float(scale) < 0) != (sys.byteorder == "little"):
        pixels.byteswap()
    return [sum(pixels[channel::3]) / (len(pixels) // 3) for channel in range(3)]


def scene_text(scene: plain.PlainScene, job: Job, folder: Path) -> str:
    """The scene in pbrt's language; meshes go to files in ``folder``."""
    camera = scene.camera
    look = " ".join(str(x) for vector in (camera.origin, camera.target, camera.up) for x in vector)
    lines = [
        f"LookAt {look}",
        f'Camera "perspective" "float fov" [ {camera.fov} ]',
        'Sampler "independent"',
        'PixelFilter "box"',
        f'Film "rgb" "integer xresolution" [ {job.width} ] "integer yresolution" [ {job.height} ]',
        # pbrt counts bounces between the camera's ray and the last one.
        f'Integrator "path" "integer maxdepth" [ {job.depth - 1} ]',
        "WorldBegin",
    ]
    for mesh in scene.meshes:
        file = folder / f"{mesh.name}.ply"
        meshes.write_ply(file, mesh.positions, mesh.triangles)
        lines += ["AttributeBegin", f'Material "diffuse" "rgb reflectance" [ {_rgb(mesh.reflectance)} ]']
        if mesh.emission is not None:
            lines.append(f'AreaLightSource "diffuse" "rgb L" [ {_rgb(mesh.emission)} ]')
        lines += [f'Shape "plymesh" "string filename" "{file.name}"', "AttributeEnd"]
    return "\n".join(lines) + "\n"


def _rgb(color: plain.Rgb) -> str:
    return " ".join(str(x) for x in color)
