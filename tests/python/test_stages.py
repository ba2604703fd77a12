"""The steps of the pipeline on their own."""

import numpy as np
import pytest
from conftest import icosahedron, sphere

import nonobtuse


def areas(corners):
    return 0.5 * np.linalg.norm(
        np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1
    )


def sites_on(vertices, faces, count, seed=0):
    random = np.random.default_rng(seed)
    weights = random.dirichlet(np.ones(3), count)
    return np.einsum("ij,ijk->ik", weights, vertices[faces[random.integers(0, len(faces), count)]])


def piece_triangles(diagram):
    """Fans of the pieces: (t, 3, 3) corners, (t,) piece."""
    fans, pieces = [], []
    for p, (a, b) in enumerate(zip(diagram.start, diagram.start[1:], strict=False)):
        for c in range(a + 1, b - 1):
            fans.append(diagram.corners[[a, c, c + 1]])
            pieces.append(p)
    return np.array(fans), np.array(pieces)


@pytest.mark.parametrize("scale", [1e-6, 1, 1e6])
def test_pieces_cover_the_surface_and_lie_nearest_to_their_site(scale):
    vertices, faces = sphere(2)
    vertices *= scale
    sites = sites_on(vertices, faces, 40)
    diagram = nonobtuse.restricted_voronoi(vertices, faces, sites)
    assert len(diagram.face) == len(diagram.site) == len(diagram.start) - 1
    assert diagram.start[-1] == len(diagram.corners) == len(diagram.side)
    triangles, pieces = piece_triangles(diagram)
    total = areas(vertices[faces])
    summed = np.bincount(diagram.face[pieces], areas(triangles), len(faces))
    np.testing.assert_allclose(summed, total, rtol=1e-9)
    distance = np.linalg.norm(triangles.mean(axis=1)[:, None] - sites[None], axis=2)
    own = distance[np.arange(len(pieces)), diagram.site[pieces]]
    assert (own <= distance.min(axis=1) + 1e-9 * scale).all()
    assert (np.diff(diagram.dual_edges, axis=1) > 0).all() and (diagram.dual_lengths >= 0).all()


def test_dual_of_the_corners_is_the_mesh_itself():
    vertices, faces = sphere(2)
    dual = nonobtuse.restricted_delaunay(vertices, faces, vertices)
    rotated = [tuple(np.roll(t, -np.argmin(t))) for t in faces]
    assert sorted(map(tuple, dual.tolist())) == sorted(tuple(map(int, t)) for t in rotated)
    localized = nonobtuse.restricted_delaunay(vertices, faces, vertices, localized=True)
    np.testing.assert_array_equal(localized, dual)
    edges = nonobtuse.restricted_voronoi(vertices, faces, vertices).dual_edges
    assert len(edges) == len(faces) * 3 // 2


def test_localized_cells_are_connected_across_a_thin_slab():
    """Two parallel sheets, all sites on one of them: plain cells reach through."""
    n = 12
    x, y = np.meshgrid(np.arange(n, dtype=float), np.arange(n, dtype=float))
    sheet = np.stack([x.ravel(), y.ravel(), np.zeros(n * n)], 1)
    i = (np.arange(n - 1)[:, None] * n + np.arange(n - 1)).ravel()
    quads = np.concatenate([np.stack([i, i + 1, i + n + 1], 1), np.stack([i, i + n + 1, i + n], 1)])
    vertices = np.concatenate([sheet, sheet + [0, 0, -0.01]])
    faces = np.concatenate([quads, quads[:, ::-1] + n * n])
    sites = np.concatenate([sites_on(sheet, quads, 30), sites_on(sheet, quads, 30, 1)])
    sites[30:, 2] = -0.01
    diagram = nonobtuse.restricted_voronoi(vertices, faces, sites, localized=True)
    upper = diagram.face < len(quads)
    assert (diagram.site[upper] < 30).all() and (diagram.site[~upper] >= 30).all()
    plain = nonobtuse.restricted_voronoi(vertices, faces, sites)
    assert (plain.site[upper] >= 30).any()


def test_gradient_like_finite_differences():
    vertices, faces = sphere(2)
    sites = sites_on(vertices, faces, 25)
    value = nonobtuse.cvt_energy(vertices, faces, sites)
    np.testing.assert_allclose(
        value.gradient, 2 * value.mass[:, None] * (sites - value.centroid), atol=1e-12
    )
    assert value.mass.sum() == pytest.approx(areas(vertices[faces]).sum())
    random = np.random.default_rng(1)
    for _ in range(5):
        direction = random.standard_normal(sites.shape)
        h = 1e-5
        ahead = nonobtuse.cvt_energy(vertices, faces, sites + h * direction).energy
        behind = nonobtuse.cvt_energy(vertices, faces, sites - h * direction).energy
        slope = (ahead - behind) / (2 * h)
        assert slope == pytest.approx((value.gradient * direction).sum(), rel=1e-6, abs=1e-8)


@pytest.mark.parametrize("scale", [1e-5, 1e5])
def test_energy_scales_as_the_fourth_power(scale):
    vertices, faces = sphere(1)
    sites = sites_on(vertices, faces, 20)
    one = nonobtuse.cvt_energy(vertices, faces, sites)
    other = nonobtuse.cvt_energy(scale * vertices, faces, scale * sites)
    assert other.energy == pytest.approx(scale**4 * one.energy, rel=1e-9)
    np.testing.assert_allclose(other.gradient, scale**3 * one.gradient, atol=1e-9 * scale**3)


def test_lloyd_descends():
    vertices, faces = sphere(2)
    sites = sites_on(vertices, faces, 30)
    energies = []
    for _ in range(8):
        value = nonobtuse.cvt_energy(vertices, faces, sites)
        energies.append(value.energy)
        sites = value.centroid
    assert energies == sorted(energies, reverse=True) and energies[-1] < energies[0]


@pytest.mark.parametrize(
    "call", [nonobtuse.restricted_voronoi, nonobtuse.restricted_delaunay, nonobtuse.cvt_energy]
)
def test_what_cannot_be_used_is_refused(call):
    vertices, faces = icosahedron()
    for sites in (np.empty((0, 3)), [[0, 0, np.nan]], [[0, 0]]):
        with pytest.raises(nonobtuse.InvalidInput, match="[Ss]ite"):
            call(vertices, faces, sites)
    with pytest.raises(nonobtuse.InvalidInput):
        call(vertices, np.concatenate([faces, faces[:1]]), vertices)
    with pytest.raises(nonobtuse.InvalidInput):
        call(vertices, np.empty((0, 3), int), vertices)
    with pytest.raises(nonobtuse.InvalidInput):
        call(0 * vertices, faces, vertices)
    coincident = np.concatenate([vertices, vertices])
    assert call(vertices, faces, coincident) is not None


def test_local_feature_size_of_a_sphere_is_its_radius(mesh):
    vertices, faces = sphere(4)
    sizes = nonobtuse.local_feature_size(3 * vertices + [5, 0, -7], faces, samples=2000)
    np.testing.assert_allclose(sizes, 3, rtol=0.1)
    one, two = (nonobtuse.local_feature_size(*mesh, samples=4000, threads=t) for t in (1, 2))
    assert one.tobytes() == two.tobytes() and 0 < one.min() < one.max() < 1
    with pytest.raises(nonobtuse.InvalidInput, match="samples"):
        nonobtuse.local_feature_size(vertices, faces, samples=3)
    with pytest.raises(nonobtuse.InvalidInput):
        nonobtuse.local_feature_size(vertices, np.concatenate([faces, faces]))


def cube(n):
    """The unit cube's surface, n x n squares a face, welded."""
    u = np.arange(n + 1) / n
    a, b = np.meshgrid(u, u, indexing="ij")
    flat = np.stack([a, b, np.zeros_like(a)], -1).reshape(-1, 3)
    i = (np.arange(n)[:, None] * (n + 1) + np.arange(n)).ravel()
    square = np.concatenate([np.stack([i, i + 1, i + n + 2], 1), np.stack([i, i + n + 2, i + n + 1], 1)])
    points, faces = [], []
    for k in range(3):
        for side in (0, 1):
            p = np.roll(flat, k, axis=1)
            p[:, (2 + k) % 3] = side
            f = square if side == 0 else square[:, ::-1]
            faces.append(f + len(flat) * len(points))
            points.append(p)
    vertices, index = np.unique(np.round(np.concatenate(points), 9), axis=0, return_inverse=True)
    return nonobtuse.clean(vertices, index.ravel()[np.concatenate(faces)])


def test_features_of_a_cube_are_its_edges_and_a_sphere_has_none(mesh):
    surface = cube(6)
    for angle in (None, 45):
        edges = nonobtuse.detect_features(*surface, angle=angle)
        assert edges.shape == (12 * 6, 2) and (edges[:, 0] < edges[:, 1]).all()
        ends = surface.vertices[edges]
        assert (((ends == 0) | (ends == 1)).all(axis=1).sum(axis=1) >= 2).all()
    assert len(nonobtuse.detect_features(*surface, angle=100)) == 0
    assert len(nonobtuse.detect_features(*sphere(3))) == 0
    # Of an open surface the boundary.
    half = surface.faces[surface.vertices[surface.faces].mean(axis=1)[:, 2] < 0.999]
    assert len(nonobtuse.detect_features(*nonobtuse.clean(surface.vertices, half))) == 12 * 6
    with pytest.raises(nonobtuse.InvalidInput, match="angle"):
        nonobtuse.detect_features(*mesh, angle=0)
