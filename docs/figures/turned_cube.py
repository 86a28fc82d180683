"""Draws docs/turned-cube-gvxr.png and docs/turned-cube.png: how far gVXR's lengths through a turned cube are off, and those of Skiagraph, on one
scale. Needs numpy and matplotlib, and an interpreter for each: one that has the wheel of gVXR, and one that has Skiagraph.

Usage: turned_cube.py PYTHON_OF_GVXR PYTHON_OF_SKIAGRAPH FOLDER
"""

import subprocess
import sys
import tempfile
from pathlib import Path

import matplotlib
import numpy as np

matplotlib.use("Agg")
from matplotlib import pyplot  # noqa: E402

MOST = 0.3  # mm, of the scale
SCRIPT = Path(__file__).resolve().parents[2] / "examples/gvxr_differences.py"


def errors(python, name, folder):
    path = folder / f"{name}.npy"
    subprocess.run([python, SCRIPT, name, path], check=True, cwd=folder)
    return np.load(path)


def draw(off, name, side, path):
    rms, share = np.sqrt(np.nanmean(off ** 2)), np.nanmean(np.abs(off[~np.isnan(off)]) > 0.1)
    rows, columns = (np.nonzero(~np.isnan(off).all(axis))[0][[0, -1]] for axis in (1, 0))
    off = off[rows[0] - 4:rows[1] + 5, columns[0] - 4:columns[1] + 5]
    figure = pyplot.figure(figsize=(5.6, 5.2), dpi=100)
    axes = figure.add_axes((0.02, 0.02, 0.8, 0.9))
    shown = axes.imshow(off, "RdBu_r", vmin=-MOST, vmax=MOST, interpolation="nearest")
    axes.set_axis_off()
    axes.set_title(f"{name}: rms {rms:.2g} mm,\n{100 * share:.2g} % above 0.1 mm", fontsize=10, loc=side)
    bar = figure.colorbar(shown, cax=figure.add_axes((0.85, 0.08, 0.03, 0.78)))
    bar.set_label("length less the true one, mm")
    figure.savefig(path, metadata={"Software": None})


def main():
    gvxr, ours, folder = sys.argv[1:4]
    with tempfile.TemporaryDirectory() as work:
        draw(errors(gvxr, "gvxrPython3", Path(work)), "gVXR 2.1.0", "left", Path(folder) / "turned-cube-gvxr.png")
        draw(errors(ours, "skiagraph", Path(work)), "Skiagraph", "right", Path(folder) / "turned-cube.png")


if __name__ == "__main__":
    main()
