"""Poisson's equation on a surface by linear finite elements, before and after remeshing.

    python examples/poisson.py [--size N] [--picture FILE.png]

On the unit sphere, the Laplacian of a spherical harmonic of degree l is -l (l + 1) times itself:
the right-hand side is known, and so is the solution. Looked at are the error, the iterations of
conjugate gradients, and whether the discrete maximum principle holds: heat let out of one vertex
for a moment must not turn negative anywhere.
"""

from __future__ import annotations

import argparse

import numpy as np
import scipy.sparse.linalg as solvers
from shapes import bad_sphere, edge_lengths, laplacian, table

import nonobtuse


def harmonic(points: np.ndarray) -> np.ndarray:
    """A spherical harmonic of degree 3, continued along the rays."""
    x, y, z = (points / np.linalg.norm(points, axis=1, keepdims=True)).T
    return x * y * z + 0.5 * y * (5 * y**2 - 3)


def main() -> dict[str, dict[str, float]]:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--size", type=int, default=32, help="rows of the input's grid")
    parser.add_argument("--picture", help="PNG to draw (needs pyvista)")
    arguments = parser.parse_args()

    vertices, faces = bad_sphere(arguments.size)
    result = nonobtuse.remesh(vertices, faces, on_surface=True)
    figures: dict[str, dict[str, float]] = {}
    rows = [("", "vertices", "L2 error", "largest error", "CG iterations", "least heat")]
    for name, (points, triangles) in {"input": (vertices, faces), "remeshed": result.mesh}.items():
        stiffness, mass = laplacian(triangles, edge_lengths(points, triangles), len(points))
        exact = harmonic(points)
        weight = mass.diagonal()
        right = weight * (12 * exact)  # 3 * 4
        right -= weight * right.sum() / weight.sum()
        steps = 0

        def count(_: np.ndarray) -> None:
            nonlocal steps
            steps += 1

        solution, failed = solvers.cg(stiffness, right, rtol=1e-10, maxiter=20000, callback=count)
        assert failed == 0
        solution -= weight @ (solution - exact) / weight.sum()
        error = solution - exact
        l2 = float(np.sqrt(weight @ error**2 / (weight @ exact**2)))

        start = np.zeros(len(points))
        start[np.argmin(weight)] = 1
        moment = 0.02 * edge_lengths(points, triangles).mean() ** 2
        # Implicit Euler; not negative for any moment if no weight is.
        heat = solvers.spsolve((mass + moment * stiffness).tocsc(), start)
        least = float(heat.min() / heat.max())
        rows.append((name, f"{len(points)}", f"{100 * l2:.3f} %", f"{np.abs(error).max():.4f}",
                     f"{steps}", f"{least:.1e}"))  # fmt: skip
        figures[name] = {"l2": l2, "steps": steps, "least": least}
        if arguments.picture and name == "remeshed":
            nonobtuse.plot((points, triangles), color=solution, path=arguments.picture)
    table("Poisson's equation on a sphere", rows)
    return figures


if __name__ == "__main__":
    main()
