"""What a mesh carries beside its shape: colours, a texture, labels."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from . import _arrays, _core
from ._errors import InvalidInput

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray


class Attributes:
    """Colours, texture and labels of a mesh; each may be missing.

    A seam is an edge whose two faces disagree on the texture coordinate of an end.
    """

    colors: NDArray[np.float64] | None
    """(n, 4): red, green, blue, alpha of each vertex, in [0, 1]."""
    texture_coordinates: NDArray[np.float64] | None
    """(t, 2)."""
    texture_faces: NDArray[np.int32] | None
    """(m, 3): the texture coordinate of each corner of each face; -1 where a face has none."""
    labels: NDArray[np.int32] | None
    """(m,): the material, group or segment of each face, >= 0."""
    label_names: list[str]
    """The name of each label; may be shorter."""
    labels_are_groups: bool
    """OBJ: ``g`` instead of ``usemtl``."""
    material_library: str
    """OBJ: ``mtllib``."""

    def __init__(
        self,
        colors: NDArray[np.float64] | None = None,
        texture_coordinates: NDArray[np.float64] | None = None,
        texture_faces: NDArray[np.int32] | None = None,
        labels: NDArray[np.int32] | None = None,
        label_names: list[str] | None = None,
        labels_are_groups: bool = False,
        material_library: str = "",
    ) -> None:
        self.colors = colors
        self.texture_coordinates = texture_coordinates
        self.texture_faces = texture_faces
        self.labels = labels
        self.label_names = [] if label_names is None else label_names
        self.labels_are_groups = labels_are_groups
        self.material_library = material_library


def attribute_borders(
    vertices: ArrayLike, faces: ArrayLike, attributes: Attributes
) -> NDArray[np.int32]:
    """(k, 2): the edges between faces of different labels and the seams of the texture, sorted."""
    return _core.attribute_borders(
        _arrays.points(vertices), _arrays.faces(faces), to_core(attributes)
    )


def _table(given: ArrayLike | None, name: str, columns: int, dtype: Any) -> NDArray[Any]:
    array = np.asarray(np.zeros((0, columns)) if given is None else given)
    if array.dtype.kind not in "iuf":
        raise TypeError(f"{name} must be numbers; their dtype is {array.dtype}.")
    if name == "colors" and array.ndim == 2 and array.shape[1] == 3:  # opaque
        array = np.hstack([array, np.ones((len(array), 1))])
    if array.ndim != 2 or array.shape[1] != columns:
        raise InvalidInput(f"{name} must have the shape (n, {columns}), not {array.shape}.")
    return np.ascontiguousarray(array, dtype=dtype)


def to_core(attributes: Attributes | None) -> tuple[Any, ...]:
    """As the extension module takes them: empty arrays for what is missing."""
    a = Attributes() if attributes is None else attributes
    labels = np.asarray([] if a.labels is None else a.labels)
    if labels.ndim != 1 or labels.dtype.kind not in "iuf":
        raise InvalidInput(f"labels must be whole numbers of the shape (m,), not {labels.shape}.")
    return (
        _table(a.colors, "colors", 4, np.float64),
        _table(a.texture_coordinates, "texture_coordinates", 2, np.float64),
        _table(a.texture_faces, "texture_faces", 3, np.int32),
        np.ascontiguousarray(labels, dtype=np.int32),
        [str(name) for name in a.label_names],
        bool(a.labels_are_groups),
        str(a.material_library),
    )


def from_core(given: tuple[Any, ...]) -> Attributes | None:
    """Back again; None if there is nothing."""
    colors, coordinates, texture_faces, labels, *names = given
    if len(colors) == len(texture_faces) == len(labels) == 0:
        return None
    textured = len(texture_faces) > 0
    return Attributes(
        colors if len(colors) else None,
        coordinates if textured else None,
        texture_faces if textured else None,
        labels if len(labels) else None,
        *names,
    )
