"""Meshes, distance maps and tetrahedra as arrays."""
from __future__ import annotations

import dataclasses

import numpy as np
import numpy.typing as npt

from . import _haptrial
from ._session import Path


@dataclasses.dataclass(frozen=True)
class DistanceMap:
    """Distances of voxel centres from a mesh. Voxel [k, j, i] has its centre at
    origin + spacing (i, j, k)."""
    distance: np.ndarray                 #: (z x y x x) [unit of the mesh], negative inside; NaN
                                         #: where not asked for
    inside: np.ndarray                   #: (z x y x x) whether the centre is inside
    origin: tuple[float, float, float]   #: centre of voxel [0, 0, 0], as (x, y, z)
    spacing: float                       #: edge of a voxel


def read_mesh(path: Path) -> tuple[np.ndarray, np.ndarray]:
    """A mesh file (.obj, .ply, .stl, .off): vertices (n x 3) in the file's unit, and triangles
    (m x 3), corners anticlockwise seen from outside."""
    return _haptrial.read_mesh(str(path))


def distance_map(vertices: npt.ArrayLike, triangles: npt.ArrayLike, resolution: int = 64, *,
                 margin: int = 0, everywhere: bool = False) -> DistanceMap:
    """The exact distance map of a mesh.

    vertices, triangles   (n x 3) and (m x 3)
    resolution   voxels along the longest side
    margin       more voxels on every side
    everywhere   outside, too; else inside voxels only"""
    return DistanceMap(**_haptrial.distance_map(vertices, triangles, resolution, margin, everywhere))


def tetrahedra(vertices: npt.ArrayLike, triangles: npt.ArrayLike,
               resolution: int = 16) -> tuple[np.ndarray, np.ndarray]:
    """Fills a mesh with tetrahedra, five in each inside voxel: vertices (n x 3) in the mesh's unit,
    tetrahedra (m x 4). resolution: voxels along the longest side."""
    return _haptrial.tetrahedra(vertices, triangles, resolution)


def nearest(vertices: npt.ArrayLike, triangles: npt.ArrayLike,
            points: npt.ArrayLike) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """The nearest points of a mesh to `points` (n x 3): distances (n), the points (n x 3), and the
    triangles that they lie on (n), all exact. Of a point that is not finite NaN, NaN and -1."""
    return _haptrial.nearest(vertices, triangles, points)
