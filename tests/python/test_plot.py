"""Pictures: drawn off-screen, looked at pixel by pixel."""

import numpy as np
import pytest

import nonobtuse

pytest.importorskip("pyvista", reason="pyvista is not installed")
image = pytest.importorskip("PIL.Image", reason="pillow is not installed")

PINK, BLUE = (226, 74, 141), (58, 120, 220)


def drawn(path, *meshes, **options):
    nonobtuse.plot(*meshes, path=path, size=(300, 300), **options)
    return np.asarray(image.open(path).convert("RGB")).astype(float)


def share(picture, color):
    """Of the pixels that are neither white nor grey, those with the hue of `color`."""

    def hue(rgb):
        spread = rgb - rgb.min(axis=-1, keepdims=True)
        return spread / np.maximum(spread.max(axis=-1, keepdims=True), 1e-9)

    colored = np.ptp(picture, axis=-1) > 60
    near = np.abs(hue(picture) - hue(np.array(color, float))).max(axis=-1) < 0.25
    return (near & colored).sum() / picture[..., 0].size


def test_bad_triangles_are_pink_and_blue_and_good_ones_are_not(mesh, result, tmp_path):
    before = drawn(tmp_path / "a.png", mesh, edges=False)
    after = drawn(tmp_path / "b.png", result, edges=False)
    assert before.shape == after.shape == (300, 300, 3)
    assert share(before, PINK) > 0.05
    assert share(after, PINK) == share(after, BLUE) == 0
    assert (after.min(axis=-1) < 250).mean() > 0.2  # but there is a surface


@pytest.mark.parametrize("color", ["valence", "sizing", "cells", "plain"])
def test_every_way_of_colouring_draws(mesh, result, color, tmp_path):
    picture = drawn(tmp_path / "a.png", mesh, result, color=color)
    assert picture.shape == (300, 600, 3)
    for half in (picture[:, :300], picture[:, 300:]):
        assert (half.min(axis=-1) < 250).mean() > 0.2
    again = drawn(tmp_path / "b.png", mesh, result, color=color)
    assert np.abs(again - picture).max() <= 2


def test_numbers_and_features(result, tmp_path):
    few = drawn(tmp_path / "a.png", result, color=result.vertices[:, 0], edges=False)
    assert np.ptp(few.reshape(-1, 3), axis=0).min() > 60
    pairs = np.concatenate([result.faces[:, :2], result.faces[:, 1:]])
    red = drawn(tmp_path / "b.png", result, color="plain", features=pairs)
    assert share(red, (200, 30, 30)) > 0.02


def test_what_cannot_be_drawn(mesh, result):
    with pytest.raises(nonobtuse.InvalidInput, match="color"):
        nonobtuse.plot(mesh, color="loud", path="x.png")
    with pytest.raises(nonobtuse.InvalidInput, match="one mesh"):
        nonobtuse.plot(mesh, result, color=mesh.vertices[:, 0], path="x.png")
    with pytest.raises(nonobtuse.InvalidInput):
        nonobtuse.plot(path="x.png")
