"""Draws docs/counting.png: what detectors that count make of photons of 60 keV by the height of their pulses, and what dead time leaves.
Needs numpy and matplotlib.

Usage: counting.py SKIAGRAPH OUT.png
"""

import json
import math
import subprocess
import sys
import tempfile
from pathlib import Path

import matplotlib
import numpy as np

matplotlib.use("Agg")
from matplotlib import pyplot  # noqa: E402

KEV, LOWEST, HIGHEST, STEP, WINDOWS = 60, 6, 70, 1, 7
CDTE = {"Material": "CdTe", "Thickness": [1, "mm"], "ElectronicNoise": 0.7}
SHARED = {"Bias": 400, "Fluorescence": True}
SENSORS = [
    ("CdTe 1 mm, no charge shared", CDTE, "#999999", ":"),
    ("CdTe, 100 µm pixels", {**CDTE, **SHARED}, "#d95f02", "-"),
    ("CdTe, 100 µm, anti-coincidence", {**CDTE, **SHARED, "AntiCoincidence": True}, "#7570b3", "--"),
    ("Si 1 mm, 100 µm pixels", {"Material": "Si", "Thickness": [1, "mm"], "ElectronicNoise": 0.7, **SHARED}, "#1f6fb4", "-"),
]


def scene(counting):
    return {
        "Source": {"Position": [0, -1000, 0, "mm"], "Shape": "ParallelBeam",
                   "Beam": [{"Energy": KEV, "Unit": "keV", "PhotonCount": 1}]},
        "Detector": {"Position": [0, 0, 0, "mm"], "UpVector": [0, 0, -1], "NumberOfPixels": [3, 3], "Spacing": [0.1, 0.1, "mm"],
                     "Counting": counting},
        "Samples": [{"Label": "aside", "Cuboid": [1, 1, 1, "mm"], "Material": "water", "Transform": [["Translation", 50, -500, 0, "mm"]]}],
    }


def counts(skiagraph, counting, folder):
    """Counts of a photon in each window of the middle pixel."""
    (folder / "scene.json").write_text(json.dumps(scene(counting)))
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


def draw(skiagraph, out):
    figure, (left, right) = pyplot.subplots(1, 2, figsize=(10, 3.8))
    for label, sensor, colour, line in SENSORS:
        kev, found = heights(skiagraph, sensor)
        left.step(kev, found, where="mid", color=colour, linestyle=line, label=label)
    left.set(xlabel="height of the pulse (keV)", ylabel="counts per photon and keV", yscale="log", ylim=(1e-4, 5),
             xlim=(LOWEST, HIGHEST), title="photons of 60 keV")
    left.legend(fontsize=7, loc="upper center")
    pulses = np.linspace(0, 3, 200)
    right.plot(pulses, pulses, color="#999999", linestyle=":", label="every pulse counts")
    right.plot(pulses, pulses / (1 + pulses), color="#1f6fb4", label="nonparalysable")
    right.plot(pulses, [n * math.exp(-n) for n in pulses], color="#d95f02", label="paralysable")
    right.set(xlabel="pulses in a dead time", ylabel="counts in a dead time", ylim=(0, 1), xlim=(0, 3), title="dead time")
    right.legend(fontsize=8)
    figure.tight_layout()
    figure.savefig(out, dpi=110)


if __name__ == "__main__":
    draw(sys.argv[1], sys.argv[2])
