# The extension module, python/src: arrays must be contiguous, nothing has a default.
from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

_Points = NDArray[np.float64]
_Indices = NDArray[np.int32]
_Mesh = tuple[_Points, _Indices, list[dict[str, Any]]]

version: str

def read(path: bytes, /) -> tuple[_Mesh, tuple[Any, ...]]: ...
def write(
    path: bytes, vertices: _Points, faces: _Indices, attributes: tuple[Any, ...], binary: bool, /
) -> None: ...
def write_file(path: bytes, content: bytes, /) -> None: ...
def attribute_borders(
    vertices: _Points, faces: _Indices, attributes: tuple[Any, ...], /
) -> _Indices: ...
def clean(vertices: _Points, faces: _Indices, /) -> _Mesh: ...
def sample(resolution: int, /) -> _Mesh: ...
def measure(
    vertices: _Points,
    faces: _Indices,
    reference_vertices: _Points,
    reference_faces: _Indices,
    with_reference: bool,
    threads: int,
    /,
) -> dict[str, Any]: ...
def vertex_distances(
    vertices: _Points,
    faces: _Indices,
    reference_vertices: _Points,
    reference_faces: _Indices,
    threads: int,
    /,
) -> _Points: ...
def topology(vertices: _Points, faces: _Indices, /) -> dict[str, Any]: ...
def certify(
    vertices: _Points, faces: _Indices, min_angle: float, max_angle: float, /
) -> tuple[float, float, bool, int, _Indices, _Indices]: ...
def remesh(
    vertices_given: _Points,
    faces_given: _Indices,
    /,
    *,
    vertices: int,
    edge_length: float,
    relative_edge_length: float,
    method: str,
    sizing: str,
    target_lengths: NDArray[np.float64],
    gradation: float,
    max_error: float,
    relative_max_error: float,
    features: str,
    feature_angle: float,
    feature_edges: _Indices,
    boundary: str,
    min_angle: float,
    max_angle: float,
    on_surface: bool,
    penalty: float,
    normal_weight: float,
    iterations: int,
    history: bool,
    seed: int,
    threads: int,
    progress: Callable[[str, float, str], object] | None,
    clean: bool,
    attributes: tuple[Any, ...],
    keep_seams: bool,
) -> dict[str, Any]: ...
def restricted_voronoi(
    vertices: _Points, faces: _Indices, sites: _Points, localized: bool, threads: int, /
) -> tuple[_Indices, _Indices, _Indices, _Points, _Indices, _Indices, _Points]: ...
def restricted_delaunay(
    vertices: _Points, faces: _Indices, sites: _Points, localized: bool, threads: int, /
) -> _Indices: ...
def cvt_energy(
    vertices: _Points, faces: _Indices, sites: _Points, threads: int, /
) -> tuple[float, _Points, _Points, _Points]: ...
def local_feature_size(
    vertices: _Points, faces: _Indices, samples: int, threads: int, /
) -> _Points: ...
def detect_features(
    vertices: _Points, faces: _Indices, angle: float | None, /
) -> _Indices: ...
