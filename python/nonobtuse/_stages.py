"""Steps of the pipeline on their own, for research.

They take a surface that is manifold along edges and consistently oriented (see `clean`) and sites:
points on or near it, (k, 3). All combinatorics are exact in the doubles given; sites at equal
distance are told apart by index.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from . import _arrays, _core
from ._errors import InvalidInput

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import ArrayLike, NDArray


class RestrictedVoronoi(NamedTuple):
    """The Voronoi diagram of the sites, cut with the surface into convex polygons, the pieces.

    The corners of piece p are ``corners[start[p]:start[p + 1]]``, counter-clockwise; the side that
    leaves each corner is in ``side``: the site across it (>= 0), or -1-k for edge k of the face,
    the one opposite its corner k. Pieces are in order of faces, then of sites.
    """

    face: NDArray[np.int32]  #: (p,): the face each piece lies in
    site: NDArray[np.int32]  #: (p,): the site whose cell it belongs to
    start: NDArray[np.int32]  #: (p + 1,)
    corners: NDArray[np.float64]  #: (c, 3)
    side: NDArray[np.int32]  #: (c,)
    dual_edges: NDArray[np.int32]  #: (e, 2): pairs of sites whose plain cells touch, sorted
    dual_lengths: NDArray[np.float64]  #: (e,): length of the curve where they touch


class CvtEnergy(NamedTuple):
    """The CVT energy F = sum of the integrals of |x - x_i|^2 over the cells, and what it needs."""

    energy: float
    gradient: NDArray[np.float64]  #: (k, 3): 2 mass (site - centroid)
    mass: NDArray[np.float64]  #: (k,): area of each cell
    centroid: NDArray[np.float64]  #: (k, 3); the site itself where its cell is empty


def restricted_voronoi(
    vertices: ArrayLike,
    faces: ArrayLike,
    sites: ArrayLike,
    *,
    localized: bool = False,
    threads: int = 0,
) -> RestrictedVoronoi:
    """The exact restricted Voronoi diagram. O(pieces) memory.

    localized: give every part of a cell that does not hold its site to a neighbour, so that cells
    are connected where sheets of the surface are close (Yan et al. 2014); pieces stay the same.
    """
    return RestrictedVoronoi(
        *_core.restricted_voronoi(
            _arrays.points(vertices),
            _arrays.faces(faces),
            _arrays.points(sites, "sites"),
            bool(localized),
            _arrays.whole_number(threads, "threads"),
        )
    )


def restricted_delaunay(
    vertices: ArrayLike,
    faces: ArrayLike,
    sites: ArrayLike,
    *,
    localized: bool = False,
    threads: int = 0,
) -> NDArray[np.int32]:
    """The dual: a triangle (t, 3) of sites for every point where three cells meet.

    Oriented like the surface. Need not be a manifold, and a triangle may occur twice, unless every
    cell is a disc and every two of them meet in one curve.
    """
    return _core.restricted_delaunay(
        _arrays.points(vertices),
        _arrays.faces(faces),
        _arrays.points(sites, "sites"),
        bool(localized),
        _arrays.whole_number(threads, "threads"),
    )


def cvt_energy(
    vertices: ArrayLike, faces: ArrayLike, sites: ArrayLike, *, threads: int = 0
) -> CvtEnergy:
    """The energy of Eq. 1 of Yan and Wonka 2016, uniform density, with its exact gradient.

    Moving every site to its centroid is one step of Lloyd's method and lowers the energy.
    """
    return CvtEnergy(
        *_core.cvt_energy(
            _arrays.points(vertices),
            _arrays.faces(faces),
            _arrays.points(sites, "sites"),
            _arrays.whole_number(threads, "threads"),
        )
    )


def local_feature_size(
    vertices: ArrayLike, faces: ArrayLike, *, samples: int = 10_000, threads: int = 0
) -> NDArray[np.float64]:
    """(n,): the distance of every vertex to the medial axis (Amenta and Bern 1999), input units.

    The mesh must be fine where the shape is; ``sizing="lfs"`` makes edges as long as the root of
    it. Infinite where there is no medial axis, as on a plane. The axis is found by shrinking balls
    (Ma et al. 2012) from about ``samples`` points spread evenly over the surface: sharp edges have
    none of their own, and what is finer than the samples is not seen. Time grows with samples^2 on
    a round sphere, where all are equally near to the axis, and hardly more than linearly elsewhere.
    """
    count = _arrays.whole_number(samples, "samples", 10_000_000)
    if count < 100:
        raise InvalidInput(f"samples must be at least 100, not {count}.")
    return _core.local_feature_size(
        _arrays.points(vertices),
        _arrays.faces(faces),
        count,
        _arrays.whole_number(threads, "threads"),
    )


def detect_features(
    vertices: ArrayLike, faces: ArrayLike, *, angle: float | None = None
) -> NDArray[np.int32]:
    """(e, 2): the feature edges of a surface, boundaries among them, as pairs of vertices, the lower
    first, sorted; what `remesh` keeps as edges (but for creases too short for its edge length).

    angle: edges at which the normal turns by that many degrees or more; without, creases are told
    from the rest by dihedral angle with hysteresis, and a smooth surface, coarse or noisy, has none.
    The mesh must be clean (see `clean`).
    """
    if angle is not None:
        angle = _arrays.number(angle, "angle")
        if not 0 < angle <= 180:
            raise InvalidInput(f"angle must be above 0 and at most 180 degrees, not {angle}.")
    return _core.detect_features(_arrays.points(vertices), _arrays.faces(faces), angle)
