"""Draws docs/counting.png: what detectors that count make of photons of 60 keV by the height of their pulses, what pile-up leaves in windows, and how
sharp windows are. Needs numpy, matplotlib and skiagraph.

Usage: counting.py SKIAGRAPH OUT.png
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

import skiagraph as sk  # noqa: E402

KEV, LOWEST, HIGHEST, STEP, WINDOWS = 60, 6, 70, 1, 7
CDTE = {"Material": "CdTe", "Thickness": [1, "mm"], "ElectronicNoise": 0.7}
SHARED = {"Bias": 400, "Fluorescence": True}
SENSORS = [
    ("CdTe 1 mm, no charge shared", CDTE, "#999999", ":"),
    ("CdTe, 100 µm pixels", {**CDTE, **SHARED}, "#d95f02", "-"),
    ("CdTe, 100 µm, anti-coincidence", {**CDTE, **SHARED, "AntiCoincidence": True}, "#7570b3", "--"),
    ("Si 1 mm, 100 µm pixels", {"Material": "Si", "Thickness": [1, "mm"], "ElectronicNoise": 0.7, **SHARED}, "#1f6fb4", "-"),
]


WINDOWED = {**CDTE, **SHARED, "ElectronicNoise": 1.5, "Thresholds": [12, 30, 50], "DeadTime": 100, "ExposureTime": 1}
PILE_UPS = [("paralysable", "-"), ("nonparalysable", "--")]
COLOURS = ["#1f6fb4", "#d95f02", "#7570b3"]


def scene(counting, photons=1):
    return {
        "Source": {"Position": [0, -1000, 0, "mm"], "Shape": "ParallelBeam",
                   "Beam": [{"Energy": KEV, "Unit": "keV", "PhotonCount": photons}]},
        "Detector": {"Position": [0, 0, 0, "mm"], "UpVector": [0, 0, -1], "NumberOfPixels": [3, 3], "Spacing": [0.1, 0.1, "mm"],
                     "Counting": counting},
        "Samples": [{"Label": "aside", "Cuboid": [1, 1, 1, "mm"], "Material": "water", "Transform": [["Translation", 50, -500, 0, "mm"]]}],
    }


def counts(skiagraph, counting, folder, photons=1):
    """Counts in each window of the middle pixel."""
    (folder / "scene.json").write_text(json.dumps(scene(counting, photons)))
    subprocess.run([skiagraph, "image", folder / "scene.json", "--quiet", "-o", folder / "image.mha"], check=True)
    values = np.frombuffer((folder / "image.mha").read_bytes()[-4 * 9 * len(counting["Thresholds"]):], "<f4")
    return values.reshape(9, -1)[4]  # windows of a pixel lie together


def heights(skiagraph, counting):
    """Counts of a photon for each keV of the pulse."""
    found = []
    with tempfile.TemporaryDirectory() as name:
        for first in np.arange(LOWEST, HIGHEST, WINDOWS * STEP):
            edges = [float(first + k * STEP) for k in range(WINDOWS + 1)]
            found += list(counts(skiagraph, {**counting, "Thresholds": edges}, Path(name))[:WINDOWS] / STEP)
    return LOWEST + STEP * (np.arange(len(found)) + 0.5), np.array(found)


def recorded(skiagraph, kind, pulses):
    """Counts in a dead time in each window, by the number of pulses in it."""
    with tempfile.TemporaryDirectory() as name:
        each = {key: WINDOWED[key] for key in WINDOWED if key not in ("DeadTime", "ExposureTime")}
        of_one = counts(skiagraph, each, Path(name)).sum()
        share = WINDOWED["DeadTime"] * 1e-9 / WINDOWED["ExposureTime"]
        found = [counts(skiagraph, {**WINDOWED, "PileUp": kind}, Path(name), n / share / of_one) for n in pulses]
    return np.array(found) * share


def transfer(pixel_mm, window, cycles, **fields):
    """The modulation transfer function of a window along a row: that of the pixel, times that of the places of its counts."""
    counter = sk.Counter("CdTe", 1, pixel_mm, [12, 50], bias_v=400, fluorescence=True, electronic_kev=0.7, **fields)
    line = counter.spread(KEV, window).sum(axis=0)
    places = np.arange(line.size) - line.size // 2
    shared = (line * np.cos(2 * np.pi * cycles[:, None] * places)).sum(axis=1) / line.sum()
    return np.sinc(cycles) * shared


def draw_transfer(axes):
    cycles = np.linspace(0, 0.5, 51)
    axes.plot(cycles, np.sinc(cycles), color="#999999", linestyle=":", label="the pixel alone")
    for pixel_mm, colour in ((0.055, "#1f6fb4"), (0.1, "#d95f02"), (0.25, "#7570b3")):
        axes.plot(cycles, transfer(pixel_mm, 0, cycles), color=colour, label=f"{1000 * pixel_mm:g} µm, 12 to 50 keV")
        axes.plot(cycles, transfer(pixel_mm, 1, cycles), color=colour, linestyle="--", label=f"{1000 * pixel_mm:g} µm, above 50 keV")
    axes.plot(cycles, transfer(0.1, 0, cycles, anti_coincidence=True), color="#d95f02", linestyle="-.",
              label="100 µm, 12 to 50 keV, anti-coincidence")
    axes.set(xlabel="cycles a pixel", ylabel="modulation transfer function", xlim=(0, 0.5), ylim=(0, 1), title="CdTe 1 mm, 60 keV")
    axes.legend(fontsize=7, loc="lower left")


def draw(skiagraph, out):
    figure, (left, right, last) = pyplot.subplots(1, 3, figsize=(14.5, 3.8))
    draw_transfer(last)
    for label, sensor, colour, line in SENSORS:
        kev, found = heights(skiagraph, sensor)
        left.step(kev, found, where="mid", color=colour, linestyle=line, label=label)
    left.set(xlabel="height of the pulse (keV)", ylabel="counts per photon and keV", yscale="log", ylim=(1e-4, 5),
             xlim=(LOWEST, HIGHEST), title="photons of 60 keV")
    left.legend(fontsize=7, loc="upper center")
    pulses, labels = np.linspace(0.02, 2, 34), ["12 to 30 keV", "30 to 50 keV", "above 50 keV"]
    for kind, line in PILE_UPS:
        found = recorded(skiagraph, kind, pulses)
        for w, colour in enumerate(COLOURS):
            right.plot(pulses, found[:, w], color=colour, linestyle=line, label=f"{labels[w]}, {kind}")
    right.set(xlabel="pulses in a dead time", ylabel="counts in a dead time", xlim=(0, 2), title="CdTe, 100 µm pixels, 60 keV")
    right.legend(fontsize=7)
    figure.tight_layout()
    figure.savefig(out, dpi=110)


if __name__ == "__main__":
    draw(sys.argv[1], sys.argv[2])
