"""Draws every picture of the README and the documents into docs/images; see scripts/pictures."""

import pathlib

import nonobtuse

IMAGES = pathlib.Path(__file__).resolve().parents[1] / "docs" / "images"
SIZE = (600, 540)


def draw(name, *meshes, **options):
    nonobtuse.plot(*meshes, path=IMAGES / f"{name}.png", size=SIZE, **options)
    print(f"docs/images/{name}.png")


def main():
    surface = nonobtuse.sample(40)
    result = nonobtuse.remesh(*surface, vertices=3000)
    draw("sample", surface, result)
    coarse = nonobtuse.remesh(*surface, vertices=1200)
    coarse_sized = nonobtuse.remesh(*surface, vertices=1200, sizing="curvature")
    draw("cells", coarse, coarse_sized, color="cells")
    nonobtuse.remesh(*surface, vertices=3000, history=True).report.save(
        IMAGES.parents[1] / "build" / "report.html"
    )


if __name__ == "__main__":
    main()
