"""The one call: what it promises, its options, its errors, random meshes."""

import inspect
import json
import pickle
import re
import subprocess
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest
from conftest import ROOT, sphere
from hypothesis import given, settings
from hypothesis import strategies as st

import nonobtuse
from nonobtuse import Status


def test_the_result_is_what_is_promised(mesh, result):
    assert result.vertices.shape == (700, 3) and result.vertices.dtype == np.float64
    assert result.faces.dtype == np.int32 and result.faces.shape[1] == 3
    assert result.source_triangle.shape == (700,) and result.source_triangle.dtype == np.int32
    assert result.barycentric.shape == (700, 3) and result.barycentric.dtype == np.float64
    for array in (*result.mesh, result.source_triangle, result.barycentric):
        assert array.flags.c_contiguous and array.flags.writeable
    certificate = nonobtuse.certify(*result.mesh, min_angle=40, max_angle=80)
    assert bool(certificate) == bool(result.goal) == (result.status is Status.CONVERGED)
    assert bool(result.certificate) == bool(nonobtuse.certify(*result.mesh))
    before = nonobtuse.measure(*mesh)["topology"]
    after = nonobtuse.measure(*result.mesh)["topology"]
    for key in ("components", "boundary_loops", "euler_characteristic", "nonmanifold_edges"):
        assert before[key] == after[key]


def test_vertices_come_from_where_the_result_says(mesh, result):
    assert result.source_triangle.min() >= 0
    assert result.source_triangle.max() < len(result.source.faces)
    np.testing.assert_allclose(result.barycentric.sum(axis=1), 1, atol=1e-9)
    assert result.barycentric.min() >= -1e-9
    feet = result.transfer(result.source.vertices)
    edge = np.linalg.norm(np.diff(result.vertices[result.faces[:, :2]], axis=1), axis=2).mean()
    assert np.linalg.norm(feet - result.vertices, axis=1).max() < edge
    np.testing.assert_allclose(result.transfer(np.ones(len(result.source.vertices))), 1)


def test_the_report_is_json(result):
    report = json.loads(result.report.to_json())
    assert report == result.report
    assert report["status"] == result.status.value
    assert report["options"]["vertices"] == report["after_vertices"] == 700
    assert report["after"]["triangles"] == len(result.faces)
    assert report["before"]["obtuse"] > report["after"]["obtuse"] == 0
    assert {"cvt", "extraction", "certification"} <= {s["stage"] for s in report["stages"]}


def test_transfer_wants_a_value_for_each_vertex(result):
    with pytest.raises(nonobtuse.InvalidInput, match="one row for each"):
        result.transfer(np.zeros(5))


def test_results_survive_pickling(result):
    copy = pickle.loads(pickle.dumps(result))
    np.testing.assert_array_equal(copy.vertices, result.vertices)
    np.testing.assert_array_equal(copy.mesh.faces, result.faces)
    assert copy.status is result.status and copy.report == result.report
    again = pickle.loads(pickle.dumps(result.mesh))
    assert isinstance(again, nonobtuse.Mesh) and again.repairs == []


def test_same_bits_for_any_threads_and_order(mesh, result):
    vertices, faces = mesh
    for threads in (1, 2, 5):
        other = nonobtuse.remesh(
            np.asfortranarray(vertices), faces.astype(np.uint64), vertices=700, threads=threads
        )
        assert other.vertices.tobytes() == result.vertices.tobytes()
        assert other.faces.tobytes() == result.faces.tobytes()


def test_same_bytes_as_the_tool(mesh, result, tool, tmp_path):
    nonobtuse.write(tmp_path / "in.obj", *mesh)
    command = [tool, "remesh", tmp_path / "in.obj", "-o", tmp_path / "tool.obj"]
    run = subprocess.run(
        [*command, "--vertices", "700", "--json"], capture_output=True, text=True, check=False
    )
    assert run.returncode in (0, 1), run.stderr
    nonobtuse.write(tmp_path / "python.obj", *result.mesh)
    assert (tmp_path / "tool.obj").read_bytes() == (tmp_path / "python.obj").read_bytes()
    theirs = json.loads(run.stdout)
    assert set(theirs) - set(result.report) == {
        "command", "input", "output", "exit_code", "distance",
    }  # fmt: skip
    for key in ("status", "options", "repairs", "before", "after", "goal", "promise"):
        assert theirs[key] == result.report[key]


def test_two_calls_at_once_give_the_same_as_alone(mesh, result):
    with ThreadPoolExecutor(2) as pool:
        calls = [pool.submit(nonobtuse.remesh, *mesh, vertices=700) for _ in range(2)]
    for call in calls:
        assert call.result().vertices.tobytes() == result.vertices.tobytes()


def test_every_option_of_the_library_is_a_keyword():
    header = (ROOT / "include/nonobtuse/options.h").read_text()
    fields = re.findall(r"^  [\w:]+ (\w+) = [^;(]+;", header.split("struct RemeshOptions")[1], re.M)
    keywords = inspect.signature(nonobtuse.remesh).parameters
    assert len(fields) >= 9
    assert set(fields) <= set(keywords)
    assert {"threads", "progress", "clean"} <= set(keywords)


def test_every_option_of_the_tool_is_a_keyword():
    table = (ROOT / "README.md").read_text().split("| option of `remesh` |")[1].split("\n\n")[0]
    cells = [row.split(" | ")[0] for row in table.splitlines()]
    options = {o[2:].replace("-", "_") for o in re.findall(r"--[a-z][a-z-]*", " ".join(cells))}
    printing = {"no_distance", "ascii", "json", "report", "quiet"}
    assert len(options) > 20
    assert options - printing <= set(inspect.signature(nonobtuse.remesh).parameters)


@pytest.mark.parametrize("sizing", ["lfs", "curvature"])
def test_sizing_by_name(mesh, sizing):
    result = nonobtuse.remesh(*mesh, vertices=700, sizing=sizing)
    assert len(result.vertices) == 700
    assert result.report["options"]["sizing"] == sizing
    assert 0.9 < result.report["size_ratio"]["median"] < 1.1


def test_target_lengths():
    vertices, faces = sphere(4)
    lengths = 0.1 + 0.05 * vertices[:, 2]  # three times as long at the top as at the bottom
    result = nonobtuse.remesh(vertices, faces, vertices=900, target_lengths=lengths)
    assert len(result.vertices) == 900
    edges = result.vertices[result.faces] - result.vertices[np.roll(result.faces, 1, axis=1)]
    length = np.linalg.norm(edges, axis=2).mean(axis=1)
    height = result.vertices[result.faces].mean(axis=1)[:, 2]
    assert length[height > 0.8].mean() > 1.8 * length[height < -0.8].mean()
    with pytest.raises(nonobtuse.InvalidInput):
        nonobtuse.remesh(vertices, faces, vertices=900, target_lengths=lengths[:-1])
    with pytest.raises(nonobtuse.InvalidInput):
        nonobtuse.remesh(vertices, faces, vertices=900, sizing="square")


def box():
    """A cube of six squares of 8 by 8, welded: every edge of the cube is a chain of edges."""
    n = 8
    grid = np.stack(np.meshgrid(*[np.arange(n + 1)] * 2, indexing="ij"), -1).reshape(-1, 2) / n
    quads = [
        (i * (n + 1) + j, (i + 1) * (n + 1) + j, (i + 1) * (n + 1) + j + 1, i * (n + 1) + j + 1)
        for i in range(n)
        for j in range(n)
    ]
    square = np.array([t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))])
    points, faces = [], []
    for axis in range(3):
        for side in (0, 1):
            points.append(np.insert(grid, axis, side, axis=1))
            flip = (side == 0) != (axis == 1)
            faces.append((square[:, ::-1] if flip else square) + 81 * len(faces))
    unique, inverse = np.unique(np.concatenate(points), axis=0, return_inverse=True)
    return unique, inverse.reshape(-1)[np.concatenate(faces)]


def test_features_and_sizing_by_value():
    vertices, faces = box()
    on_edge = (np.isin(vertices, (0, 1)).sum(axis=1) >= 2).nonzero()[0]
    pairs = np.array([e for e in nonobtuse.detect_features(vertices, faces)])
    assert set(pairs.ravel()) == set(on_edge)
    by_angle = nonobtuse.remesh(vertices, faces, vertices=500, features=30)
    by_name = nonobtuse.remesh(
        vertices, faces, vertices=500, features="dihedral", feature_angle=30
    )
    assert np.array_equal(by_angle.vertices, by_name.vertices)
    by_pairs = nonobtuse.remesh(vertices, faces, vertices=500, features=pairs)
    assert len(by_pairs.feature_edges) > 12
    lengths = np.full(len(vertices), 0.1)
    by_array = nonobtuse.remesh(vertices, faces, sizing=lengths)
    named = nonobtuse.remesh(vertices, faces, target_lengths=lengths)
    assert np.array_equal(by_array.vertices, named.vertices)
    with pytest.raises(nonobtuse.InvalidInput, match="not both"):
        nonobtuse.remesh(vertices, faces, sizing=lengths, target_lengths=lengths)


def test_options_follow_the_vertices_through_cleaning():
    vertices, faces = box()
    pairs = nonobtuse.detect_features(vertices, faces)
    lengths = 0.08 + 0.04 * vertices[:, 2]
    clean = nonobtuse.remesh(vertices, faces, feature_edges=pairs, target_lengths=lengths)
    unused = np.concatenate([[[9.0, 9, 9]], vertices])  # every vertex has the next number
    given = nonobtuse.remesh(
        unused, faces + 1, feature_edges=pairs + 1, target_lengths=np.insert(lengths, 0, 7)
    )
    assert np.array_equal(given.vertices, clean.vertices)


def test_keep_seams_keeps_borders_of_labels():
    vertices, faces = sphere(3)
    labels = (vertices[faces].mean(axis=1)[:, 2] > 0).astype(np.int32)
    attributes = nonobtuse.Attributes(labels=labels)
    kept = nonobtuse.remesh(
        vertices, faces, vertices=600, attributes=attributes, keep_seams=True
    )
    assert len(kept.feature_edges) > 10
    assert len(nonobtuse.remesh(vertices, faces, vertices=600).feature_edges) == 0


@pytest.mark.parametrize("method", ["cvt", "cvt-nob"])
def test_methods(mesh, method):
    result = nonobtuse.remesh(*mesh, vertices=700, method=method)
    assert len(result.vertices) == 700
    assert result.report["options"]["method"] == method


def test_edge_length_in_three_ways():
    vertices, faces = sphere(3)
    diagonal = np.linalg.norm(np.ptp(vertices, axis=0))
    results = [
        nonobtuse.remesh(vertices, faces, **lengths, method="cvt")
        for lengths in (
            {"edge_length": np.float32(0.0625) * diagonal},
            {"edge_length": "6.25%"},
            {"relative_edge_length": 0.0625},
        )
    ]
    assert len({len(r.vertices) for r in results}) == 1
    edges = np.diff(results[0].vertices[results[0].faces[:, :2]], axis=1)
    assert np.linalg.norm(edges, axis=2).mean() == pytest.approx(0.0625 * diagonal, rel=0.1)


@pytest.mark.parametrize(
    ("options", "error", "words"),
    [
        ({"vertices": 12.5}, TypeError, "whole number"),
        ({"vertices": "many"}, TypeError, "whole number"),
        ({"vertices": True}, TypeError, "whole number"),
        ({"vertices": 0}, ValueError, "at least 1"),
        ({"vertices": -3}, ValueError, "between 0"),
        ({"vertices": 2**40}, ValueError, "between 0"),
        ({"edge_length": "thin"}, ValueError, "'1%'"),
        ({"edge_length": -1}, ValueError, "positive"),
        ({"relative_edge_length": float("nan")}, ValueError, "positive"),
        ({"method": "magic"}, ValueError, "default, cvt, cvt-fs, cvt-nob"),
        ({"min_angle": 70}, ValueError, "angle"),
        ({"min_angle": "40"}, TypeError, "number"),
        ({"seed": -1}, ValueError, "seed"),
        ({"threads": -1}, ValueError, "threads"),
        ({"progress": 3}, TypeError, "callable"),
        ({"vertexes": 3}, TypeError, "vertexes"),
        ({"vertices": 100, "edge_length": 0.1}, ValueError, "edge length"),
    ],
)
def test_options_are_checked_in_words(mesh, options, error, words):
    with pytest.raises(error, match=words):
        nonobtuse.remesh(*mesh, **options)


def test_too_few_vertices_says_how_many(mesh):
    with pytest.raises(nonobtuse.TooFewVertices) as info:
        nonobtuse.remesh(*mesh, vertices=5)
    assert info.value.least > 5
    assert str(info.value.least) in str(info.value)
    assert isinstance(info.value, nonobtuse.InvalidInput)


def test_repairs_are_made_and_reported_or_refused(mesh):
    vertices, faces = mesh
    # An unused vertex first, a degenerate face last, one face turned.
    vertices = np.concatenate([[[9.0, 9.0, 9.0]], vertices])
    faces = np.concatenate([faces + 1, [[1, 1, 2]]])
    faces[7] = faces[7, ::-1]
    result = nonobtuse.remesh(vertices, faces, vertices=700)
    assert len(result.report["repairs"]) == 3
    assert result.source.repairs == result.report["repairs"]
    assert len(result.source.vertices) == len(vertices) - 1
    feet = result.transfer(result.source.vertices)
    assert np.abs(feet).max() < 9
    with pytest.raises(nonobtuse.InvalidInput):
        nonobtuse.remesh(vertices, faces, vertices=700, clean=False)


@settings(deadline=None, max_examples=12)
@given(
    subdivisions=st.integers(1, 2),
    stretch=st.tuples(*3 * [st.floats(0.3, 3)]),
    noise=st.floats(0, 0.03),
    scale=st.sampled_from([1e-6, 1.0, 1e6]),
    seed=st.integers(0, 2**32 - 1),
    count=st.integers(30, 200),
)
def test_random_meshes(subdivisions, stretch, noise, scale, seed, count):
    vertices, faces = sphere(subdivisions)
    random = np.random.default_rng(seed)
    vertices = scale * (vertices + noise * random.standard_normal(vertices.shape)) * stretch
    order = random.permutation(len(vertices))
    faces = np.argsort(order)[faces]
    try:
        result = nonobtuse.remesh(vertices[order], faces, vertices=count, seed=seed)
    except nonobtuse.TooFewVertices as error:
        assert error.least > count
        return
    assert len(result.vertices) == count
    assert len(result.faces) == 2 * count - 4  # a sphere
    topology = nonobtuse.measure(*result.mesh)["topology"]
    assert topology["euler_characteristic"] == 2 and topology["nonmanifold_edges"] == 0
    assert bool(result.goal) == (result.status is Status.CONVERGED)
