"""Measuring and certifying."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from . import _arrays, _core
from ._results import Certificate, Report

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from ._results import Mesh

_NAMED = 5  # triangles of each kind that a report names


def measure(
    vertices: ArrayLike,
    faces: ArrayLike,
    *,
    against: tuple[ArrayLike, ArrayLike] | None = None,
    threads: int = 0,
) -> Report:
    """Angles, shape, topology and self-intersections; with ``against`` also the distance.

    ``against``: the vertices and faces of another mesh; adds the two-sided ``distance`` to it and
    the number of ``flipped`` triangles. Keys and units: docs/json.md, `measure --json`.
    """
    mesh = (_arrays.points(vertices), _arrays.faces(faces))
    if against is None:
        reference = (np.empty((0, 3)), np.empty((0, 3), np.int32))
    else:
        reference = (_arrays.points(against[0]), _arrays.faces(against[1]))
    count = _arrays.whole_number(threads, "threads")
    return Report(_core.measure(*mesh, *reference, against is not None, count))


def certify(
    vertices: ArrayLike, faces: ArrayLike, *, min_angle: float = 30, max_angle: float = 90
) -> Certificate:
    """Decides in exact arithmetic whether every angle is in [min_angle, max_angle) degrees."""
    return Certificate(
        *_core.certify(
            _arrays.points(vertices),
            _arrays.faces(faces),
            _arrays.number(min_angle, "min_angle"),
            _arrays.number(max_angle, "max_angle"),
        )
    )


def vertex_distances(
    vertices: ArrayLike, faces: ArrayLike, *, against: tuple[ArrayLike, ArrayLike], threads: int = 0
) -> NDArray[np.float64]:
    """(n,): the distance of every vertex to the surface of another mesh, input units; exact.

    against: the vertices and faces of that mesh.
    """
    return _core.vertex_distances(
        _arrays.points(vertices),
        _arrays.faces(faces),
        _arrays.points(against[0]),
        _arrays.faces(against[1]),
        _arrays.whole_number(threads, "threads"),
    )


def certificate_report(certificate: Certificate, mesh: Mesh, named: int = _NAMED) -> dict[str, Any]:
    """The object "certificate" of docs/json.md."""
    report: dict[str, Any] = {
        "min_angle": certificate.min_angle,
        "max_angle": certificate.max_angle,
        "certified": certificate.certified,
        "triangles": certificate.triangles,
    }
    for name in ("too_large", "too_small"):
        triangles = getattr(certificate, name)
        angles = angles_of(mesh.vertices, mesh.faces[triangles[:named]])
        report[name] = len(triangles)
        report["worst_" + name] = [
            {"triangle": int(t), "smallest_angle": float(a[0]), "largest_angle": float(a[2])}
            for t, a in zip(triangles[:named], angles, strict=True)
        ]
    return report


def angles_of(vertices: NDArray[np.float64], faces: NDArray[np.int32]) -> NDArray[np.float64]:
    """(m, 3): the angles of every triangle, degrees, ascending."""
    corners = vertices[faces]
    u = np.roll(corners, -1, axis=1) - corners
    v = np.roll(corners, -2, axis=1) - corners
    areas = np.linalg.norm(np.cross(u, v), axis=2)
    angles: NDArray[np.float64] = np.sort(np.degrees(np.arctan2(areas, (u * v).sum(axis=2))))
    return angles
