#!/usr/bin/env python3
"""Draws ear-variants.png of docs/algorithms/procedural-bones.md: one section of the made ear of seed
1 for each variant, above it the same section of the plain ear. Needs numpy and ffmpeg.
    docs/images/ear-variants.py            HAPTRIAL=build/haptrial
"""

import gzip
import os
import pathlib
import subprocess
import tempfile

import numpy

HERE = pathlib.Path(__file__).resolve().parent
HAPTRIAL = os.environ.get("HAPTRIAL", str(HERE.parent.parent / "build/haptrial"))
SPACING = 0.5  # [mm]
ENLARGED = 2  # [px] for each voxel
# The variant, the axis that a section is across, and its place: x inwards, y back, z up [mm].
SECTIONS = [
    ("low tegmen", 1, 30.0),
    ("forward sinus", 2, 24.0),
    ("small antrum", 2, 27.2),
    ("dehiscent facial nerve", 1, 22.9),
    ("sclerotic mastoid", 2, 21.0),
]
TILE = (240, 240)  # [px]


def read_nrrd(path):
    """Labels (z, y, x) and the place of the first voxel [mm]."""
    data = path.read_bytes()
    head, body = data.split(b"\n\n", 1)
    fields = dict(line.split(": ", 1) for line in head.decode().splitlines() if ": " in line)
    if fields["encoding"] in ("gzip", "gz"):
        body = gzip.decompress(body)
    parts, x, y, z = (int(n) for n in fields["sizes"].split())
    origin = [float(n) for n in fields["space origin"].strip("()").split(",")]
    voxels = numpy.frombuffer(body, numpy.uint8, parts * x * y * z).reshape(z, y, x, parts)
    return voxels[..., 0], origin


def colours():
    """Grey bone, blue dura and sinus, yellow nerve; all else pale."""
    table = numpy.full((256, 3), 150, numpy.uint8)
    table[0] = (20, 23, 28)
    table[1] = (222, 214, 196)
    table[13] = (80, 100, 200)
    table[10] = (255, 225, 60)
    return table


def section(labels, origin, axis, place):
    """One layer as a picture: up and the front are up, the side of the head is left."""
    layer = int(round((place - origin[axis]) / SPACING))
    plane = labels.take(layer, axis=2 - axis)
    return plane[::-1] if axis != 2 else plane


def tile(plane):
    """The part of 60 mm from the side of the head inwards, enlarged."""
    picture = colours()[plane].repeat(ENLARGED, axis=0).repeat(ENLARGED, axis=1)
    rows, columns = picture.shape[:2]
    full = numpy.zeros((TILE[1], TILE[0], 3), numpy.uint8)
    full[: min(rows, TILE[1]), : min(columns, TILE[0])] = picture[: TILE[1], : TILE[0]]
    return full


def main():
    """Makes the six ears and writes the picture."""
    with tempfile.TemporaryDirectory() as folder:
        ears = {}
        for variant in [""] + [name for name, _, _ in SECTIONS]:
            path = pathlib.Path(folder) / "ear.nrrd"
            extra = ["--variant", variant] if variant else []
            subprocess.run(
                [HAPTRIAL, "bone", "make", "temporal", str(path), "--spacing", str(SPACING)]
                + ["--overwrite"] + extra, check=True, capture_output=True)
            ears[variant] = read_nrrd(path)
        rows = [[tile(section(*ears["" if plain else name], axis, place))
                 for name, axis, place in SECTIONS] for plain in (True, False)]
        picture = numpy.concatenate([numpy.concatenate(row, axis=1) for row in rows], axis=0)
        subprocess.run(
            ["ffmpeg", "-v", "error", "-y", "-f", "rawvideo", "-pix_fmt", "rgb24", "-s",
             f"{picture.shape[1]}x{picture.shape[0]}", "-i", "-", str(HERE / "ear-variants.png")],
            input=picture.tobytes(), check=True)


if __name__ == "__main__":
    main()
