"""The package as it is installed: what it links and imports, its types, leaks, the README."""

import importlib.util
import pathlib
import re
import resource
import shutil
import subprocess
import sys

import numpy as np
import pytest
from conftest import ROOT

import nonobtuse


def run_python(code, *arguments, **options):
    return subprocess.run(
        [sys.executable, *arguments, "-c", code],
        capture_output=True, text=True, check=True, **options,
    )  # fmt: skip


def test_the_version_is_the_librarys():
    header = (ROOT / "include/nonobtuse/version.h").read_text()
    assert f'NONOBTUSE_VERSION "{nonobtuse.__version__}"' in header
    from importlib.metadata import version

    assert version("nonobtuse") == nonobtuse.__version__


def test_nothing_heavy_is_imported():
    code = (
        "import numpy, sys; before = set(sys.modules); import nonobtuse;"
        "print(*sorted(m for m in set(sys.modules) - before if not m.startswith('nonobtuse')))"
    )
    assert set(run_python(code).stdout.split()) <= {"__future__", "atexit"}


def test_nothing_is_left_at_exit():
    code = (
        "import nonobtuse\n"
        "m = nonobtuse.sample(16)\n"
        "try: nonobtuse.remesh(*m, vertices=3, progress=lambda *a: None)\n"
        "except nonobtuse.InvalidInput as e: kept = e\n"
        "r = nonobtuse.remesh(*m, vertices=300, method='cvt', progress=lambda *a: None)\n"
    )
    run = run_python(code)
    assert run.stdout == run.stderr == ""  # the binding reports leaked objects there


def test_memory_comes_back(mesh):
    site_count = 50

    def once():
        nonobtuse.certify(*mesh)
        nonobtuse.clean(*mesh)
        nonobtuse.restricted_voronoi(*mesh, mesh.vertices[:site_count])
        with pytest.raises(nonobtuse.InvalidInput):
            nonobtuse.certify(mesh.vertices, mesh.faces + 1)

    for _ in range(20):
        once()
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    rounds = 100
    for _ in range(rounds):
        once()
    grown = 1024 * (resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before)
    assert grown < 0.25 * rounds * (mesh.vertices.nbytes + mesh.faces.nbytes)


def test_results_own_their_memory(mesh):
    faces = nonobtuse.clean(*mesh).faces  # the rest of the mesh is gone
    expected = faces.copy()
    for _ in range(10):
        nonobtuse.clean(*mesh)
    np.testing.assert_array_equal(faces, expected)
    faces[:] = 0  # writable, and nobody else's
    assert nonobtuse.certify(*mesh).triangles == len(mesh.faces)


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="reads an ELF file")
def test_links_nothing_but_the_c_and_cpp_libraries():
    if shutil.which("readelf") is None:
        pytest.skip("readelf is not installed")
    module = importlib.util.find_spec("nonobtuse._core").origin
    text = subprocess.run(
        ["readelf", "-d", module], capture_output=True, text=True, check=True
    ).stdout
    needed = re.findall(r"\(NEEDED\).*\[(.*?)\.so", text)
    assert set(needed) <= {"libstdc++", "libgcc_s", "libc", "libm", "libpthread", "ld-linux-x86-64",
                           "ld-linux-aarch64"}  # fmt: skip
    assert "libstdc++" in needed


def test_stubs_and_types(tmp_path):
    pytest.importorskip("mypy", reason="mypy is not installed")
    package = pathlib.Path(nonobtuse.__file__).parent
    assert (package / "py.typed").exists()
    (tmp_path / "use.py").write_text(
        "import numpy as np\n"
        "import nonobtuse\n"
        "V, F = nonobtuse.read('a.obj')\n"
        "r = nonobtuse.remesh(V, F.tolist(), vertices=8, progress=lambda s, f, m: f < 0.5)\n"
        "nonobtuse.write('b.obj', *r.mesh)\n"
        "try:\n    nonobtuse.remesh(V, F, method='cvt', edge_length='1%')\n"
        "except nonobtuse.Cancelled as e:\n    reveal_type(e.result.faces)\n"
        "nonobtuse.remesh(V, F, vertices='eight')  # wrong\n"
        "nonobtuse.remesh(V, F, method='magic')  # wrong\n"
        "reveal_type(nonobtuse.cvt_energy(V, F, V).gradient)\n"
    )
    check = [sys.executable, "-m", "mypy", "--strict", "--cache-dir", tmp_path / "cache"]
    run = subprocess.run(
        [*check, "-p", "nonobtuse"], capture_output=True, text=True, check=False, cwd=tmp_path
    )
    assert run.returncode == 0, run.stdout
    run = subprocess.run(
        [*check, "use.py"], capture_output=True, text=True, check=False, cwd=tmp_path
    )
    assert re.findall(r"use.py:(\d+): error", run.stdout) == ["10", "11"], run.stdout
    revealed = r"use.py:(?:9|12): note: .*ndarray\[.*(?:signedinteger|float)"
    assert len(re.findall(revealed, run.stdout)) == 2, run.stdout


def test_the_stub_names_what_the_module_has():
    stub = (pathlib.Path(nonobtuse.__file__).parent / "_core.pyi").read_text()
    from nonobtuse import _core

    named = set(re.findall(r"^def (\w+)", stub, re.M))
    assert named == {n for n in dir(_core) if callable(getattr(_core, n)) and n[0] != "_"}


def test_the_readme_example_runs_as_printed(tmp_path):
    readme = (ROOT / "README.md").read_text()
    blocks = re.findall(r"```python\n(.*?)```", readme, re.S)
    assert blocks and "nonobtuse.remesh(" in blocks[0]
    printed = re.findall(r"print\(.*?\) +# (.*)", blocks[0])
    run = run_python(blocks[0], "-W", "error", cwd=tmp_path)
    assert run.stdout.splitlines() == printed
    assert run.stderr == ""
    assert (tmp_path / "out.obj").exists()


def test_trimesh_in_one_line(mesh):
    trimesh = pytest.importorskip("trimesh", reason="trimesh is not installed")
    given = trimesh.Trimesh(*mesh, process=False)
    result = nonobtuse.remesh(given.vertices, given.faces, vertices=700)
    back = trimesh.Trimesh(*result.mesh, process=False)
    assert back.is_watertight and back.euler_number == -4


def test_meshio_in_one_line(mesh, tmp_path):
    meshio = pytest.importorskip("meshio", reason="meshio is not installed")
    meshio.Mesh(mesh.vertices, [("triangle", mesh.faces)]).write(tmp_path / "a.vtk")
    given = meshio.read(tmp_path / "a.vtk")
    result = nonobtuse.remesh(given.points, given.cells_dict["triangle"], vertices=700)
    meshio.Mesh(result.vertices, [("triangle", result.faces)]).write(tmp_path / "b.off")
    assert nonobtuse.read(tmp_path / "b.off").faces.tobytes() == result.faces.tobytes()


def test_pyvista_in_one_line(mesh):
    pyvista = pytest.importorskip("pyvista", reason="pyvista is not installed")
    given = pyvista.PolyData.from_regular_faces(*mesh)
    result = nonobtuse.remesh(given.points, given.regular_faces, vertices=700)
    back = pyvista.PolyData.from_regular_faces(*result.mesh)
    assert back.is_manifold and back.n_points == 700
