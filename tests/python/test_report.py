"""The report of a call: its data, the page that shows it, and both against the tool's."""

import base64
import json
import pickle
import re
import subprocess

import numpy as np
import pytest
from conftest import ROOT

import nonobtuse


@pytest.fixture(scope="module")
def recorded(mesh):
    return nonobtuse.remesh(*mesh, vertices=700, history=True)


def data_of(page):
    match = re.search(r'<script type="application/json" id="report">(.*?)</script>', page, re.S)
    return json.loads(match[1])


def unpacked(array):
    little = {"float32": "<f4", "uint16": "<u2", "uint32": "<u4"}[array["type"]]
    return np.frombuffer(base64.b64decode(array["base64"]), little).reshape(array["shape"])


def test_the_data_are_the_meshes_and_figures(mesh, recorded, tmp_path):
    recorded.report.save(tmp_path / "r.json")
    data = json.loads((tmp_path / "r.json").read_text())
    assert {key: data[key] for key in ("before", "after", "options", "status")} == {
        key: recorded.report[key] for key in ("before", "after", "options", "status")
    }
    for name, (vertices, faces), other in (
        ("before", mesh, recorded.mesh),
        ("after", recorded.mesh, mesh),
    ):
        packed = data["meshes"][name]
        np.testing.assert_array_equal(unpacked(packed["triangles"]), faces)
        np.testing.assert_allclose(
            unpacked(packed["vertices"]) + packed["origin"], vertices, atol=1e-7
        )
        np.testing.assert_allclose(
            unpacked(packed["distance"]),
            nonobtuse.vertex_distances(vertices, faces, against=other),
            rtol=1e-6,
        )
    stages = {record["stage"] for record in data["history"]}
    assert {"cvt", "refinement"} <= stages
    assert data["distance"]["hausdorff"] > 0
    assert data["after_topology"]["euler_characteristic"] == -4


def test_the_page_holds_the_same_and_asks_for_nothing(recorded, tmp_path):
    page = recorded.report.to_html()
    recorded.report.save(tmp_path / "r.html")
    recorded.report.save(tmp_path / "r.json")
    assert (tmp_path / "r.html").read_text() == page
    assert data_of(page) == json.loads((tmp_path / "r.json").read_text())
    assert page.isascii()
    assert sorted(path.name for path in tmp_path.iterdir()) == ["r.html", "r.json"]
    # No file but this one: nothing is linked, and addresses are those of licences and namespaces.
    assert not re.search(r"<(?:link|script|img)[^>]*(?:src|href)=(?!.?data:)", page)
    assert not re.search(r"@import|url\((?!.?data:)", page)


def test_twenty_thousand_triangles_stay_below_three_megabytes():
    vertices, faces = nonobtuse.sample(40)
    assert len(faces) > 18000
    result = nonobtuse.remesh(vertices, faces, vertices=10000, method="cvt", iterations=1)
    assert len(result.faces) > 20000
    assert len(result.report.to_html()) < 3_000_000


def test_like_the_tool(mesh, tool, tmp_path):
    nonobtuse.write(tmp_path / "a.ply", *mesh)
    subprocess.run(
        [tool, tmp_path / "a.ply", "-o", tmp_path / "b.ply", "--vertices", "500",
         "--report", tmp_path / "tool.json", "--quiet"], check=True,
    )  # fmt: skip
    nonobtuse.remesh(*mesh, vertices=500, history=True).report.save(tmp_path / "ours.json")
    theirs, ours = (json.loads((tmp_path / f).read_text()) for f in ("tool.json", "ours.json"))
    assert set(theirs) - set(ours) == {"command", "command_line", "exit_code", "input", "output"}
    assert set(ours) <= set(theirs)
    for key in set(ours) - {"seconds", "stages", "promise", "goal"}:
        assert ours[key] == theirs[key], key
    for key in ("promise", "goal"):
        assert ours[key].keys() == theirs[key].keys()


def test_every_key_is_documented(recorded, tmp_path):
    recorded.report.save(tmp_path / "r.json")
    data = json.loads((tmp_path / "r.json").read_text())
    document = (ROOT / "docs/json.md").read_text()
    section = document[document.index("## The report") :]
    named = set(re.findall(r"`(\w+)`", document))
    assert set(data) <= named
    assert set(data["meshes"]["after"]) | set(data["meshes"]["after"]["vertices"]) <= set(
        re.findall(r"`(\w+)`", section)
    )


def test_reports_without_surfaces_say_so(mesh, tmp_path):
    with pytest.raises(TypeError, match="no surfaces"):
        nonobtuse.measure(*mesh).to_html()


def test_other_names_are_refused(recorded, tmp_path):
    with pytest.raises(ValueError, match=r"r\.txt"):
        recorded.report.save(tmp_path / "r.txt")
    with pytest.raises(OSError):
        recorded.report.save(tmp_path / "none" / "r.html")
    assert list(tmp_path.iterdir()) == []


def test_reports_can_be_pickled(recorded):
    again = pickle.loads(pickle.dumps(recorded.report))
    assert again == recorded.report
    assert data_of(again.to_html()) == data_of(recorded.report.to_html())
