"""Draws docs/scatter-profile.png: scatter behind 20 cm of water beside EGSnrc, along a line of the detector, with the band of both errors.
Needs numpy and matplotlib, and the Monte Carlo images w0 and w1 that docs/validation.md names.

Usage: scatter_profile.py SKIAGRAPH MONTECARLO OUT.png
"""

import json
import subprocess
import sys
import tempfile
from pathlib import Path

import matplotlib
import numpy as np

matplotlib.use("Agg")
from matplotlib import pyplot  # noqa: E402

SIDE, PITCH = 32, 9.375
LINES = slice(12, 20)  # rows of the profile, whose mean is shown
DENSITY = 0.20554967 / 0.2059  # that gives water the attenuation of the simulation (NIST: 0.2059 per cm)
ORANGE, BLUE = "#d95f02", "#1f6fb4"


def scene(plane):
    return {
        "Source": {"Position": [0, -900, 0, "mm"], "Shape": "PointSource", "Beam": [{"Energy": 60, "Unit": "keV", "PhotonCount": 1e6}]},
        "Detector": {"Position": [0, plane, 0, "mm"], "UpVector": [0, 0, -1], "NumberOfPixels": [SIDE, SIDE],
                     "Size": [SIDE * PITCH, SIDE * PITCH, "mm"]},
        "Falloff": True,
        "Samples": [{"Label": "water", "Cuboid": [300, 200, 300, "mm"], "Material": "water", "Density": DENSITY}],
    }


def read(path):
    pixels = path.read_bytes().partition(b"ElementDataFile = LOCAL\n")[2]
    return np.frombuffer(pixels, "<f4")[: SIDE * SIDE].reshape(SIDE, SIDE).astype(float)


def simulated(skiagraph, plane):
    """Scatter and standard error, over the open beam at the foot of the perpendicular."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "scene.json").write_text(json.dumps(scene(plane)))
        subprocess.run([skiagraph, "image", folder / "scene.json", "--quiet", "--scatter", "0.005", "-o", folder / "t.mha",
                        "--scatter-image", folder / "s.mha", "--scatter-sigma", folder / "e.mha"], check=True)
        return read(folder / "s.mha") / 6e7, read(folder / "e.mha") / 6e7


def reference(folder, name):
    images = {what: np.fromfile(folder / f"{name}_{what}.raw", "<f4").reshape(SIDE, SIDE).astype(float)
              for what in ("open", "scatter", "scatter_sigma")}
    middle = images["open"][SIDE // 2 - 1:SIDE // 2 + 1, SIDE // 2 - 1:SIDE // 2 + 1].mean()
    return images["scatter"] / middle, images["scatter_sigma"] / middle


def draw(axes, title, own, theirs):
    x = (np.arange(SIDE) - (SIDE - 1) / 2) * PITCH / 10
    rows = LINES.stop - LINES.start
    mine, mine_error = own[0][LINES].mean(0), own[1][LINES].mean(0)
    other, other_error = theirs[0][LINES].mean(0), np.sqrt((theirs[1][LINES] ** 2).sum(0)) / rows
    axes[0].fill_between(x, 100 * (mine - 2 * mine_error), 100 * (mine + 2 * mine_error), color=BLUE, alpha=0.3, lw=0)
    axes[0].plot(x, 100 * mine, color=BLUE, label="Skiagraph, 2 standard errors")
    axes[0].errorbar(x, 100 * other, 200 * other_error, color=ORANGE, fmt=".", ms=4, lw=1, label="EGSnrc, 2 standard errors")
    axes[0].set_title(title, fontsize=10)
    axes[0].set_ylim(0, None)
    off, band = 100 * (mine / other - 1), 200 * np.hypot(mine_error, other_error) / other
    axes[1].fill_between(x, -band, band, color="0.85", lw=0, label="2 standard errors of both")
    axes[1].axhline(0, color="0.4", lw=0.8)
    axes[1].plot(x, off, ".-", color=BLUE, ms=4, lw=0.8)
    axes[1].set_ylim(-2.5, 2.5)
    axes[1].set_xlabel("cm across the detector")
    print(f"{title}: profile off by {off.mean():+.2f} % on average, at most {np.abs(off).max():.2f} %; "
          f"{int((np.abs(off) > band).sum())} of {SIDE} pixels beyond 2 standard errors")


def main(skiagraph, montecarlo, out):
    figure, axes = pyplot.subplots(2, 2, figsize=(8.4, 5), sharex=True, height_ratios=(2, 1), constrained_layout=True)
    for column, (name, plane, title) in enumerate((("w1", 300, "20 cm of water, detector 20 cm behind it"),
                                                   ("w0", 100.00001, "20 cm of water, detector on it"))):
        draw(axes[:, column], title, simulated(skiagraph, plane), reference(Path(montecarlo), name))
    axes[0, 0].set_ylabel("scatter, % of the open beam")
    axes[1, 0].set_ylabel("difference, %")
    axes[0, 0].legend(fontsize=8, loc="lower center")
    axes[1, 0].legend(fontsize=8, loc="upper right")
    figure.savefig(out, dpi=110, pil_kwargs={"optimize": True})


main(*sys.argv[1:])
