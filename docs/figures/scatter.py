"""Draws docs/scatter.png: a thorax without and with an anti-scatter grid: primary, scatter, all photons. Needs numpy and Pillow.

Usage: scatter.py SKIAGRAPH OUT.png
"""

import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
from PIL import Image, ImageDraw

GRID = '{"Ratio": 10, "LinesPerCm": 40, "StripThickness": [0.05, "mm"], "Interspace": "Al", "FocusDistance": [1000, "mm"]}'
MARGIN, TITLE = 6, 24


def read(path):
    data = path.read_bytes()
    header, _, pixels = data.partition(b"ElementDataFile = LOCAL\n")
    sizes = next(line for line in header.decode().splitlines() if line.startswith("DimSize"))
    columns, rows = [int(n) for n in sizes.split("=")[1].split()[:2]]
    return np.frombuffer(pixels, "<f4")[: rows * columns].reshape(rows, columns)


def images(skiagraph, folder, grid):
    scene, outputs = folder / "thorax.json", {name: folder / f"{name}.mha" for name in ("total", "scatter")}
    words = ["--set", f"Detector.Grid={GRID}"] if grid else []
    subprocess.run([skiagraph, "image", scene, "--quiet", "--scatter", "0.01", "-o", outputs["total"], "--scatter-image",
                    outputs["scatter"], *words], check=True)
    total, scatter = read(outputs["total"]), read(outputs["scatter"])
    return {"primary": total - scatter, "scatter": scatter, "all photons": total}


def shade(values, low, high):
    grey = np.clip((np.log(np.maximum(values, 1e-30)) - low) / (high - low), 0, 1)
    return Image.fromarray((255 * (1 - grey)).astype(np.uint8))


def main(skiagraph, out):
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        subprocess.run([skiagraph, "thorax", "--quiet", "-o", folder], check=True)
        rows = [images(skiagraph, folder, grid) for grid in (False, True)]
    side = 256
    picture = Image.new("L", (3 * side + 4 * MARGIN, 2 * (side + TITLE) + 3 * MARGIN), 255)
    draw = ImageDraw.Draw(picture)
    for r, row in enumerate(rows):
        low, high = np.log(np.percentile(row["primary"], 1)), np.log(np.percentile(row["all photons"], 99))
        middle = slice(row["primary"].shape[0] // 3, None)
        print(("with a grid: " if r else "without: ") +
              f"scatter over primary {row['scatter'].sum() / row['primary'].sum():.3f}, "
              f"median {np.median(row['scatter'] / row['primary']):.2f}, "
              f"most {np.max((row['scatter'] / row['primary'])[middle]):.1f}")
        for c, (title, values) in enumerate(row.items()):
            x, y = MARGIN + c * (side + MARGIN), MARGIN + r * (side + TITLE + MARGIN)
            draw.text((x, y + 6), title + (", with a grid 10:1" if r else ""), fill=0)
            picture.paste(shade(values, low, high).resize((side, side), Image.BILINEAR), (x, y + TITLE))
    picture.save(out, optimize=True)


main(*sys.argv[1:])
