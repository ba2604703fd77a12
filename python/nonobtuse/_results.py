"""What the functions give back."""

from __future__ import annotations

import enum
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ._errors import InvalidInput

if TYPE_CHECKING:
    import os

    from numpy.typing import NDArray

    from ._attributes import Attributes


class Status(enum.Enum):
    """How a remeshing call ended."""

    CONVERGED = "converged"  #: every angle is inside the bounds asked for, certified exactly
    ANGLES_REMAIN = "angles_remain"  #: valid, but the certificate lists triangles outside
    CANCELLED = "cancelled"  #: stopped on request; the mesh is the best valid one so far


class Report(dict[str, Any]):
    """A dictionary of plain numbers, texts and lists; the keys are those of docs/json.md."""

    def to_json(self, indent: int | None = 2) -> str:
        """The report as JSON text."""
        import json

        return json.dumps(self, indent=indent)

    def to_html(self) -> str:
        """One page to look at, which needs no network: both surfaces side by side, histograms,
        figures, convergence (with ``history=True``), certificate and the places that miss a bound.

        Of the report of `remesh` only; others know no surfaces.
        """
        from . import _report

        return _report.page(self._full())

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes the page of `to_html` (.html) or all that it shows as data (.json: docs/json.md,
        the report), like ``nonobtuse remesh --report``."""
        from . import _report

        _report.save(path, self._full())

    #: (source, mesh, goal, certificate, feature edges) of the call
    _outcome: (
        tuple[Mesh, Mesh, Certificate, Certificate, NDArray[np.int32]] | None
    ) = None

    def _full(self) -> dict[str, Any]:
        from . import _report

        if self._outcome is None:
            raise TypeError("This report holds no surfaces to show; that of remesh does.")
        return _report.full_report(self, *self._outcome)


class Mesh(tuple["NDArray[np.float64]", "NDArray[np.int32]"]):
    """The pair (vertices, faces): ``V, F = mesh``. ``repairs`` lists what was mended on the way,
    ``attributes`` is what a file says of colours, textures and labels."""

    repairs: list[dict[str, Any]]
    attributes: Attributes | None

    def __new__(
        cls,
        vertices: NDArray[np.float64],
        faces: NDArray[np.int32],
        repairs: list[dict[str, Any]] | None = None,
        attributes: Attributes | None = None,
    ) -> Mesh:
        mesh = super().__new__(cls, (vertices, faces))
        mesh.repairs = [] if repairs is None else repairs
        mesh.attributes = attributes
        return mesh

    def __getnewargs__(self) -> tuple[Any, ...]:
        return (self[0], self[1], self.repairs, self.attributes)

    @property
    def vertices(self) -> NDArray[np.float64]:
        """(n, 3) float64."""
        return self[0]

    @property
    def faces(self) -> NDArray[np.int32]:
        """(m, 3) int32."""
        return self[1]

    def __repr__(self) -> str:
        return f"<nonobtuse.Mesh: {len(self.vertices)} vertices, {len(self.faces)} faces>"


class Certificate(NamedTuple):
    """Exact proof that every angle is in [min_angle, max_angle) degrees, or what breaks it.

    True where it holds: ``if certify(V, F): ...``
    """

    min_angle: float
    max_angle: float
    certified: bool
    triangles: int  #: number of triangles tested
    too_large: NDArray[np.int32]  #: triangles with an angle >= max_angle, worst first
    too_small: NDArray[np.int32]  #: triangles with an angle < min_angle, worst first

    def __bool__(self) -> bool:
        return self.certified

    def __repr__(self) -> str:
        verdict = (
            "certified"
            if self.certified
            else f"{len(self.too_large)} too large, {len(self.too_small)} too small"
        )
        return (
            f"<nonobtuse.Certificate [{self.min_angle:g}, {self.max_angle:g}) degrees: {verdict}, "
            f"{self.triangles} triangles>"
        )


class Result:
    """A remeshed surface and all that is known of it."""

    __slots__ = (
        "attributes",
        "barycentric",
        "certificate",
        "faces",
        "feature_edges",
        "goal",
        "report",
        "source",
        "source_triangle",
        "status",
        "vertices",
    )

    vertices: NDArray[np.float64]
    """(n, 3): exactly as many as were asked for."""
    faces: NDArray[np.int32]
    """(m, 3), counter-clockwise seen from outside."""
    source_triangle: NDArray[np.int32]
    """(n,): the face of ``source`` nearest to each vertex."""
    barycentric: NDArray[np.float64]
    """(n, 3): coordinates of the nearest point in that face."""
    attributes: Attributes | None
    """Those given, carried over; None if there were none."""
    feature_edges: NDArray[np.int32]
    """(k, 2): edges of the result that make up the creases and boundaries of the input."""
    source: Mesh
    """The mesh that ``source_triangle`` speaks of: the arrays given, or the repaired input."""
    status: Status
    certificate: Certificate
    """Against the promise, [30, 90) degrees."""
    goal: Certificate
    """Against the bounds that were asked for."""
    report: Report
    """Figures before and after, repairs, options, seconds: see docs/json.md."""

    @property
    def mesh(self) -> Mesh:
        """(vertices, faces), as `write`, `measure` and `certify` take them: ``*result.mesh``."""
        return Mesh(self.vertices, self.faces, None, self.attributes)

    def transfer(self, values: NDArray[Any]) -> NDArray[Any]:
        """Values per vertex of ``source`` (n, ...) carried over to the vertices of the result."""
        values = np.asarray(values)
        if values.shape[:1] != self.source.vertices.shape[:1]:
            raise InvalidInput(
                f"values must have one row for each of the {len(self.source.vertices)} vertices of "
                f"the source; their shape is {values.shape}."
            )
        corners = values[self.source.faces[self.source_triangle]]
        carried: NDArray[Any] = np.einsum("ij,ij...->i...", self.barycentric, corners)
        return carried

    def __repr__(self) -> str:
        return (
            f"<nonobtuse.Result: {self.status.value}, {len(self.vertices)} vertices, "
            f"{len(self.faces)} faces>"
        )
