"""Remeshes triangle surfaces so that no angle is obtuse, with an exact certificate.

>>> import nonobtuse
>>> V, F = nonobtuse.sample(resolution=24)
>>> result = nonobtuse.remesh(V, F, vertices=800)
>>> bool(result.certificate)  # every angle in [30, 90) degrees, proved
True

Meshes are a pair of arrays: ``vertices`` (n, 3) and ``faces`` (m, 3). Every function takes any
array-like of numbers, in any memory order, and never changes it. Nothing here is global: calls may
run in several threads at once, and the GIL is released while they work.
"""

from typing import TYPE_CHECKING, Any

from ._attributes import Attributes, attribute_borders
from ._core import version as __version__
from ._errors import Cancelled, InvalidInput, TooFewVertices
from ._files import clean, read, sample, write
from ._quality import certify, measure, vertex_distances
from ._remesh import remesh
from ._results import Certificate, Mesh, Report, Result, Status
from ._stages import (
    CvtEnergy,
    RestrictedVoronoi,
    cvt_energy,
    detect_features,
    local_feature_size,
    restricted_delaunay,
    restricted_voronoi,
)

if TYPE_CHECKING:
    from ._plot import plot as plot


def __getattr__(name: str) -> Any:
    # Loaded when it is used: pictures are an extra.
    if name == "plot":
        from ._plot import plot

        return plot
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


__all__ = [
    "Attributes",
    "Cancelled",
    "Certificate",
    "CvtEnergy",
    "InvalidInput",
    "Mesh",
    "Report",
    "RestrictedVoronoi",
    "Result",
    "Status",
    "TooFewVertices",
    "__version__",
    "attribute_borders",
    "certify",
    "clean",
    "cvt_energy",
    "detect_features",
    "local_feature_size",
    "measure",
    "plot",
    "read",
    "remesh",
    "restricted_delaunay",
    "restricted_voronoi",
    "sample",
    "vertex_distances",
    "write",
]
