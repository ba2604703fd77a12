"""What is given, as the arrays that the extension module reads; errors in words."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ._errors import InvalidInput

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

_MOST = np.iinfo(np.int32).max


def _rows_of_three(given: ArrayLike, name: str) -> NDArray[Any]:
    try:
        array = np.asarray(given)
    except ValueError as error:  # rows of different lengths
        raise InvalidInput(f"{name} must be an (n, 3) array: {error}.") from None
    if array.size == 0 and array.ndim < 2:
        array = array.reshape(0, 3)
    if array.dtype.kind not in "iuf":
        raise TypeError(f"{name} must be numbers; their dtype is {array.dtype}.")
    if array.ndim != 2 or array.shape[1] != 3:
        raise InvalidInput(f"{name} must have the shape (n, 3), not {array.shape}.")
    if array.shape[0] > _MOST:
        raise InvalidInput(f"{name} may have at most {_MOST} rows, not {array.shape[0]}.")
    return array


def points(given: ArrayLike, name: str = "vertices") -> NDArray[np.float64]:
    """(n, 3) float64, contiguous; the array itself if it is that already."""
    return np.ascontiguousarray(_rows_of_three(given, name), dtype=np.float64)


def faces(given: ArrayLike) -> NDArray[np.int32]:
    """(m, 3) int32, contiguous. Floats are taken if they are whole numbers."""
    array = _rows_of_three(given, "faces")
    if array.dtype == np.int32 or array.size == 0:
        return np.ascontiguousarray(array, dtype=np.int32)
    if array.dtype.kind == "f":
        array = array.astype(np.float64)
        if not bool(np.all(array == np.floor(array))):
            raise TypeError("faces must be vertex indices: whole numbers, not fractions.")
    outside = ~((array >= 0) & (array <= _MOST))
    if bool(outside.any()):
        row = int(np.argmax(outside.any(axis=1)))
        raise InvalidInput(
            f"Face {row} has the index {array[row][outside[row]][0]}, which no vertex has.", row
        )
    return np.ascontiguousarray(array, dtype=np.int32)


def edges(given: ArrayLike | None, name: str) -> NDArray[np.int32]:
    """(n, 2) int32, contiguous; empty for None."""
    array = np.asarray(np.empty((0, 2), np.int32) if given is None else given)
    if array.size == 0:
        array = np.empty((0, 2), np.int32)
    if array.dtype.kind not in "iu":
        raise TypeError(f"{name} must be vertex indices; their dtype is {array.dtype}.")
    if array.ndim != 2 or array.shape[1] != 2:
        raise InvalidInput(f"{name} must have the shape (n, 2), not {array.shape}.")
    if array.size > 0 and not (0 <= array.min() and array.max() <= _MOST):
        raise InvalidInput(f"{name} has an index that no vertex has.")
    return np.ascontiguousarray(array, dtype=np.int32)


def lengths(given: ArrayLike | None, name: str) -> NDArray[np.float64]:
    """(n,) float64, contiguous; empty for None."""
    array = np.asarray([] if given is None else given)
    if array.dtype.kind not in "iuf":
        raise TypeError(f"{name} must be numbers; their dtype is {array.dtype}.")
    if array.ndim != 1:
        raise InvalidInput(f"{name} must have the shape (n,), not {array.shape}.")
    return np.ascontiguousarray(array, dtype=np.float64)


def whole_number(given: object, name: str, most: int = _MOST) -> int:
    """An integer in [0, most], numpy's too."""
    if isinstance(given, (bool, np.bool_)):
        raise TypeError(f"{name} must be a whole number, not {given!r}.")
    try:
        number = given.__index__()  # type: ignore[attr-defined]
    except AttributeError:
        raise TypeError(f"{name} must be a whole number, not {given!r}.") from None
    if not 0 <= number <= most:
        raise InvalidInput(f"{name} must be between 0 and {most}, not {number}.")
    return int(number)


def number(given: object, name: str) -> float:
    """A float from any real number."""
    if not hasattr(given, "__float__") and not hasattr(given, "__index__"):
        raise TypeError(f"{name} must be a number, not {given!r}.")
    return float(given)  # type: ignore[arg-type]
