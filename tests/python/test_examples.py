"""The scripts of examples/ in a small form: they run, and remeshing helps as they say."""

import runpy
import sys

import pytest
from conftest import ROOT

pytest.importorskip("scipy", reason="scipy is not installed")


def run(name, monkeypatch, *arguments):
    monkeypatch.setattr(sys, "argv", [name, "--size", "16", *map(str, arguments)])
    monkeypatch.syspath_prepend(str(ROOT / "examples"))
    return runpy.run_path(str(ROOT / "examples" / f"{name}.py"))["main"]()


def test_laplacian(monkeypatch, capsys):
    figures = run("laplacian", monkeypatch)
    before, flipped, after = (figures[k] for k in ("input", "intrinsic Delaunay", "remeshed"))
    assert before["negative"] > 0
    # Flips alone are enough for the weights, and do not help the slivers.
    assert flipped["negative"] == after["negative"] == 0
    assert after["smallest"] > 30 > flipped["smallest"]
    assert after["condition"] < 0.2 * min(before["condition"], flipped["condition"])
    assert "intrinsic" in capsys.readouterr().out


def test_geodesics(monkeypatch):
    figures = run("geodesics", monkeypatch)
    assert figures["input"]["negative"] > figures["remeshed"]["negative"] == 0
    assert figures["remeshed"]["largest"] < figures["input"]["largest"] < 0.05
    assert figures["remeshed"]["mean"] < 0.02


def test_poisson(monkeypatch, tmp_path):
    arguments = []
    try:
        import pyvista  # noqa: F401

        arguments = ["--picture", tmp_path / "solution.png"]
    except ImportError:
        pass
    figures = run("poisson", monkeypatch, *arguments)
    assert figures["remeshed"]["l2"] < figures["input"]["l2"]
    assert figures["remeshed"]["steps"] < figures["input"]["steps"]
    assert figures["remeshed"]["least"] > -1e-12 > figures["input"]["least"]
    assert not arguments or arguments[1].stat().st_size > 10_000
