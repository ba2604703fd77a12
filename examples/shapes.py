"""What the examples share: a sphere with bad triangles, cotangent weights, the mass matrix."""

from __future__ import annotations

import numpy as np
import scipy.sparse as sparse


def bad_sphere(resolution: int = 24) -> tuple[np.ndarray, np.ndarray]:
    """The unit sphere by longitude and latitude, shifted so that diagonals run all ways: slivers at
    the poles and obtuse triangles nearly everywhere, as in many a mesh from a modeller."""
    rows, columns = resolution, 2 * resolution
    rng = np.random.default_rng(0)
    height = np.arange(1, rows) / rows * np.pi
    angle = np.arange(columns) / columns * 2 * np.pi
    height, angle = np.meshgrid(height, angle, indexing="ij")
    angle = angle + np.arange(rows - 1)[:, None] * 0.3 * 2 * np.pi / columns
    height = height + rng.uniform(-0.2, 0.2, height.shape) * np.pi / rows
    points = np.stack(
        [np.sin(height) * np.cos(angle), np.cos(height), np.sin(height) * np.sin(angle)], axis=-1
    )
    vertices = np.concatenate([points.reshape(-1, 3), [[0, 1, 0], [0, -1, 0]]])
    index = np.arange((rows - 1) * columns).reshape(rows - 1, columns)
    north, south = len(vertices) - 2, len(vertices) - 1
    a, b = index[:-1].ravel(), np.roll(index[:-1], -1, axis=1).ravel()
    c, d = index[1:].ravel(), np.roll(index[1:], -1, axis=1).ravel()
    ring = np.arange(columns)
    after = np.roll(ring, -1)
    faces = np.concatenate(
        [
            np.stack([a, b, c], 1),
            np.stack([b, d, c], 1),
            np.stack([np.full(columns, north), index[0][after], index[0][ring]], 1),
            np.stack([np.full(columns, south), index[-1][ring], index[-1][after]], 1),
        ]
    )
    return vertices, faces


def edge_lengths(vertices: np.ndarray, faces: np.ndarray) -> np.ndarray:
    """(m, 3): the length of the side opposite each corner."""
    corners = vertices[faces]
    return np.linalg.norm(np.roll(corners, -2, axis=1) - np.roll(corners, -1, axis=1), axis=2)


def cotangents(lengths: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """(m, 3) cotangents of the angles and (m,) areas, from the sides alone."""
    a, b, c = lengths.T
    p = (a + b + c) / 2
    area = np.sqrt(np.maximum(p * (p - a) * (p - b) * (p - c), 1e-300))
    squares = lengths**2
    return (squares.sum(axis=1, keepdims=True) - 2 * squares) / (4 * area[:, None]), area


def laplacian(
    faces: np.ndarray, lengths: np.ndarray, count: int
) -> tuple[sparse.csr_matrix, sparse.csr_matrix]:
    """Cotangent stiffness matrix (positive semi-definite) and lumped mass matrix.

    Off the diagonal, entry (i, j) is minus the weight (cot a + cot b) / 2 of the edge.
    """
    cot, area = cotangents(lengths)
    i = faces[:, [1, 2, 0]].ravel()
    j = faces[:, [2, 0, 1]].ravel()
    weight = (cot / 2).ravel()
    off = sparse.coo_matrix((weight, (i, j)), (count, count))
    off = (off + off.T).tocsr()
    stiffness = sparse.diags(np.asarray(off.sum(axis=1)).ravel()) - off
    mass = np.bincount(faces.ravel(), np.repeat(area / 3, 3), count)
    return stiffness.tocsr(), sparse.diags(mass).tocsr()


def negative_weights(stiffness: sparse.csr_matrix) -> tuple[int, int]:
    """How many edges have a negative weight, and how many there are."""
    upper = sparse.triu(stiffness, 1).tocoo()
    scale = np.abs(upper.data).max()
    return int((upper.data > 1e-12 * scale).sum()), int(upper.nnz)


def table(title: str, rows: list[tuple[str, ...]]) -> None:
    """Prints rows of text in columns; the first row is the head."""
    print(title)
    widths = [max(len(row[k]) for row in rows) for k in range(len(rows[0]))]
    for row in rows:
        cells = [text.rjust(width) for text, width in zip(row[1:], widths[1:], strict=True)]
        print("  " + row[0].ljust(widths[0]) + "  " + "  ".join(cells))
