"""Shapes, dtypes, memory orders; what is refused and how."""

import numpy as np
import pytest
from conftest import icosahedron
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

import nonobtuse

INTEGERS = [np.int8, np.uint8, np.int16, np.uint16, np.int32, np.uint32, np.int64, np.uint64]
FLOATS = [np.float16, np.float32, np.float64, np.longdouble]


def in_order(array, order):
    """The same numbers as a C array, a Fortran array, a strided view or the other byte order."""
    if order in "CF":
        return np.array(array, order=order)
    if order == "strided":
        wide = np.zeros((2 * len(array), 2 * array.shape[1]), array.dtype)
        wide[::2, ::2] = array
        return wide[::2, ::2]
    return array.astype(array.dtype.newbyteorder())


@settings(deadline=None, max_examples=60)
@given(
    scale=st.integers(1, 40),
    vertex_type=st.sampled_from([np.int8, np.int16, np.int32, np.int64, *FLOATS]),
    face_type=st.sampled_from(INTEGERS + FLOATS),
    orders=st.tuples(*2 * [st.sampled_from(["C", "F", "strided", "swapped"])]),
    read_only=st.booleans(),
)
def test_every_array_of_the_same_numbers_gives_the_same(
    scale, vertex_type, face_type, orders, read_only
):
    vertices, faces = icosahedron()
    vertices = np.round(scale * vertices).astype(vertex_type)
    expected = nonobtuse.measure(vertices.astype(float).tolist(), faces.tolist())
    vertices = in_order(vertices, orders[0])
    faces = in_order(faces.astype(face_type), orders[1])
    vertices.flags.writeable = faces.flags.writeable = not read_only
    before = vertices.copy(), faces.copy()
    assert nonobtuse.measure(vertices, faces) == expected
    cleaned = nonobtuse.clean(vertices, faces)
    assert np.shares_memory(cleaned.vertices, vertices) is False
    np.testing.assert_array_equal(vertices, before[0])
    np.testing.assert_array_equal(faces, before[1])


@settings(deadline=None, max_examples=200)
@given(
    vertices=hnp.arrays(
        st.sampled_from([np.float64, np.float32, np.int64]),
        hnp.array_shapes(min_dims=0, max_dims=3, min_side=0, max_side=5),
    ),
    faces=hnp.arrays(
        st.sampled_from([np.int64, np.uint64, np.float64]),
        hnp.array_shapes(min_dims=0, max_dims=3, min_side=0, max_side=5),
    ),
)
def test_any_arrays_are_taken_or_refused_in_words(vertices, faces):
    for call in (nonobtuse.certify, nonobtuse.measure, nonobtuse.clean, nonobtuse.remesh):
        try:
            call(vertices, faces)
        except (nonobtuse.InvalidInput, TypeError) as error:
            assert len(str(error)) > 10
            assert "incompatible function arguments" not in str(error)


@pytest.mark.parametrize(
    ("vertices", "faces", "error", "words"),
    [
        ([[0, 0], [1, 0], [0, 1]], [[0, 1, 2]], ValueError, r"vertices .*shape \(n, 3\)"),
        ([[0, 0, 0], [1, 0]], [[0, 1, 2]], ValueError, "vertices"),
        (np.eye(3), [[0, 1, 2, 0]], ValueError, r"faces .*shape \(n, 3\)"),
        (np.eye(3), [[0, 1, 2.5]], TypeError, "whole numbers"),
        (np.eye(3), [[0, 1, np.nan]], TypeError, "whole numbers"),
        (np.eye(3) * 1j, [[0, 1, 2]], TypeError, "complex128"),
        (np.eye(3) > 0, [[0, 1, 2]], TypeError, "bool"),
        (np.array([["a"] * 3]), [[0, 1, 2]], TypeError, "vertices"),
        (None, [[0, 1, 2]], TypeError, "object"),
        (np.eye(3), [[0, 1, -1]], ValueError, "Face 0 has the index -1"),
        (np.eye(3), [[0, 1, 2], [0, 1, 2**40]], ValueError, "Face 1 has the index 1099511627776"),
    ],
)
def test_errors_in_words(vertices, faces, error, words):
    with pytest.raises(error, match=words):
        nonobtuse.remesh(vertices, faces)


def test_the_offending_element_is_named():
    vertices = np.eye(3)
    with pytest.raises(nonobtuse.InvalidInput) as info:
        nonobtuse.certify(vertices, [[0, 1, 2], [0, 1, 3]])
    assert info.value.element == 1
    vertices[2, 1] = np.inf
    with pytest.raises(nonobtuse.InvalidInput) as info:
        nonobtuse.clean(vertices, [[0, 1, 2]])
    assert info.value.element == 2
    assert isinstance(info.value, ValueError)
