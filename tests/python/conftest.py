"""What the tests share: a mesh, a finished result, the tool where it was built."""

import os
import pathlib

import numpy as np
import pytest

import nonobtuse

ROOT = pathlib.Path(__file__).resolve().parents[2]


@pytest.fixture(scope="session")
def mesh():
    """A small surface of genus 3; read-only, so that a test that writes to it fails."""
    mesh = nonobtuse.sample(20)
    for array in mesh:
        array.flags.writeable = False
    return mesh


@pytest.fixture(scope="session")
def result(mesh):
    return nonobtuse.remesh(*mesh, vertices=700)


@pytest.fixture(scope="session")
def tool():
    """Path of the command-line tool: $NONOBTUSE_TOOL (scripts/test sets it)."""
    path = os.environ.get("NONOBTUSE_TOOL")
    if not path:
        pytest.skip("NONOBTUSE_TOOL does not say where the command-line tool is")
    return path


def icosahedron():
    """12 vertices on the unit sphere, 20 triangles."""
    g = (1 + 5**0.5) / 2
    vertices = [(0, a, b * g) for a in (-1, 1) for b in (-1, 1)]
    vertices = np.array([np.roll(v, k) for k in range(3) for v in vertices], float)
    edge = 2.0
    distance = np.linalg.norm(vertices[:, None] - vertices[None], axis=2)
    near = np.abs(distance - edge) < 1e-9
    faces = [
        (i, j, k)
        for i in range(12)
        for j in range(i + 1, 12)
        for k in range(j + 1, 12)
        if near[i, j] and near[j, k] and near[i, k]
    ]
    outward = [
        (i, j, k)
        if np.dot(np.cross(vertices[j] - vertices[i], vertices[k] - vertices[i]), vertices[i]) > 0
        else (i, k, j)
        for i, j, k in faces
    ]
    return vertices / np.linalg.norm(vertices[0]), np.array(outward, np.int32)


def sphere(subdivisions):
    """The icosahedron with every triangle cut in four that many times, on the unit sphere."""
    vertices, faces = icosahedron()
    for _ in range(subdivisions):
        edges = np.sort(np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]]), 1)
        unique, index = np.unique(edges, axis=0, return_inverse=True)
        middle = index.reshape(3, -1).T + len(vertices)
        a, b, c = faces.T
        ab, bc, ca = middle.T
        faces = np.concatenate(
            [np.stack(t, 1) for t in ((a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca))]
        )
        points = vertices[unique].mean(axis=1)
        points /= np.linalg.norm(points, axis=1, keepdims=True)
        vertices = np.concatenate([vertices, points])
    return vertices, faces.astype(np.int32)
