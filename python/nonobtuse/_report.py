"""The report of a call as one file: the page that `nonobtuse --report` writes, or its data."""

from __future__ import annotations

import base64
import json
import os
import pathlib
from typing import TYPE_CHECKING, Any

import numpy as np

from . import _core, _quality

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from ._results import Certificate, Mesh

_LISTED = 1000  # triangles of each kind that are named
_DISTANCE_LIMIT = 400_000  # triangles in all, beyond which distances would take too long


def full_report(
    report: dict[str, Any],
    source: Mesh,
    mesh: Mesh,
    goal: Certificate,
    promise: Certificate,
    feature_edges: NDArray[np.int32],
) -> dict[str, Any]:
    """What docs/json.md calls the report: figures, certificate, places and both meshes."""
    full = dict(report)
    full["goal"] = _quality.certificate_report(goal, mesh, _LISTED)
    full["promise"] = _quality.certificate_report(promise, mesh, _LISTED)
    near: dict[str, NDArray[np.float64] | None] = {"before": None, "after": None}
    measurable = len(mesh.faces) > 0 and len(source.faces) + len(mesh.faces) <= _DISTANCE_LIMIT
    if measurable:
        after = _quality.measure(*mesh, against=source)
        full["distance"] = after["distance"]
        full["self_intersections"] = after["self_intersections"]
        near["before"] = _quality.vertex_distances(*source, against=mesh)
        near["after"] = _quality.vertex_distances(*mesh, against=source)
    full["before_topology"] = _core.topology(source.vertices, source.faces)
    full["after_topology"] = _core.topology(mesh.vertices, mesh.faces)
    full["feature_edges"] = feature_edges.tolist()
    lows, highs = source.vertices.min(axis=0), source.vertices.max(axis=0)
    origin = lows / 2 + highs / 2
    full["meshes"] = {
        "before": _packed_mesh(source, origin, near["before"]),
        "after": _packed_mesh(mesh, origin, near["after"]),
    }
    return full


def page(full: dict[str, Any]) -> str:
    """One page that shows a full report and needs no network."""
    template = (pathlib.Path(__file__).parent / "report.html").read_text("ascii")
    # "</script>" in a text must not end the data.
    return template.replace("@REPORT@", json.dumps(full).replace("<", "\\u003c"))


def save(path: str | os.PathLike[str], full: dict[str, Any]) -> None:
    """Writes .html or .json, whole or not at all."""
    name = os.fspath(path)
    suffix = os.path.splitext(name)[1].lower()
    if suffix not in (".html", ".json"):
        raise ValueError(f"The name of a report must end in .html or .json, not {name!r}.")
    text = page(full) if suffix == ".html" else json.dumps(full) + "\n"
    _core.write_file(os.fsencode(name), text.encode("ascii"))


def _packed_mesh(
    mesh: Mesh, origin: NDArray[np.float64], distance: NDArray[np.float64] | None
) -> dict[str, Any]:
    small = len(mesh.vertices) <= 65536
    packed = {
        "origin": origin.tolist(),
        "vertices": _packed(mesh.vertices - origin, "float32"),
        "triangles": _packed(mesh.faces, "uint16" if small else "uint32"),
    }
    if distance is not None:
        packed["distance"] = _packed(distance, "float32")
    return packed


def _packed(array: NDArray[Any], kind: str) -> dict[str, Any]:
    little = np.ascontiguousarray(array, dtype=np.dtype(kind).newbyteorder("<"))
    text = base64.b64encode(little.tobytes()).decode("ascii")
    return {"type": kind, "shape": list(array.shape), "base64": text}


