"""Draws docs/scan-artefacts.png: a sinogram, and slices of three volumes. Needs numpy and Pillow.

Usage: scan.py SKIAGRAPH OUT.png
"""

import json
import math
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
from PIL import Image, ImageDraw

SIDE, MOVE_MM = 200, 6
UPRIGHT = ["Rotation", 90, 1, 0, 0]


def rod(label, x, y, radius, material):
    return {"Label": label, "Cylinder": [90, 110, radius, "mm"], "Material": material,
            "Transform": [["Translation", x, y, 0, "mm"], UPRIGHT]}


def scene(mono=True, moves=False):
    """A cylinder of water with two rods of titanium and a hole."""
    beam = [{"Energy": 60, "Unit": "keV", "PhotonCount": 1}] if mono else {"kVp": 100, "Filter": [["Al", 2.5, "mm"]]}
    left = rod("rod left", -18, 4, 7, "Ti")
    if moves:
        del left["Transform"]
        left["Poses"] = [[1, 0, 0, 0, 0, 0, 1, 0, 0, -1, 0, 0, -18, 4 + MOVE_MM * math.sin(2 * math.pi * k / 90), 0, 1]
                         for k in range(360)]
    return {
        "Source": {"Position": [0, -400, 0, "mm"], "Shape": "Point", "Beam": beam},
        "Detector": {"Position": [0, 200, 0, "mm"], "UpVector": [0, 0, -1], "NumberOfPixels": [256, 5],
                     "Spacing": [0.7, 0.7, "mm"]},
        "Samples": [{"Label": "body", "Cylinder": [180, 120, 40, "mm"], "Transform": [UPRIGHT], "Type": "outer",
                     "Material": "Water, liquid"},
                    left, rod("rod right", 18, 4, 7, "Ti"), rod("hole", 0, -20, 6, ["mu", 0])],
        "Scan": {"NumberOfProjections": 360, "FinalAngle": 360, "CentreOfRotation": [0, 0, 0, "mm"]},
    }


def last(path, shape):
    count = int(np.prod(shape))
    return np.frombuffer(path.read_bytes()[-4 * count:], "<f4").reshape(shape)


def run(program, folder, name, **how):
    (folder / "scene.json").write_text(json.dumps(scene(**how)))

    def call(*words):
        subprocess.run([program, *words, "--quiet"], cwd=folder, check=True)

    call("scan", "scene.json", "-o", f"{name}.h5")
    call("reconstruct", f"{name}.h5", "-o", f"{name}.mha", "--size", str(SIDE), "--voxel", "0.5", "--filter", "hann")
    return last(folder / f"{name}.mha", (SIDE, SIDE, SIDE))[SIDE // 2]


def shown(values, high):
    grey = np.clip(values / high, 0, 1) * 255
    return Image.fromarray(grey.astype("uint8")).resize((250, 250))


def main(program, out):
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        slices = [run(program, folder, "mono"), run(program, folder, "poly", mono=False),
                  run(program, folder, "moves", moves=True)]
        (folder / "scene.json").write_text(json.dumps(scene()))
        subprocess.run([program, "scan", "scene.json", "-o", "rows.mha", "--quantity", "attenuation", "--quiet"],
                       cwd=folder, check=True)
        sinogram = last(folder / "rows.mha", (360, 5, 256))[:, 2]
    for title, one in zip(("60 keV", "100 kV", "moves"), slices):
        # Between the rods, and in water far from them (1/cm).
        print(f"{title}: between the rods {one[94:106, 95:105].mean():.4f}, above {one[160:168, 96:104].mean():.4f}")
    picture = Image.new("L", (1060, 290), 255)
    draw = ImageDraw.Draw(picture)
    titles = ["sinogram, 60 keV", "60 keV", "100 kV", f"60 keV, left rod moves {MOVE_MM} mm"]
    images = [shown(sinogram, sinogram.max())] + [shown(one, 0.5) for one in slices]
    for k, (title, image) in enumerate(zip(titles, images)):
        picture.paste(image, (15 + 260 * k, 30))
        draw.text((20 + 260 * k, 12), title, fill=0)
    picture.save(out)


if __name__ == "__main__":
    main(*sys.argv[1:])
