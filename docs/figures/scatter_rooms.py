"""Draws docs/scatter-rooms.svg: scatter along a line of the detector in two rooms with lead, by this version, by an earlier one, and by
photons that see the bodies as they are (tests/scatter/rooms_truth.c). Needs numpy.

Usage: scatter_rooms.py SKIAGRAPH EARLIER OUT.svg      both are commands
"""
import json
import re
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

WIDTH, HEIGHT, LEFT, TOP, GAP = 360, 250, 64, 40, 90
SIDE, PIXELS, BLOCKS = 300, 128, 4


def box(label, x, y, z, a, b, c, material):
    return {"Label": label, "Cuboid": [a, b, c, "mm"], "Material": material, "Parent": None, "Transform": [["Translation", x, y, z, "mm"]]}


WATER = box("water", 0, 0, 0, 300, 300, 200, "Water")
ROOMS = [  # as in tests/scatter/rooms.c: title, kV, plane of the detector, samples, number of the truth
    ("lead 3 mm with a hole of 60 mm, 200 mm before water", 80, 150,
     [WATER, box("a", -115, 0, -301.5, 170, 400, 3, "Pb"), box("b", 115, 0, -301.5, 170, 400, 3, "Pb"),
      box("c", 0, -115, -301.5, 60, 170, 3, "Pb"), box("d", 0, 115, -301.5, 60, 170, 3, "Pb")], 0),
    ("lead 2 mm, 50 mm behind water, before half of the detector", 100, 200, [WATER, box("a", 100, 0, 151, 200, 400, 2, "Pb")], 1),
]


def scene(kev, plane, samples):
    return {"Source": {"Position": [0, 0, -1000, "mm"], "Shape": "PointSource", "Beam": [{"Energy": kev, "Unit": "keV", "PhotonCount": 1e6}]},
            "Detector": {"Position": [0, 0, plane, "mm"], "UpVector": [0, 1, 0], "RightVector": [1, 0, 0], "NumberOfPixels": [PIXELS, PIXELS],
                         "Size": [SIDE, SIDE, "mm"]},
            "Falloff": True, "Scatter": {"Tolerance": 0.01}, "Samples": samples}


def scatter(command, text, folder):
    """Over the open beam on the axis, the mean of the middle half of the rows."""
    path = folder / "room.json"
    path.write_text(json.dumps(text))
    subprocess.run([command, "image", path, "--quiet", "-o", folder / "i.mha", "--scatter-image", folder / "s.mha"], check=True)
    pixels = (folder / "s.mha").read_bytes().partition(b"ElementDataFile = LOCAL\n")[2]
    image = np.frombuffer(pixels, "<f4")[: PIXELS * PIXELS].reshape(PIXELS, PIXELS).astype(float)
    kev = text["Source"]["Beam"][0]["Energy"]
    return image[PIXELS // 4: 3 * PIXELS // 4].mean(axis=0) / (1e6 * kev)


def truth(number):
    text = (Path(__file__).parents[2] / "tests/scatter/rooms_truth.c").read_text()
    lists = [re.findall(rf"\.{name} = \{{([^}}]*)\}}", text)[number] for name in ("scatter", "sigma")]
    values, sigma = (np.array([float(v) for v in its.split(",")]).reshape(BLOCKS, BLOCKS)[1:3] for its in lists)
    return values.mean(axis=0), np.sqrt((sigma ** 2).sum(axis=0)) / 2


def panel(left, title, ours, before, blocks):
    high = 1.08 * max(ours.max(), before.max())
    x = lambda mm: left + WIDTH * (mm / SIDE + 0.5)
    y = lambda v: TOP + HEIGHT * (1 - v / high)
    middles = (np.arange(PIXELS) + 0.5) * SIDE / PIXELS - SIDE / 2
    line = lambda values: " ".join(f"{x(m):.1f},{y(v):.1f}" for m, v in zip(middles, values))
    edges = np.linspace(-SIDE / 2, SIDE / 2, BLOCKS + 1)
    steps = "".join(f'<path d="M{x(a):.1f} {y(v):.1f}H{x(b):.1f}" stroke="#1a1c20" stroke-width="3"/>' for a, b, v in zip(edges, edges[1:], blocks[0]))
    axis = "".join(f'<text x="{x(mm):.0f}" y="{TOP + HEIGHT + 18}">{mm:.0f}</text>' for mm in (-150, -75, 0, 75, 150))
    power = 10 ** np.floor(np.log10(high / 2))
    marks = "".join(f'<path d="M{left} {y(v):.1f}h{WIDTH}" stroke="#ddd"/><text x="{left - 6}" y="{y(v) + 4:.1f}" style="text-anchor:end">{v:g}</text>'
                    for v in np.arange(0, high, power * (2 if high / power > 6 else 1)))
    return (f'<text x="{left + WIDTH / 2}" y="22">{title}</text>{marks}{axis}<rect x="{left}" y="{TOP}" width="{WIDTH}" height="{HEIGHT}" fill="none" stroke="#888"/>'
            f'<polyline points="{line(before)}" stroke="#b34700"/><polyline points="{line(ours)}" stroke="#0072b2" stroke-width="2"/>{steps}'
            f'<text x="{left + WIDTH / 2}" y="{TOP + HEIGHT + 38}">mm along the detector</text>')


def main(skiagraph, earlier, out):
    panels = []
    with tempfile.TemporaryDirectory() as folder:
        for k, (title, kev, plane, samples, number) in enumerate(ROOMS):
            text = scene(kev, plane, samples)
            ours, before, blocks = scatter(skiagraph, text, Path(folder)), scatter(earlier, text, Path(folder)), truth(number)
            for name, values in (("this version", ours), ("earlier", before)):
                off = values.reshape(BLOCKS, -1).mean(axis=1) / blocks[0] - 1
                print(title, name, "of blocks, %:", np.round(100 * off, 1), "truth +-", np.round(100 * blocks[1] / blocks[0], 1))
            panels.append(panel(LEFT + k * (WIDTH + GAP), title, ours, before, blocks))
    width = LEFT + 2 * WIDTH + GAP + 20
    key = "".join(f'<path d="M{LEFT + 20 + 240 * k} {TOP + HEIGHT + 60}h30" stroke="{colour}" stroke-width="3"/>'
                  f'<text x="{LEFT + 58 + 240 * k}" y="{TOP + HEIGHT + 64}" style="text-anchor:start">{name}</text>'
                  for k, (colour, name) in enumerate((("#0072b2", "now"), ("#b34700", "cells of one mixture"), ("#1a1c20", "truth, of blocks"))))
    Path(out).write_text(f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {TOP + HEIGHT + 80}" font-family="sans-serif" font-size="13">'
                         "<style>text{text-anchor:middle;fill:#1a1c20}polyline,path{fill:none}</style>"
                         f'<rect width="{width}" height="{TOP + HEIGHT + 80}" fill="#fff"/>' + "\n".join(panels) + key + "</svg>\n")


if __name__ == "__main__":
    if len(sys.argv) != 4:
        sys.exit(__doc__)
    main(*sys.argv[1:])
