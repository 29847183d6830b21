"""Meshes that benches make: a bumpy sphere of any number of triangles, as PLY files.

Nothing is random: the same number of triangles is the same file.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import numpy.typing as npt

Positions = npt.NDArray[np.float32]
Triangles = npt.NDArray[np.uint32]

FACE = np.dtype([("corners", "u1"), ("indices", "<u4", 3)])
"""A triangle as a binary PLY file stores it."""


def bumpy_sphere(triangles: int) -> tuple[Positions, Triangles]:
    """A closed surface about the origin, of radius 0.7 to 1.3, in about so many triangles.

    The faces of a cube, n × n squares each, are blown up to a sphere and displaced by seven octaves of sines.
    The surface is the same for all n, so that only the number of triangles changes.
    """
    n = max(1, round((triangles / 12) ** 0.5))
    lattice, quads = _cube_lattice(n)
    positions = np.empty((len(lattice), 3), np.float32)
    # In parts: the octaves' intermediate arrays would take more memory than the mesh.
    for part in np.array_split(np.arange(len(lattice)), max(1, len(lattice) >> 18)):
        at = np.tan((lattice[part] * (2.0 / n) - 1.0) * (np.pi / 4))
        at /= np.linalg.norm(at, axis=1, keepdims=True)
        positions[part] = at * (1.0 + _bumps(2.0 * at))[:, None]
    corners = quads[:, [0, 1, 2, 0, 2, 3]].reshape(-1, 3)
    return positions, corners.astype(np.uint32)


def _cube_lattice(n: int) -> tuple[npt.NDArray[np.int64], npt.NDArray[np.int64]]:
    """The points of {0…n}³ on its surface, each once, and quads of their indices that face outwards."""
    i, j = np.meshgrid(np.arange(n), np.arange(n), indexing="ij")
    ring = [(0, 0), (1, 0), (1, 1), (0, 1)]
    keys = []
    for axis in range(3):
        for side in (0, n):
            corner = np.empty((n * n, 4, 3), np.int64)
            corner[:, :, axis] = side
            for k, (di, dj) in enumerate(ring if side else ring[::-1]):
                corner[:, k, (axis + 1) % 3] = (i + di).ravel()
                corner[:, k, (axis + 2) % 3] = (j + dj).ravel()
            keys.append((corner[..., 0] * (n + 1) + corner[..., 1]) * (n + 1) + corner[..., 2])
    unique, index = np.unique(np.concatenate(keys), return_inverse=True)
    lattice = np.stack([unique // (n + 1) ** 2, unique // (n + 1) % (n + 1), unique % (n + 1)], axis=1)
    return lattice, index.reshape(-1, 4)


def _bumps(p: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
    """Sines of seven octaves."""
    height = np.zeros(len(p))
    frequency, amplitude = 1.7, 0.15
    for octave in range(7):
        x, y, z = (p * frequency + 1.3 * octave).T
        height += amplitude * (np.sin(x) * np.cos(y) + np.sin(y) * np.cos(z) + np.sin(z) * np.cos(x))
        frequency *= 2.13
        amplitude *= 0.48
    return height


def write_ply(path: Path, positions: Positions, triangles: Triangles) -> None:
    """Writes a binary file of positions and triangles."""
    header = (
        "ply\nformat binary_little_endian 1.0\n"
        f"element vertex {len(positions)}\nproperty float x\nproperty float y\nproperty float z\n"
        f"element face {len(triangles)}\nproperty list uchar int vertex_indices\nend_header\n"
    )
    faces = np.empty(len(triangles), FACE)
    faces["corners"] = 3
    faces["indices"] = triangles
    partial = path.with_suffix(".partial")
    with partial.open("wb") as file:
        file.write(header.encode())
        file.write(positions.astype("<f4").tobytes())
        file.write(faces.tobytes())
    partial.replace(path)


def read_ply(path: Path) -> tuple[Positions, Triangles]:
    """Reads what :func:`write_ply` wrote, and nothing else."""
    data = path.read_bytes()
    end = data.index(b"end_header\n") + len(b"end_header\n")
    header = data[:end].decode().splitlines()
    counts = {line.split()[1]: int(line.split()[2]) for line in header if line.startswith("element ")}
    if "property list uchar int vertex_indices" not in header or list(counts) != ["vertex", "face"]:
        raise ValueError(f"{path} was not written by these benches")
    positions = np.frombuffer(data, "<f4", 3 * counts["vertex"], end).reshape(-1, 3)
    faces = np.frombuffer(data, FACE, counts["face"], end + positions.nbytes)
    return positions, faces["indices"].copy()
