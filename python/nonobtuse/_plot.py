"""Pictures of meshes as Yan and Wonka 2016 draw them. Needs pyvista: ``pip install nonobtuse[plot]``."""

from __future__ import annotations

import importlib
import os
from typing import TYPE_CHECKING, Any

import numpy as np

from . import _arrays
from ._errors import InvalidInput
from ._quality import angles_of
from ._results import Mesh, Result
from ._stages import restricted_voronoi

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import ArrayLike, NDArray

_OBTUSE, _SMALL, _BOTH, _GOOD = (226, 74, 141), (58, 120, 220), (122, 60, 170), (240, 235, 220)
#: of valence 4 and fewer, 5, 6, 7, 8 and more
_VALENCE = [(33, 60, 150), (120, 170, 230), _GOOD, (240, 160, 110), (180, 30, 40)]
_DIVERGING = np.array(
    [(40, 70, 160), (100, 150, 215), (190, 215, 235), (242, 238, 228), (245, 205, 165),
     (225, 130, 90), (165, 35, 45)], float,
)  # fmt: skip
_LINES = (40, 40, 50)
_CREASE = (200, 30, 30)

COLORS = ("angles", "valence", "sizing", "cells", "plain")


def plot(
    *meshes: Mesh | Result | tuple[ArrayLike, ArrayLike],
    color: str | ArrayLike = "angles",
    path: str | os.PathLike[str] | None = None,
    features: ArrayLike | None = None,
    edges: bool = True,
    size: tuple[int, int] = (800, 800),
    view: Sequence[float] = (0.45, 0.35, 1.0),
    up: Sequence[float] = (0.0, 1.0, 0.0),
    zoom: float = 1.0,
) -> None:
    """Draws meshes side by side, seen from the same place, in a window or into a PNG.

    meshes: each a `Mesh`, a `Result` or a pair (vertices, faces).
    color: "angles": triangles with an angle of 90 degrees or more pink, those with one below 30
        blue, with both purple; "valence": vertices of valence 5 light blue, 7 orange, fewer dark
        blue, more red; "sizing": edges shorter than the median blue, longer red; "cells": the
        Voronoi cells of the vertices, on the source of a `Result`, else on the mesh itself, coloured
        by how many neighbours they have; "plain"; or an array with a number for every vertex or
        face of the one mesh given.
    path: of the PNG; without, a window is opened and the call lasts until it is closed.
    features: (e, 2) pairs of vertices, drawn as red lines on the one mesh given; those of a `Result`
        are drawn anyway.
    size: pixels of each picture. view: direction from which the mesh is seen. up: what is up.
    """
    pyvista: Any = importlib.import_module("pyvista")
    if not meshes:
        raise InvalidInput("There must be at least one mesh to draw.")
    if isinstance(color, str) and color not in COLORS:
        raise InvalidInput(f"color must be one of {', '.join(COLORS)}, or numbers, not {color!r}.")
    if len(meshes) > 1 and (features is not None or not isinstance(color, str)):
        raise InvalidInput("Numbers and features belong to one mesh: draw it alone.")
    plotter = pyvista.Plotter(
        shape=(1, len(meshes)),
        off_screen=path is not None,
        window_size=[size[0] * len(meshes), size[1]],
        border=False,
    )
    plotter.set_background("white")
    for k, given in enumerate(meshes):
        plotter.subplot(0, k)
        mesh = _mesh_of(given)
        # Lines lie a little nearer to the eye than the surface, which would swallow half of them.
        toward = np.asarray(view, float) / np.linalg.norm(view)
        lift = 1.5e-3 * float(np.linalg.norm(np.ptp(mesh.vertices, axis=0))) * toward
        _draw(plotter, pyvista, given, color, features, edges, lift)
        middle = (mesh.vertices.min(axis=0) + mesh.vertices.max(axis=0)) / 2
        plotter.camera.up = up
        plotter.camera.focal_point = middle
        plotter.camera.position = middle + np.asarray(view, float)
        plotter.camera.view_angle = 30
        plotter.reset_camera()
        plotter.camera.zoom(1.25 * zoom)
        plotter.enable_anti_aliasing("ssaa")
    if path is None:
        plotter.show()
    else:
        plotter.screenshot(os.fspath(path), return_img=False)
        plotter.close()


def _mesh_of(given: Mesh | Result | tuple[ArrayLike, ArrayLike]) -> Mesh:
    if isinstance(given, Result):
        return given.mesh
    vertices, faces = given
    return Mesh(_arrays.points(vertices), _arrays.faces(faces))


def _draw(
    plotter: Any,
    pyvista: Any,
    given: Mesh | Result | tuple[ArrayLike, ArrayLike],
    color: str | ArrayLike,
    features: ArrayLike | None,
    edges: bool,
    lift: NDArray[np.float64],
) -> None:
    mesh = _mesh_of(given)
    lines = _edges(mesh.faces) if edges else np.empty((0, 2), np.int32)
    points = mesh.vertices
    light = {"ambient": 0.3, "diffuse": 0.75, "specular": 0.0, "smooth_shading": False}
    if not isinstance(color, str):
        values = np.asarray(color, float)
        surface = pyvista.PolyData.from_regular_faces(*mesh)
        plotter.add_mesh(surface, scalars=values, cmap="viridis", **light)
    else:
        if color == "cells":
            on = given.source if isinstance(given, Result) else mesh
            points, polygons, colors, lines = _cells(on, mesh, edges)
            surface = pyvista.PolyData(points, faces=polygons)
        elif color == "valence":
            corners, quads, colors = _valence_patches(mesh)
            surface = pyvista.PolyData.from_regular_faces(corners, quads)
        else:
            surface = pyvista.PolyData.from_regular_faces(*mesh)
            colors = _face_colors(mesh, color)
        surface.cell_data["rgb"] = colors
        plotter.add_mesh(surface, scalars="rgb", rgb=True, **light)
    if len(lines):
        _add_lines(plotter, pyvista, points + lift, lines, _LINES, 1.0)
    if features is None and isinstance(given, Result):
        features = given.feature_edges
    if features is not None:
        pairs = np.asarray(features, np.int64).reshape(-1, 2)
        if len(pairs):
            _add_lines(plotter, pyvista, mesh.vertices + 2 * lift, pairs, _CREASE, 4.0)


def _add_lines(
    plotter: Any, pyvista: Any, points: NDArray[Any], pairs: NDArray[Any], color: Any, width: float
) -> None:
    cells = np.column_stack([np.full(len(pairs), 2), pairs]).ravel()
    plotter.add_mesh(
        pyvista.PolyData(points, lines=cells), color=color, line_width=width, lighting=False
    )


def _edges(faces: NDArray[np.int32]) -> NDArray[np.int32]:
    """(e, 2): every edge once, the smaller index first."""
    sides = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
    return np.unique(np.sort(sides, axis=1), axis=0)


def _face_colors(mesh: Mesh, color: str) -> NDArray[np.uint8]:
    colors = np.tile(np.array(_GOOD, np.uint8), (len(mesh.faces), 1))
    if color == "angles":
        angles = angles_of(mesh.vertices, mesh.faces)
        obtuse, small = angles[:, 2] >= 90, angles[:, 0] < 30
        colors[obtuse] = _OBTUSE
        colors[small] = _SMALL
        colors[obtuse & small] = _BOTH
    elif color == "sizing":
        corners = mesh.vertices[mesh.faces]
        sides = np.linalg.norm(np.roll(corners, -1, axis=1) - corners, axis=2).mean(axis=1)
        octaves = np.log2(np.maximum(sides, 1e-300) / np.median(sides))
        at = np.clip((octaves + 2) / 4, 0, 1) * (len(_DIVERGING) - 1)
        for c in range(3):
            colors[:, c] = np.interp(at, np.arange(len(_DIVERGING)), _DIVERGING[:, c])
    return colors


def _valences(mesh: Mesh) -> NDArray[np.int64]:
    """Neighbours of every vertex; two more at boundaries, where 4 are as good as 6 inside."""
    sides = np.concatenate([mesh.faces[:, [0, 1]], mesh.faces[:, [1, 2]], mesh.faces[:, [2, 0]]])
    edges, count = np.unique(np.sort(sides, axis=1), axis=0, return_counts=True)
    valences = np.bincount(edges.ravel(), minlength=len(mesh.vertices))
    valences[np.unique(edges[count == 1])] += 2
    return valences


def _valence_colors(valences: NDArray[np.int64]) -> NDArray[np.uint8]:
    colors: NDArray[np.uint8] = np.array(_VALENCE, np.uint8)[np.clip(valences - 4, 0, 4)]
    return colors


def _valence_patches(mesh: Mesh) -> tuple[NDArray[Any], NDArray[Any], NDArray[np.uint8]]:
    """Around every corner of every triangle the quadrilateral up to the middle of the sides."""
    p = mesh.vertices[mesh.faces]
    middle = (p + np.roll(p, -1, axis=1)) / 2  # of the side that leaves corner k
    center = np.repeat(p.mean(axis=1, keepdims=True), 3, axis=1)
    quads = np.stack([p, middle, center, np.roll(middle, 1, axis=1)], axis=2)
    corners = quads.reshape(-1, 3)
    colors = _valence_colors(_valences(mesh))[mesh.faces.ravel()]
    return corners, np.arange(len(corners)).reshape(-1, 4), colors


def _cells(
    surface: Mesh, sites: Mesh, edges: bool
) -> tuple[NDArray[Any], NDArray[Any], NDArray[np.uint8], NDArray[Any]]:
    """Corners, polygons as VTK wants them, colours, and the sides between two cells."""
    diagram = restricted_voronoi(*surface, sites.vertices, localized=True)
    count = np.diff(diagram.start)
    first = diagram.start[:-1]
    polygons = np.insert(np.arange(len(diagram.corners)), first, count)
    colors = _valence_colors(_valences(sites))[diagram.site]
    piece = np.repeat(np.arange(len(count)), count)
    following = np.arange(len(diagram.corners)) + 1
    following = np.where(following == diagram.start[piece + 1], first[piece], following)
    between = diagram.side >= 0
    pairs = np.column_stack([np.flatnonzero(between), following[between]])
    return diagram.corners, polygons, colors, pairs if edges else pairs[:0]
