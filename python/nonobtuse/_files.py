"""Mesh files in and out, cleaning, the sample."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING

from . import _arrays, _attributes, _core
from ._results import Mesh

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from ._attributes import Attributes


def read(path: str | os.PathLike[str]) -> Mesh:
    """Reads OBJ, OFF, PLY or STL (text or binary), told by content, in double precision.

    Only what the format itself demands is done: polygons are triangulated, equal corners of an STL
    welded (see ``.repairs``). `remesh` cleans what it is given; `clean` does so alone. What an OBJ
    or PLY says of colours, textures and labels is in ``.attributes`` (None if nothing).

    Raises OSError, and InvalidInput for indices out of range and coordinates that are not finite.
    """
    os.stat(path)  # a missing file gets its usual exception
    mesh, attributes = _core.read(os.fsencode(path))
    return Mesh(*mesh, _attributes.from_core(attributes))


def write(
    path: str | os.PathLike[str],
    vertices: ArrayLike,
    faces: ArrayLike,
    *,
    attributes: Attributes | None = None,
    binary: bool = True,
) -> None:
    """Writes .obj, .off, .ply or .stl, whole or not at all.

    Texts hold the shortest numbers that read back the same; ``binary`` is for PLY and STL. OBJ and
    PLY hold attributes (PLY: colours in 8 bits, texture coordinates in floats).
    Raises OSError, and InvalidInput for what the format cannot hold.
    """
    arrays = (_arrays.points(vertices), _arrays.faces(faces))
    _core.write(os.fsencode(path), *arrays, _attributes.to_core(attributes), bool(binary))


def clean(vertices: ArrayLike, faces: ArrayLike) -> Mesh:
    """Makes a mesh fit for remeshing; what was done is listed in ``.repairs``.

    Drops degenerate faces and unused vertices, turns faces that disagree with their neighbours.
    ``.repairs`` also lists what is unusual but kept: edges of three or more faces, vertices where
    fans of faces touch.
    Raises InvalidInput, with the element's index, for what cannot be mended.
    """
    return Mesh(*_core.clean(_arrays.points(vertices), _arrays.faces(faces)))


def sample(resolution: int = 64) -> Mesh:
    """A surface of genus 3 from marching cubes on a ``resolution``^3 grid, full of bad triangles."""
    return Mesh(*_core.sample(_arrays.whole_number(resolution, "resolution")))
