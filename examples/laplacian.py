"""The cotangent Laplacian before and after: negative weights, condition number, and when an
intrinsic Delaunay triangulation is enough.

    python examples/laplacian.py [--size N] [--picture FILE.png]

An edge whose two opposite angles add up to more than 180 degrees has a negative weight: the
discrete maximum principle is lost. Remeshing removes them, and so does flipping edges
intrinsically (Fisher et al. 2007), which moves no vertex and adds none: if the weights of one
linear system are all that matters, the flips are enough, and cheaper. They keep slivers where
vertices stand badly, and with them the condition number and what depends on single triangles.
"""

from __future__ import annotations

import argparse

import numpy as np
import scipy.sparse as sparse
import scipy.sparse.linalg as solvers
from shapes import bad_sphere, cotangents, edge_lengths, laplacian, negative_weights, table

import nonobtuse


def intrinsic_delaunay(
    vertices: np.ndarray, faces: np.ndarray
) -> tuple[np.ndarray, np.ndarray, int]:
    """Flips edges, as lengths alone, until every pair of opposite angles adds up to at most 180
    degrees. Returns faces, their lengths (opposite each corner) and the number of flips."""
    faces, lengths = faces.copy(), edge_lengths(vertices, faces)
    # Side 3 t + k is opposite corner k of triangle t; its twin is the same edge in the neighbour.
    sides = np.sort(np.stack([faces[:, [1, 2, 0]].ravel(), faces[:, [2, 0, 1]].ravel()], 1), axis=1)
    order = np.lexsort(sides.T)
    twin = np.empty(len(sides), int)
    twin[order[0::2]], twin[order[1::2]] = order[1::2], order[0::2]
    waiting, flips = list(range(len(sides))), 0
    while waiting:
        side = waiting.pop()
        other = twin[side]
        (t, k), (u, j) = divmod(side, 3), divmod(other, 3)
        if t == u:
            continue
        (cot_t, _), (cot_u, _) = cotangents(lengths[[t]]), cotangents(lengths[[u]])
        if cot_t[0, k] + cot_u[0, j] >= -1e-12:
            continue
        # Corners: p opposite in t, q opposite in u, the edge from a to b.
        p, a, b = faces[t, k], faces[t, (k + 1) % 3], faces[t, (k + 2) % 3]
        q = faces[u, j]
        pa, pb = lengths[t, (k + 2) % 3], lengths[t, (k + 1) % 3]
        qa, qb = lengths[u, (j + 1) % 3], lengths[u, (j + 2) % 3]
        ab = lengths[t, k]
        # The other diagonal of the two triangles laid flat.
        x_p, x_q = (pa**2 + ab**2 - pb**2) / (2 * ab), (qa**2 + ab**2 - qb**2) / (2 * ab)
        y_p = np.sqrt(max(pa**2 - x_p**2, 0))
        y_q = -np.sqrt(max(qa**2 - x_q**2, 0))
        pq = np.hypot(x_p - x_q, y_p - y_q)
        outer = [twin[3 * t + (k + 2) % 3], twin[3 * t + (k + 1) % 3],
                 twin[3 * u + (j + 1) % 3], twin[3 * u + (j + 2) % 3]]  # fmt: skip
        own = {3 * t + (k + 2) % 3: "pa", 3 * t + (k + 1) % 3: "pb",
               3 * u + (j + 1) % 3: "qa", 3 * u + (j + 2) % 3: "qb"}  # fmt: skip
        # New triangles (p, a, q) and (q, b, p), each with the diagonal opposite its corner 1.
        faces[t], lengths[t] = (p, a, q), (qa, pq, pa)
        faces[u], lengths[u] = (q, b, p), (pb, pq, qb)
        place = {"pa": 3 * t + 2, "qa": 3 * t, "pb": 3 * u, "qb": 3 * u + 2}
        for name, was in zip(("pa", "pb", "qa", "qb"), outer, strict=True):
            partner = place[own[was]] if was in own else was
            twin[place[name]], twin[partner] = partner, place[name]
        twin[3 * t + 1], twin[3 * u + 1] = 3 * u + 1, 3 * t + 1
        waiting += list(place.values())
        flips += 1
    return faces, lengths, flips


def condition(stiffness: sparse.csr_matrix, mass: sparse.csr_matrix) -> float:
    """Of the mass-scaled Laplacian without its constants: largest over smallest eigenvalue."""
    root = sparse.diags(1 / np.sqrt(mass.diagonal()))
    matrix = (root @ stiffness @ root).tocsc()
    largest = solvers.eigsh(matrix, 1, which="LA", return_eigenvectors=False, tol=1e-4)[0]
    small = solvers.eigsh(matrix, 4, sigma=-1e-2, return_eigenvectors=False)
    return float(largest / np.sort(small)[1])


def main() -> dict[str, dict[str, float]]:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--size", type=int, default=32, help="rows of the input's grid")
    parser.add_argument("--picture", help="PNG to draw (needs pyvista)")
    arguments = parser.parse_args()

    vertices, faces = bad_sphere(arguments.size)
    flipped, lengths, flips = intrinsic_delaunay(vertices, faces)
    result = nonobtuse.remesh(vertices, faces)
    cases = {
        "input": (vertices, faces, edge_lengths(vertices, faces)),
        f"intrinsic Delaunay, {flips} flips": (vertices, flipped, lengths),
        "remeshed": (*result.mesh, edge_lengths(*result.mesh)),
    }
    figures: dict[str, dict[str, float]] = {}
    rows = [("", "vertices", "negative weights", "smallest angle", "condition number")]
    for name, (points, triangles, sides) in cases.items():
        stiffness, mass = laplacian(triangles, sides, len(points))
        negative, edges = negative_weights(stiffness)
        cot, _ = cotangents(sides)
        smallest = float(np.degrees(np.arctan2(1, cot.max())))
        number = condition(stiffness, mass)
        rows.append((name, f"{len(points)}", f"{negative} of {edges}", f"{smallest:.2f}",
                     f"{number:.0f}"))  # fmt: skip
        figures[name.split(",")[0]] = {
            "negative": negative, "smallest": smallest, "condition": number,
        }  # fmt: skip
    table("Cotangent Laplacian of a sphere", rows)
    print(
        "Both ways leave no negative weight. For one linear system with given vertices, intrinsic "
        "flips\nare all that is needed; slivers, and the condition number they bring, stay."
    )
    if arguments.picture:
        nonobtuse.plot((vertices, faces), result, path=arguments.picture)
    return figures


if __name__ == "__main__":
    main()
