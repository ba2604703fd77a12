"""Measuring and certifying."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from . import _arrays, _core
from ._results import Certificate, Report

if TYPE_CHECKING:
    from numpy.typing import ArrayLike


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
