"""Reading, writing, cleaning, measuring, certifying."""

import json
import os
import subprocess

import numpy as np
import pytest
from conftest import icosahedron

import nonobtuse


@pytest.mark.parametrize("suffix", ["obj", "off", "ply", "stl"])
@pytest.mark.parametrize("binary", [True, False])
def test_what_is_written_is_read(mesh, tmp_path, suffix, binary):
    path = tmp_path / f"m\u00fcll.{suffix}"
    nonobtuse.write(path, *mesh, binary=binary)
    read = nonobtuse.read(str(path))
    assert len(read.faces) == len(mesh.faces)
    if suffix != "stl":
        assert read.vertices.tobytes() == mesh.vertices.tobytes()
        assert read.faces.tobytes() == mesh.faces.tobytes()
        assert read.repairs == []
    else:
        assert [repair["what"] for repair in read.repairs]  # corners welded


def test_file_names_need_not_be_unicode(mesh, tmp_path):
    path = os.fsdecode(os.fsencode(tmp_path) + b"/\xff.obj")
    nonobtuse.write(path, *mesh)
    assert nonobtuse.read(path).faces.tobytes() == mesh.faces.tobytes()


def test_files_that_cannot_be_used(mesh, tmp_path):
    with pytest.raises(FileNotFoundError):
        nonobtuse.read(tmp_path / "none.obj")
    (tmp_path / "bad.obj").write_text("v 0 0\n")
    with pytest.raises(OSError, match="bad.obj"):
        nonobtuse.read(tmp_path / "bad.obj")
    (tmp_path / "far.obj").write_text("v 0 0 0\nf 1 2 3\n")
    with pytest.raises(nonobtuse.InvalidInput):
        nonobtuse.read(tmp_path / "far.obj")
    with pytest.raises(OSError):
        nonobtuse.write(tmp_path / "no" / "folder.obj", *mesh)
    with pytest.raises(TypeError):
        nonobtuse.read(3.5)


def test_measure_like_the_tool(mesh, result, tool, tmp_path):
    nonobtuse.write(tmp_path / "a.ply", *result.mesh)
    nonobtuse.write(tmp_path / "b.ply", *mesh)
    run = subprocess.run(
        [tool, "measure", tmp_path / "a.ply", "--against", tmp_path / "b.ply", "--json"],
        capture_output=True, text=True, check=True,
    )  # fmt: skip
    theirs = json.loads(run.stdout)
    ours = nonobtuse.measure(*result.mesh, against=mesh)
    assert json.loads(ours.to_json()) == ours
    for key in ours:
        assert ours[key] == theirs[key]
    assert set(theirs) - set(ours) == {"command", "input", "against", "repairs"}


def test_measure_knows_a_shifted_copy():
    vertices, faces = icosahedron()
    report = nonobtuse.measure(vertices + [0.25, 0, 0], faces, against=(vertices, faces))
    assert 0 < report["distance"]["rms"] <= report["distance"]["hausdorff"] <= 0.25
    assert report["topology"]["euler_characteristic"] == 2
    assert report["angles"]["min_angle"] == pytest.approx(60)
    assert "distance" not in nonobtuse.measure(vertices, faces)


def test_certify_decides_exactly():
    right = [[0, 0, 0], [1, 0, 0], [0, 1, 0]]
    certificate = nonobtuse.certify(right, [[0, 1, 2]])
    assert not certificate and certificate.too_large.tolist() == [0]
    right[2][0] = np.nextafter(0, 1)  # a last bit below 90 degrees
    assert nonobtuse.certify(right, [[0, 1, 2]])
    assert not nonobtuse.certify(right, [[0, 1, 2]], min_angle=50)
    assert "certified" in repr(nonobtuse.certify(*icosahedron()))
    with pytest.raises(nonobtuse.InvalidInput):
        nonobtuse.certify(right, [[0, 1, 2]], min_angle=80)


def test_clean_reports_what_it_did():
    vertices, faces = icosahedron()
    assert nonobtuse.clean(vertices, faces).repairs == []
    faces[3] = faces[3, ::-1]
    cleaned = nonobtuse.clean(np.concatenate([vertices, [[5, 5, 5]]]), faces)
    assert sorted(repair["count"] for repair in cleaned.repairs) == [1, 1]
    assert len(cleaned.vertices) == 12


def test_clean_lists_edges_of_three_faces_as_kept():
    vertices = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1], [0, -1, 0]]
    faces = [[0, 1, 2], [0, 1, 3], [0, 1, 4]]
    cleaned = nonobtuse.clean(vertices, faces)
    assert sorted(map(sorted, cleaned[1].tolist())) == faces
    assert any("three" in repair["what"] for repair in cleaned.repairs), cleaned.repairs


def test_sample_is_closed_and_of_genus_3(mesh):
    assert nonobtuse.measure(*mesh)["topology"]["euler_characteristic"] == -4
    with pytest.raises(nonobtuse.InvalidInput):
        nonobtuse.sample(3)


def test_attributes_are_read_carried_over_and_written(mesh, tmp_path):
    vertices, faces = mesh
    low, high = vertices.min(axis=0), vertices.max(axis=0)
    colors = np.hstack([(vertices - low) / (high - low), np.ones((len(vertices), 1))])
    labels = (vertices[faces].mean(axis=1)[:, 0] > 0).astype(int)
    given = nonobtuse.Attributes(colors=colors, labels=labels, label_names=["left", "right"])
    nonobtuse.write(tmp_path / "in.obj", *mesh, attributes=given)
    read = nonobtuse.read(tmp_path / "in.obj")
    np.testing.assert_allclose(read.attributes.colors, colors, atol=1e-15)
    assert [read.attributes.label_names[i] for i in read.attributes.labels] == [
        given.label_names[i] for i in labels
    ]
    result = nonobtuse.remesh(*read, vertices=700, attributes=read.attributes)
    carried = result.attributes
    np.testing.assert_allclose(carried.colors[:, :3], result.transfer(colors[:, :3]), atol=1e-12)
    assert len(carried.labels) == len(result.faces)
    assert result.mesh.attributes is carried
    borders = nonobtuse.attribute_borders(*result.mesh, carried)
    assert borders.shape[1] == 2 and len(borders) > 0
    assert nonobtuse.remesh(*mesh, vertices=700).attributes is None
    with pytest.raises(nonobtuse.InvalidInput):
        nonobtuse.write(
            tmp_path / "bad.obj", *mesh, attributes=nonobtuse.Attributes(labels=labels[1:])
        )


def test_the_distance_can_be_bounded(mesh):
    result = nonobtuse.remesh(*mesh, vertices=700, max_error="1%")
    distance = nonobtuse.measure(*result.mesh, against=mesh)["distance"]
    assert result.report["max_error"] == distance["hausdorff"] <= 0.01 * distance["diagonal"]


def test_the_history_of_a_method_of_the_paper(mesh):
    result = nonobtuse.remesh(
        *mesh, vertices=300, method="cvt-fs", normal_weight=3, iterations=3, history=True
    )
    seen = [(r["stage"], r["iteration"]) for r in result.report["history"]]
    assert seen == [(stage, k) for stage in ("cvt", "feature-sensitive") for k in range(4)]
