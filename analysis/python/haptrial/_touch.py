"""Objects that are touched step by step, as they are felt in sessions."""
from __future__ import annotations

import dataclasses
from typing import Sequence

import numpy as np
import numpy.typing as npt

from . import _haptrial

_STATES = np.array(["free", "stick", "slip"])


@dataclasses.dataclass(frozen=True)
class Contact:
    """What a tool felt on n ticks, in the object's frame; of step() each without the first axis."""
    force: np.ndarray    #: (n x 3) on the tool [N]
    proxy: np.ndarray    #: (n x 3) where the tool would be if nothing gave way; it, if free [m]
    normal: np.ndarray   #: (n x 3) out of the surface; zero if free
    depth: np.ndarray    #: (n) of the tool behind the surface [m]
    state: np.ndarray    #: (n) "free", "stick" or "slip"; without friction never "stick"


class _Touched:
    def __init__(self, touched):
        self._touched = touched

    def start(self, tool: npt.ArrayLike) -> None:
        """Puts the tool to a point (3) [m] without contact, and a body to rest."""
        self._touched.start(np.atleast_2d(tool))

    def step(self, tool: npt.ArrayLike, period: float = 0.001) -> Contact:
        """One tick with the tool at a point (3) [m], `period` [s] after the one before."""
        ticks = self.follow(np.atleast_2d(tool), period)
        return Contact(*(getattr(ticks, field.name)[0] for field in dataclasses.fields(ticks)))

    def follow(self, tools: npt.ArrayLike, period: float = 0.001) -> Contact:
        """Ticks along a way (n x 3) [m], `period` [s] apart. Other Python threads run meanwhile.
        A tool that is not finite feels nothing."""
        felt = self._touched.follow(tools, period)
        return Contact(**{**felt, "state": _STATES[felt["state"]]})


class TouchedMesh(_Touched):
    """A rigid mesh that a tool touches, rendered as in sessions (docs/algorithms/contact.md).

        block = haptrial.TouchedMesh(vertices, triangles, stiffness=800.0, static_friction=0.4)
        block.start([0.0, 0.0, 0.05])
        block.step([0.0, 0.0, -0.001]).force

    vertices, triangles   (n x 3) [m] and (m x 3), corners anticlockwise seen from outside
    renderer              "proxy", "ruspini", "penalty", "voxel" or "distance field"
    stiffness, damping    [N/m], [N s/m]
    radius                of the tool; 0 is a point [m]
    static_friction, dynamic_friction   of proxies, static >= dynamic; only the first given: both
    crease_angle          normals are interpolated over edges less sharp than this [rad]; None: not
    resolution            of "voxel" and "distance field": cells along the longest side"""

    def __init__(self, vertices: npt.ArrayLike, triangles: npt.ArrayLike, *,
                 renderer: str = "proxy", stiffness: float = 500.0, damping: float = 0.0,
                 radius: float = 0.0, static_friction: float = 0.0,
                 dynamic_friction: float | None = None, crease_angle: float | None = None,
                 resolution: int = 64):
        super().__init__(_haptrial.touched_mesh(
            vertices, triangles, renderer, stiffness, damping, radius, static_friction,
            static_friction if dynamic_friction is None else dynamic_friction,
            -1.0 if crease_angle is None else crease_angle, resolution))


class SoftBody(_Touched):
    """An elastic body that a ball touches, at rest on every tick
    (docs/algorithms/deformable-touch.md). To make it takes seconds.

        pad = haptrial.SoftBody(size=[0.06, 0.02, 0.06], cells=16, young=20e3, poisson=0.45)
        pad.step([0.0, 0.013, 0.0]).force

    size                  sides of a block about the origin (3) [m]; or
    vertices, triangles   a closed surface, which is filled with voxels
    cells                 along the longest side
    young, poisson        [Pa], 0 to 0.499
    fixed, felt           sides "left", "right" (along x), "bottom", "top" (y), "back", "front" (z)
                          that do not move, and that can be touched (none given: all outer faces)
    radius, stiffness     of the ball [m] and of the spring between tool and ball [N/m]
    static_friction, dynamic_friction   as of TouchedMesh"""

    def __init__(self, *, size: npt.ArrayLike | None = None, vertices: npt.ArrayLike | None = None,
                 triangles: npt.ArrayLike | None = None, cells: int = 16, young: float,
                 poisson: float, fixed: Sequence[str] = ("bottom",), felt: Sequence[str] = (),
                 radius: float = 0.005, stiffness: float = 5000.0, static_friction: float = 0.0,
                 dynamic_friction: float | None = None):
        mesh = vertices is not None and triangles is not None
        if mesh == (size is not None):
            raise ValueError("a body has either a size or vertices and triangles; give one of them")
        shape = (vertices, triangles) if mesh else (np.atleast_2d(size),)
        make = _haptrial.soft_solid if mesh else _haptrial.soft_block
        super().__init__(make(
            *shape, cells, list(fixed), list(felt), young, poisson, radius, stiffness,
            static_friction, static_friction if dynamic_friction is None else dynamic_friction))

    @property
    def vertices(self) -> np.ndarray:
        """Where the vertices that can be touched are after the last tick (n x 3) [m]."""
        return self._touched.vertices()

    @property
    def triangles(self) -> np.ndarray:
        """The faces that can be touched: (m x 3) numbers of `vertices`, seen from outside
        anticlockwise."""
        return self._touched.triangles()
