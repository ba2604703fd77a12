"""Geodesic distance by the heat method (Crane, Weischedel, Wardetzky 2013) on a sphere, where the
exact distance is known: the error before and after remeshing.

    python examples/geodesics.py [--size N] [--picture FILE.png]

The heat method solves two linear systems with the cotangent Laplacian; where weights are negative
the heat may become negative, and the gradient of nothing has no direction.
"""

from __future__ import annotations

import argparse

import numpy as np
import scipy.sparse.linalg as solvers
from shapes import bad_sphere, cotangents, edge_lengths, laplacian, negative_weights, table

import nonobtuse


def heat_distance(vertices: np.ndarray, faces: np.ndarray, source: int) -> np.ndarray:
    """Distance of every vertex along the surface to the vertex `source`."""
    count = len(vertices)
    lengths = edge_lengths(vertices, faces)
    stiffness, mass = laplacian(faces, lengths, count)
    time = lengths.mean() ** 2
    start = np.zeros(count)
    start[source] = 1
    heat = solvers.spsolve((mass + time * stiffness).tocsc(), start)

    # Unit vectors against the heat's gradient, one for every triangle.
    corners = vertices[faces]
    across = np.roll(corners, -2, axis=1) - np.roll(corners, -1, axis=1)  # opposite each corner
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    # Heat falls by many orders of magnitude: scaled in every triangle, so that none underflows.
    local = heat[faces] / np.maximum(np.abs(heat[faces]).max(axis=1, keepdims=True), 1e-300)
    gradient = (local[:, :, None] * np.cross(normal[:, None], across)).sum(axis=1)
    direction = -gradient / np.maximum(np.linalg.norm(gradient, axis=1, keepdims=True), 1e-300)

    # Its integrated divergence, and the function whose gradient it is.
    cot, _ = cotangents(lengths)
    flux = np.einsum("tkc,tc->tk", across, direction)
    term = cot * flux
    share = (np.roll(term, -2, axis=1) - np.roll(term, -1, axis=1)) / 2
    divergence = np.bincount(faces.ravel(), share.ravel(), count)
    free = np.arange(count) != source
    distance = np.zeros(count)
    distance[free] = solvers.spsolve(stiffness[free][:, free].tocsc(), -divergence[free])
    return distance


def main() -> dict[str, dict[str, float]]:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--size", type=int, default=32, help="rows of the input's grid")
    parser.add_argument("--picture", help="PNG to draw (needs pyvista)")
    arguments = parser.parse_args()

    vertices, faces = bad_sphere(arguments.size)
    result = nonobtuse.remesh(vertices, faces, on_surface=True)
    figures: dict[str, dict[str, float]] = {}
    rows = [("", "vertices", "obtuse", "negative weights", "mean error", "largest error")]
    for name, (points, triangles) in {"input": (vertices, faces), "remeshed": result.mesh}.items():
        # The same place on both: nearest to a point off the poles.
        toward = np.array([0.6, 0.5, 0.62])
        source = int(np.argmax(points @ toward / np.linalg.norm(points, axis=1)))
        found = heat_distance(points, triangles, source)
        unit = points / np.linalg.norm(points, axis=1, keepdims=True)
        exact = np.arccos(np.clip(unit @ unit[source], -1, 1))
        # The weights' mean, so that crowded poles do not count more than the rest.
        stiffness, mass = laplacian(triangles, edge_lengths(points, triangles), len(points))
        weight = mass.diagonal() / mass.diagonal().sum()
        error = np.abs(found - exact) / np.pi
        negative, _ = negative_weights(stiffness)
        obtuse = nonobtuse.measure(points, triangles)["angles"]["obtuse"]
        mean, largest = float(weight @ error), float(error.max())
        rows.append((name, f"{len(points)}", f"{obtuse}", f"{negative}", f"{100 * mean:.3f} %",
                     f"{100 * largest:.3f} %"))  # fmt: skip
        figures[name] = {"mean": mean, "largest": largest, "negative": negative}
        if arguments.picture and name == "remeshed":
            nonobtuse.plot((points, triangles), color=found, path=arguments.picture)
    table("Heat method on a sphere, error relative to half its circumference", rows)
    return figures


if __name__ == "__main__":
    main()
