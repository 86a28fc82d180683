"""Draws docs/volumes.png: the meshes of the generated thorax, and a CT image of it with a needle and two screws, which are meshes.
Needs numpy and Pillow.

Usage: volumes.py SKIAGRAPH OUT.png
"""

import json
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
from PIL import Image, ImageDraw

CELLS, VOXEL, KEV = 224, 1.8, 70
SCREWS = [(22, 60, 40), (-22, 60, 40)]


def run(folder, *words):
    subprocess.run([sys.argv[1], *words, "--quiet"], cwd=folder, check=True)


def scan(folder):
    """A CT image of the thorax at end-expiration, without its needle, by the method of Feldkamp, Davis and Kress."""
    scene = json.loads((folder / "thorax.json").read_text())
    scene.pop("Breathing")
    scene["Samples"] = [s for s in scene["Samples"] if "needle" not in s["Label"]]
    scene["Source"]["Beam"] = [{"Energy": KEV, "Unit": "keV", "PhotonCount": 1}]
    scene["Detector"] = {"Position": [0, 400, -20, "mm"], "UpVector": [0, 0, -1], "RightVector": [1, 0, 0],
                         "NumberOfPixels": [448, 384], "Size": [672, 576, "mm"]}
    scene["Scan"] = {"NumberOfProjections": 360, "FinalAngle": 360, "CentreOfRotation": [0, 0, -20, "mm"]}
    (folder / "scan.json").write_text(json.dumps(scene))
    run(folder, "scan", "scan.json", "-o", "scan.h5")
    run(folder, "reconstruct", "scan.h5", "-o", "mu.mha", "--size", str(CELLS), "--voxel", str(VOXEL))
    whole = (folder / "mu.mha").read_bytes()
    values = np.frombuffer(whole[-4 * CELLS ** 3:], "<f4")
    water = json.loads(subprocess.run([sys.argv[1], "material", "Water", "--energy", str(KEV), "--json"], check=True,
                                      capture_output=True).stdout)["rows"][0]["mu_per_cm"]
    numbers = np.clip(np.rint(1000 * (values / water - 1)), -1000, 3000).astype("<i2")
    header = whole[:-4 * CELLS ** 3].replace(b"MET_FLOAT", b"MET_SHORT")
    (folder / "ct.mha").write_bytes(header + numbers.tobytes())


def draw(folder):
    """Both images with the same source, detector and beam."""
    scene = json.loads((folder / "thorax.json").read_text())
    scene.pop("Breathing")
    needle = next(s for s in scene["Samples"] if s["Label"] == "needle")
    scene["Samples"] = [s for s in scene["Samples"] if "needle" not in s["Label"]]
    (folder / "meshes.json").write_text(json.dumps(scene))
    needle.update(Parent="patient")
    for key in ("Priority", "Through"):
        needle.pop(key, None)
    screws = [{"Label": f"screw {k}", "Cylinder": [48, 45, 3, "mm"], "Material": "weight:Ti90Al6V4", "Density": 4.43,
               "Parent": "patient", "Transform": [["Translation", x, y, z, "mm"], ["Rotation", -12 if x > 0 else 12, 0, 0, 1]]}
              for k, (x, y, z) in enumerate(SCREWS)]
    scene["Samples"] = [{"Label": "patient", "Volume": "ct.mha", "Values": "HU"}, needle, *screws]
    (folder / "volume.json").write_text(json.dumps(scene))
    for name in ("meshes", "volume"):
        run(folder, "image", f"{name}.json", "-o", f"{name}.png", "--quantity", "attenuation", "--range", "0.3:8")


with tempfile.TemporaryDirectory() as name:
    folder = Path(name)
    run(folder, "thorax", "-o", ".")
    scan(folder)
    draw(folder)
    page = Image.new("L", (1032, 536), 255)
    for k, (file, says) in enumerate((("meshes", "113 meshes"), ("volume", "a CT image of them, with a needle and two screws as meshes"))):
        pixels = np.asarray(Image.open(folder / f"{file}.png")).astype(float)
        page.paste(Image.fromarray(np.clip(pixels / 257, 0, 255).astype(np.uint8)), (520 * k, 0))
        ImageDraw.Draw(page).text((520 * k + 4, 518), says, fill=0)
    page.save(sys.argv[2], optimize=True)
