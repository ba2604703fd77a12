"""Progress, cancellation and Ctrl-C."""

import os
import signal
import subprocess
import sys
import threading
import time

import numpy as np
import pytest

import nonobtuse
from nonobtuse import Status


@pytest.fixture(scope="module")
def big():
    """Long enough at work to be interrupted in the middle."""
    return nonobtuse.sample(48)


def test_progress_is_told_in_order(mesh):
    heard = []
    nonobtuse.remesh(*mesh, vertices=700, progress=lambda *event: heard.append(event))
    stages, fractions, messages = zip(*heard, strict=True)
    assert stages[0] == "cvt" and "certification" in stages
    assert list(fractions) == sorted(fractions) and 0 <= fractions[0] and fractions[-1] <= 1
    assert all(isinstance(message, str) for message in messages)


@pytest.mark.parametrize("answer", [False, np.False_])
@pytest.mark.parametrize("at", [0.0, 0.45, 0.6])
def test_false_cancels(mesh, answer, at):
    result = nonobtuse.remesh(
        *mesh, vertices=700, progress=lambda s, fraction, m: answer if fraction >= at else None
    )
    assert result.status is Status.CANCELLED
    assert result.report["status"] == "cancelled"
    if len(result.faces):
        assert len(result.vertices) == 700
        assert nonobtuse.measure(*result.mesh)["topology"]["nonmanifold_edges"] == 0


@pytest.mark.parametrize("answer", [None, 0, "", True, 1])
def test_other_answers_do_not(mesh, result, answer):
    other = nonobtuse.remesh(*mesh, vertices=700, progress=lambda *_: answer)
    assert other.status is result.status
    assert other.vertices.tobytes() == result.vertices.tobytes()


def test_an_exception_of_the_callback_comes_out(big):
    calls = []

    def callback(stage, fraction, message):
        calls.append(stage)
        if fraction > 0.1:
            raise LookupError("mine")

    with pytest.raises(LookupError, match="mine"):
        nonobtuse.remesh(*big, vertices=4000, progress=callback)
    assert "refinement" not in calls


@pytest.mark.parametrize("with_callback", [False, True])
def test_ctrl_c_gives_the_best_mesh_so_far(big, with_callback):
    def interrupt():
        time.sleep(0.3)
        os.kill(os.getpid(), signal.SIGINT)

    # A shell starts background jobs with SIGINT ignored, and Python then leaves it so.
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    thread = threading.Thread(target=interrupt)
    thread.start()
    progress = (lambda *_: None) if with_callback else None
    try:
        with pytest.raises(nonobtuse.Cancelled) as info:
            nonobtuse.remesh(*big, vertices=40000, progress=progress)
    finally:
        thread.join()
        signal.signal(signal.SIGINT, before)
    assert isinstance(info.value, KeyboardInterrupt)
    assert isinstance(info.value.__cause__, KeyboardInterrupt)
    result = info.value.result
    assert result.status is Status.CANCELLED
    if len(result.faces):
        topology = nonobtuse.measure(*result.mesh)["topology"]
        assert topology["nonmanifold_edges"] == topology["nonmanifold_vertices"] == 0


def test_the_gil_is_free_meanwhile(big):
    counts = []

    def count():
        while not counts or counts[-1] >= 0:
            counts.append(len(counts))
            time.sleep(0.001)

    thread = threading.Thread(target=count, daemon=True)
    begun = []

    def progress(stage, fraction, message):
        if not begun:
            begun.append(len(counts))
            thread.start()

    nonobtuse.remesh(*big, vertices=1500, progress=progress)
    during = len(counts)
    counts.append(-1)
    thread.join()
    assert during > 20


def test_arrays_are_not_kept(mesh):
    vertices, faces = (np.array(array) for array in mesh)
    before = sys.getrefcount(vertices), sys.getrefcount(faces)
    callback = lambda *_: None
    callback_before = sys.getrefcount(callback)
    for _ in range(3):
        nonobtuse.remesh(vertices, faces, vertices=300, method="cvt", progress=callback)
        with pytest.raises(nonobtuse.InvalidInput):
            nonobtuse.remesh(vertices, faces, vertices=3, progress=callback)
    assert (sys.getrefcount(vertices), sys.getrefcount(faces)) == before
    assert sys.getrefcount(callback) == callback_before


def test_the_interpreter_may_end_while_a_thread_remeshes():
    script = (
        "import nonobtuse, threading, time\n"
        "V, F = nonobtuse.sample(48)\n"
        "def work():\n"
        "    nonobtuse.remesh(V, F, vertices=8000)\n"
        "threading.Thread(target=work, daemon=True).start()\n"
        "time.sleep(0.3)\n"
    )
    ended = subprocess.run([sys.executable, "-c", script], capture_output=True, timeout=60)
    assert (ended.returncode, ended.stderr) == (0, b"")
