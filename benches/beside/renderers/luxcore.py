"""LuxCore: its path tracer on the processor, with random samples.

Paths have as many vertices, roulette starts as late, nothing is clamped. LuxCore samples one light a vertex
and weighs it against the BSDF by the power heuristic.
"""

from __future__ import annotations

import tempfile
import time
from array import array
from pathlib import Path

import pyluxcore

from beside import meshes, plain
from beside.renderers import Job, Timed

NEVER = 1 << 20
POLL_SECONDS = 0.002


class LuxCore:
    """A scene, and a session for each render; compiling and building the tree are not counted."""

    version = str(pyluxcore.Version())

    def __init__(self, job: Job) -> None:
        pyluxcore.Init(lambda _message: None)
        self.job = job
        self.folder = tempfile.TemporaryDirectory()
        self.scene = pyluxcore.Scene()
        self.scene.Parse(properties(scene_properties(plain.read(job.scene), Path(self.folder.name))))
        self.session: pyluxcore.RenderSession | None = None

    def render(self, seed: int) -> Timed:
        """Renders once more."""
        config = pyluxcore.RenderConfig(properties(render_properties(self.job, seed)), self.scene)
        self.session = session = pyluxcore.RenderSession(config)
        # Start compiles the scene and builds the tree before it returns.
        session.Start()
        wall, cpu = time.perf_counter(), time.process_time()
        while not session.HasDone():
            time.sleep(POLL_SECONDS)
            session.UpdateStats()
        timed = Timed(time.perf_counter() - wall, time.process_time() - cpu)
        session.Stop()
        return timed

    def mean(self) -> list[float]:
        """The last image's mean in linear RGB."""
        assert self.session is not None
        pixels = array("f", [0.0]) * (self.job.width * self.job.height * 3)
        self.session.GetFilm().GetOutputFloat(pyluxcore.FilmOutputType.RGB_IMAGEPIPELINE, pixels, 0)
        return [sum(pixels[channel::3]) / (len(pixels) // 3) for channel in range(3)]


Value = str | float | list[float]


def scene_properties(scene: plain.PlainScene, folder: Path) -> dict[str, Value]:
    """The scene in LuxCore's words; meshes go to files in ``folder``."""
    camera = scene.camera
    out: dict[str, Value] = {
        "scene.camera.type": "perspective",
        "scene.camera.lookat.orig": list(camera.origin),
        "scene.camera.lookat.target": list(camera.target),
        "scene.camera.up": list(camera.up),
        "scene.camera.fieldofview": camera.fov,
    }
    for mesh in scene.meshes:
        file = folder / f"{mesh.name}.ply"
        meshes.write_ply(file, mesh.positions, mesh.triangles)
        material = f"scene.materials.{mesh.name}"
        out |= {f"{material}.type": "matte", f"{material}.kd": list(mesh.reflectance)}
        if mesh.emission is not None:
            out[f"{material}.emission"] = list(mesh.emission)
        out[f"scene.objects.{mesh.name}.ply"] = str(file)
        out[f"scene.objects.{mesh.name}.material"] = mesh.name
    return out


def render_properties(job: Job, seed: int) -> dict[str, Value]:
    """How to render."""
    return {
        "renderengine.type": "PATHCPU",
        "renderengine.seed": float(seed + 1),
        "native.threads.count": float(job.threads),
        "sampler.type": "RANDOM",
        "sampler.random.adaptive.strength": 0.0,
        "path.pathdepth.total": float(job.depth),
        "path.pathdepth.diffuse": float(job.depth),
        "path.pathdepth.glossy": float(job.depth),
        "path.pathdepth.specular": float(job.depth),
        "path.russianroulette.depth": float(NEVER if job.roulette is None else job.roulette),
        "path.clamping.variance.maxvalue": 0.0,
        "path.hybridbackward.enable": 0.0,
        "batch.haltspp": float(job.spp),
        "film.width": float(job.width),
        "film.height": float(job.height),
        "film.filter.type": "NONE",
        "film.noiseestimation.warmup": float(NEVER),
        "film.imagepipelines.0.0.type": "NOP",
    }


def properties(values: dict[str, Value]) -> pyluxcore.Properties:
    """As LuxCore takes them; whole numbers are written as such."""
    out = pyluxcore.Properties()
    for name, value in values.items():
        if isinstance(value, float) and value.is_integer():
            value = int(value)
        out.Set(pyluxcore.Property(name, value))
    return out
