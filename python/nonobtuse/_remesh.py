"""The one call."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING, Any

from . import _arrays, _attributes, _core, _quality
from ._errors import Cancelled, InvalidInput
from ._results import Certificate, Mesh, Report, Result, Status

if TYPE_CHECKING:
    from collections.abc import Callable
    from typing import Literal

    from numpy.typing import ArrayLike

    from ._attributes import Attributes

_METHODS = ("default", "cvt", "cvt-fs", "cvt-nob")
_SIZINGS = ("uniform", "lfs", "curvature", "given")
_FEATURES = ("auto", "none", "dihedral", "given")
_BOUNDARIES = ("resample", "freeze")


def remesh(
    V: ArrayLike,
    F: ArrayLike,
    /,
    *,
    vertices: int | None = None,
    edge_length: float | str | None = None,
    relative_edge_length: float | None = None,
    method: Literal["default", "cvt", "cvt-fs", "cvt-nob"] = "default",
    sizing: Literal["uniform", "lfs", "curvature", "given"] | None = None,
    target_lengths: ArrayLike | None = None,
    gradation: float = 0.25,
    max_error: float | str | None = None,
    relative_max_error: float | None = None,
    features: Literal["auto", "none", "dihedral", "given"] | None = None,
    feature_angle: float = 40,
    feature_edges: ArrayLike | None = None,
    boundary: Literal["resample", "freeze"] = "resample",
    min_angle: float = 40,
    max_angle: float = 80,
    on_surface: bool = False,
    penalty: float = 0.01,
    normal_weight: float = 5,
    iterations: int = 0,
    history: bool = False,
    seed: int = 0,
    threads: int = 0,
    progress: Callable[[str, float, str], object] | None = None,
    clean: bool = True,
    attributes: Attributes | None = None,
) -> Result:
    """Remeshes the surface (V, F) so that every angle lies in [min_angle, max_angle) degrees.

    V, F: vertices (n, 3) and faces (m, 3) of an orientable manifold; never changed.
    vertices: number of output vertices, exactly; by default as many as the input has.
    edge_length: target edge length in input units instead, or with a per cent sign ("1%") relative
        to the diagonal of the bounding box; relative_edge_length: the same as a fraction (0.01).
    method: "default"; the paper's "cvt", centroidal Voronoi tessellation alone, "cvt-fs", then with
        the feature-sensitive energy, and "cvt-nob", with the short-dual penalty.
    sizing: how the target edge length varies: "uniform"; "lfs", with the root of the local feature
        size; "curvature"; "given", by target_lengths (n,), one for each vertex of V, which without
        vertices or edge_length also say how many there will be. By default "given" if there are
        target_lengths and else "uniform".
    gradation: bound on the growth of the target edge length along the surface, per length.
    max_error: bound on the measured two-sided distance to the input, in input units or like "0.2%"
        of the diagonal of the bounding box (relative_max_error: as a fraction). Vertices are added
        until it holds; `vertices` is then where to start. ``report["max_error"]`` is the distance.
    features: which edges of the input stay edges, besides its boundary: "auto", sharp creases, of
        which smooth surfaces have none; "none"; "dihedral", edges at which the surface turns by
        feature_angle degrees or more; "given", feature_edges (n, 2), pairs of vertices of V,
        alone (with "auto" and "dihedral" in addition). By default "given" if there are
        feature_edges and else "auto".
    boundary: "resample" moves boundary vertices along the boundary curve, "freeze" keeps exactly
        those of the input.
    min_angle, max_angle: bounds to reach, degrees. The promise is [30, 90).
    on_surface: keep vertices on the input, not at the offset that minimises the distance.
    penalty: weight of the short-dual penalty of "cvt-nob".
    normal_weight: weight s of the normal part in the feature-sensitive energy of "cvt-fs" and
        "cvt-nob"; 1 leaves it out.
    iterations: of L-BFGS in every stage of the paper's methods; 0 takes 40.
    history: note energy and bad triangles of iterations in ``report["history"]``.
    seed: of the random start. Same input, options and seed: same bits.
    threads: 0 takes all cores; the result does not depend on it.
    progress: called as progress(stage, fraction, message) in this thread; returning False cancels
        (the status says so), an exception cancels and is raised.
    attributes: colours, texture and labels of (V, F), to be carried over to the result's
        ``attributes``.
    clean: mend the input first (see `clean`); ``report["repairs"]`` says what was done.

    Angles that could not be brought inside the bounds are listed in ``goal`` and ``certificate``.

    Raises InvalidInput for an input or option that cannot be used, its subclass TooFewVertices if
    the topology needs more vertices, and on Ctrl-C Cancelled, a KeyboardInterrupt whose ``result``
    holds the best mesh so far.
    """
    start = time.perf_counter()
    given = Mesh(_arrays.points(V), _arrays.faces(F))
    options = _options(
        vertices=vertices,
        edge_length=edge_length,
        relative_edge_length=relative_edge_length,
        method=method,
        sizing=sizing or ("uniform" if target_lengths is None else "given"),
        target_lengths=target_lengths,
        gradation=gradation,
        max_error=max_error,
        relative_max_error=relative_max_error,
        features=features or ("auto" if feature_edges is None else "given"),
        feature_angle=feature_angle,
        feature_edges=feature_edges,
        boundary=boundary,
        min_angle=min_angle,
        max_angle=max_angle,
        on_surface=on_surface,
        penalty=penalty,
        normal_weight=normal_weight,
        iterations=iterations,
        history=history,
        seed=seed,
    )
    if progress is not None and not callable(progress):
        raise TypeError(f"progress must be callable, not {progress!r}.")
    count = _arrays.whole_number(threads, "threads")
    outcome = _core.remesh(
        *given, **options, threads=count, progress=progress, clean=bool(clean),
        attributes=_attributes.to_core(attributes),
    )
    result = _result(outcome, given, options, start)
    error = outcome["error"]
    if isinstance(error, KeyboardInterrupt):
        raise Cancelled(result) from error
    if error is not None:
        raise error
    return result


def _options(
    *,
    vertices: int | None,
    edge_length: float | str | None,
    relative_edge_length: float | None,
    method: str,
    sizing: str,
    **others: Any,
) -> dict[str, Any]:
    if vertices is not None and _arrays.whole_number(vertices, "vertices") == 0:
        raise InvalidInput("vertices must be at least 1, not 0.")
    lengths = {
        **_length("edge_length", edge_length, relative_edge_length),
        **_length("max_error", others["max_error"], others["relative_max_error"]),
    }
    if method not in _METHODS:
        raise InvalidInput(f"method must be one of {', '.join(_METHODS)}, not {method!r}.")
    if sizing not in _SIZINGS:
        raise InvalidInput(f"sizing must be one of {', '.join(_SIZINGS)}, not {sizing!r}.")
    for name, choices in (("features", _FEATURES), ("boundary", _BOUNDARIES)):
        if others[name] not in choices:
            raise InvalidInput(f"{name} must be one of {', '.join(choices)}, not {others[name]!r}.")
    return {
        "vertices": 0 if vertices is None else _arrays.whole_number(vertices, "vertices"),
        **lengths,
        "method": method,
        "sizing": sizing,
        "target_lengths": _arrays.lengths(others["target_lengths"], "target_lengths"),
        "gradation": _arrays.number(others["gradation"], "gradation"),
        "features": others["features"],
        "feature_angle": _arrays.number(others["feature_angle"], "feature_angle"),
        "feature_edges": _arrays.edges(others["feature_edges"], "feature_edges"),
        "boundary": others["boundary"],
        "min_angle": _arrays.number(others["min_angle"], "min_angle"),
        "max_angle": _arrays.number(others["max_angle"], "max_angle"),
        "on_surface": bool(others["on_surface"]),
        "penalty": _arrays.number(others["penalty"], "penalty"),
        "normal_weight": _arrays.number(others["normal_weight"], "normal_weight"),
        "iterations": _arrays.whole_number(others["iterations"], "iterations"),
        "history": bool(others["history"]),
        "seed": _arrays.whole_number(others["seed"], "seed", 2**64 - 1),
    }


def _length(name: str, value: float | str | None, relative: float | None) -> dict[str, float]:
    """The length as two options: in input units, or as a fraction of the diagonal; 0 = unset."""
    if isinstance(value, str):
        if relative is not None or not value.endswith("%"):
            raise InvalidInput(f"{name} must be a number or like '1%', not {value!r}.")
        try:
            relative = float(value[:-1]) / 100
        except ValueError:
            raise InvalidInput(f"{name} must be like '1%', not {value!r}.") from None
        value = None
    lengths: dict[str, float] = {name: 0, "relative_" + name: 0}
    for key, length in ((name, value), ("relative_" + name, relative)):
        if length is not None:
            lengths[key] = _arrays.number(length, key)
            if not 0 < lengths[key] < float("inf"):
                raise InvalidInput(f"{key} must be a positive number, not {length!r}.")
    return lengths


def _result(outcome: dict[str, Any], given: Mesh, options: dict[str, Any], start: float) -> Result:
    result = Result()
    for name in ("vertices", "faces", "source_triangle", "barycentric", "feature_edges"):
        setattr(result, name, outcome[name])
    result.attributes = _attributes.from_core(outcome["attributes"])
    result.status = Status(outcome["status"])
    result.certificate = Certificate(*outcome["certificate"])
    result.goal = Certificate(*outcome["goal"])
    result.source = given if outcome["repaired"] is None else Mesh(*outcome["repaired"])
    result.report = Report(
        version=_core.version,
        status=result.status.value,
        options={
            name: v
            for name, v in options.items()
            if name not in ("target_lengths", "feature_edges", "history")
        },
        repairs=outcome["repairs"],
        before=outcome["before"],
        before_vertices=len(result.source.vertices),
        after=outcome["after"],
        after_vertices=len(result.vertices),
        goal=_quality.certificate_report(result.goal, result.mesh),
        promise=_quality.certificate_report(result.certificate, result.mesh),
        seconds=time.perf_counter() - start,
        stages=outcome["stages"],
        size_ratio=outcome["size_ratio"],
        narrow_corners=outcome["narrow_corners"],
        parts_without_features=outcome["parts_without_features"],
    )
    if outcome["max_error"] > 0:
        result.report["max_error"] = outcome["max_error"]
    if options["history"]:
        result.report["history"] = outcome["history"]
    result.report._outcome = (
        result.source, result.mesh, result.goal, result.certificate, result.feature_edges,
    )  # fmt: skip
    return result
