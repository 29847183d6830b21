"""Cycles, as Blender's Python module ships it.

As many bounces, no roulette before the depth that is asked for, nothing is clamped, no adaptive sampling, no
denoiser, no light tree (there is one lamp). Samples are Sobol-Burley points: Cycles has no independent ones.
"""

from __future__ import annotations

import re
import tempfile
from pathlib import Path
from typing import Any

import bpy
import numpy as np
from mathutils import Matrix, Vector

from beside import plain
from beside.renderers import Job, Timed

RENDER_TIME = re.compile(rb"cycles\.[^\0]*render_time\0string\0....([\d:.]+)", re.DOTALL)
"""What Cycles writes into an image about itself; without the time for the tree and the scene."""


class Cycles:
    """A scene in Blender; the time is Cycles' own, in hundredths of a second."""

    version = str(bpy.app.version_string)

    def __init__(self, job: Job) -> None:
        self.job = job
        self.folder = tempfile.TemporaryDirectory()
        self.image = Path(self.folder.name) / "image.exr"
        bpy.ops.wm.read_factory_settings(use_empty=True)
        scene = plain.read(job.scene)
        self._settings()
        self._camera(scene.camera)
        for mesh in scene.meshes:
            self._mesh(mesh)

    def _settings(self) -> None:
        job, scene = self.job, bpy.context.scene
        scene.render.engine = "CYCLES"
        scene.render.resolution_x, scene.render.resolution_y = job.width, job.height
        scene.render.resolution_percentage = 100
        scene.render.threads_mode = "FIXED"
        scene.render.threads = job.threads
        scene.render.use_persistent_data = True
        scene.render.image_settings.file_format = "OPEN_EXR"
        scene.render.image_settings.color_depth = "32"
        scene.render.filepath = str(self.image)
        cycles = scene.cycles
        cycles.device = "CPU"
        cycles.samples = job.spp
        cycles.use_adaptive_sampling = cycles.use_denoising = cycles.use_light_tree = False
        # A path of n edges bounces n - 1 times; its last vertex is on a light.
        bounces = max(0, job.depth - 2)
        for name in ("max", "diffuse", "glossy", "transmission", "volume"):
            setattr(cycles, f"{name}_bounces", bounces)
        cycles.min_light_bounces = bounces if job.roulette is None else max(0, job.roulette - 1)
        cycles.sample_clamp_direct = cycles.sample_clamp_indirect = 0.0
        cycles.light_sampling_threshold = 0.0
        cycles.blur_glossy = 0.0
        cycles.pixel_filter_type = "BOX"

    def _camera(self, camera: plain.Camera) -> None:
        data = bpy.data.cameras.new("camera")
        data.sensor_fit = "HORIZONTAL"
        data.angle = np.radians(camera.fov)
        placed = bpy.data.objects.new("camera", data)
        # A camera looks along -z, with y up.
        back = (Vector(camera.origin) - Vector(camera.target)).normalized()
        right = Vector(camera.up).cross(back).normalized()
        columns = Matrix((right, back.cross(right), back)).transposed()
        placed.matrix_world = Matrix.Translation(camera.origin) @ columns.to_4x4()
        bpy.context.scene.collection.objects.link(placed)
        bpy.context.scene.camera = placed

    def _mesh(self, mesh: plain.PlainMesh) -> None:
        data = bpy.data.meshes.new(mesh.name)
        data.vertices.add(len(mesh.positions))
        data.vertices.foreach_set("co", mesh.positions.ravel())
        data.loops.add(mesh.triangles.size)
        data.loops.foreach_set("vertex_index", mesh.triangles.ravel().astype(np.int32))
        data.polygons.add(len(mesh.triangles))
        data.polygons.foreach_set("loop_start", np.arange(0, mesh.triangles.size, 3, dtype=np.int32))
        data.update(calc_edges=True)
        data.materials.append(_material(mesh))
        bpy.context.scene.collection.objects.link(bpy.data.objects.new(mesh.name, data))

    def render(self, seed: int) -> Timed:
        """Renders once more."""
        bpy.context.scene.cycles.seed = seed
        bpy.ops.render.render(write_still=True)
        found = RENDER_TIME.search(self.image.read_bytes())
        if found is None:
            raise RuntimeError("Cycles did not say how long it took")
        return Timed(seconds(found[1].decode()), None)

    def mean(self) -> list[float]:
        """The last image's mean in linear RGB."""
        image = bpy.data.images.load(str(self.image), check_existing=False)
        pixels = np.empty(len(image.pixels), np.float32)
        image.pixels.foreach_get(pixels)
        bpy.data.images.remove(image)
        return [float(x) for x in pixels.reshape(-1, 4)[:, :3].mean(axis=0, dtype="f8")]


def _material(mesh: plain.PlainMesh) -> Any:
    """Diffuse, and emitting if the mesh does; lights are sampled from the front only."""
    material = bpy.data.materials.new(mesh.name)
    material.use_nodes = True
    nodes, links = material.node_tree.nodes, material.node_tree.links
    nodes.clear()
    output, diffuse = nodes.new("ShaderNodeOutputMaterial"), nodes.new("ShaderNodeBsdfDiffuse")
    diffuse.inputs["Color"].default_value = (*mesh.reflectance, 1.0)
    surface = diffuse.outputs[0]
    if mesh.emission is not None:
        emission, both = nodes.new("ShaderNodeEmission"), nodes.new("ShaderNodeAddShader")
        emission.inputs["Color"].default_value = (*mesh.emission, 1.0)
        links.new(diffuse.outputs[0], both.inputs[0])
        links.new(emission.outputs[0], both.inputs[1])
        surface = both.outputs[0]
        material.cycles.emission_sampling = "FRONT"
    links.new(surface, output.inputs["Surface"])
    return material


def seconds(text: str) -> float:
    """``01:02.50`` or ``1:01:02.50`` in seconds."""
    total = 0.0
    for part in text.split(":"):
        total = 60.0 * total + float(part)
    return total
