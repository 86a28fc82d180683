"""Draws docs/four-d.png: the default thorax in a CT scan while it breathes, reconstructed at eight phases, and the height
of the dome under the right lung in the volumes against the meshes that made them. Needs numpy and Pillow, and skiagraph's package.

Usage: four_d.py SKIAGRAPH OUT.png [FOLDER]. FOLDER keeps the scan. Four minutes of a core, nearly all of them for the volumes.
Exit status 1: a height differs by more than 0.5 mm.
"""
import json
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
from PIL import Image, ImageDraw

import skiagraph as sk

PHASES, ANGLES = 8, 120
SIZE, VOXEL = 224, 1.6  # mm
DARK, LIGHT = (16, 20, 26), (232, 236, 240)
GREYS = 24  # noise in more of them makes a large file
BAR_MM = 0.5


def write_scene(folder, program):
    """Projection k is at phase k mod 8 of 8: the angles of each phase are evenly spaced."""
    subprocess.run([program, "thorax", "-o", ".", "--quiet"], cwd=folder, check=True)
    scene = json.loads((folder / "thorax.json").read_text())
    period = 4.0
    scene["Breathing"] = {"Pattern": "quiet", "Period": period, "Reference": 0}
    scene["Source"] = {"Position": [0, -1000, 0, "mm"], "Shape": "PointSource",
                       "Beam": [{"Energy": 60, "Unit": "keV", "PhotonCount": 1}]}
    scene["Detector"] = {"Position": [0, 500, 0, "mm"], "UpVector": [0, 0, -1], "NumberOfPixels": [360, 256],
                         "Spacing": [1.8, 1.8, "mm"]}
    scene["Scan"] = {"NumberOfProjections": PHASES * ANGLES, "FinalAngle": 360, "CentreOfRotation": [0, 0, 0, "mm"],
                     "Interval": period / PHASES}
    (folder / "scan.json").write_text(json.dumps(scene))


def reconstruct(folder, program):
    """The volumes, [phase][z][y][x]."""
    volumes = []
    subprocess.run([program, "scan", "scan.json", "-o", "scan.h5", "--quantity", "attenuation", "--breathing", "--phases",
                    str(PHASES), "--quiet"], cwd=folder, check=True)
    for phase in range(1, PHASES + 1):
        subprocess.run([program, "reconstruct", f"scan.phase-{phase}-of-{PHASES}.h5", "-o", "volume.mha", "--size", str(SIZE),
                        "--voxel", str(VOXEL), "--quiet"], cwd=folder, check=True)
        bytes_ = (folder / "volume.mha").read_bytes()[-4 * SIZE**3:]
        volumes.append(np.frombuffer(bytes_, "<f4").reshape(SIZE, SIZE, SIZE))
    return volumes


def lowest_crossings(vertices, triangles, places):
    """The least z at which the vertical line through each place (x, y) passes the mesh."""
    a, b, c = (vertices[triangles[:, k]] for k in range(3))
    found = np.full(len(places), np.inf)
    for n, (x, y) in enumerate(places):
        area = (b[:, 0] - a[:, 0]) * (c[:, 1] - a[:, 1]) - (b[:, 1] - a[:, 1]) * (c[:, 0] - a[:, 0])
        with np.errstate(divide="ignore", invalid="ignore"):
            v = ((x - a[:, 0]) * (c[:, 1] - a[:, 1]) - (y - a[:, 1]) * (c[:, 0] - a[:, 0])) / area
            w = ((b[:, 0] - a[:, 0]) * (y - a[:, 1]) - (b[:, 1] - a[:, 1]) * (x - a[:, 0])) / area
        inside = (v >= 0) & (w >= 0) & (v + w <= 1)
        heights = a[:, 2] + v * (b[:, 2] - a[:, 2]) + w * (c[:, 2] - a[:, 2])
        found[n] = heights[inside].min(initial=np.inf)
    return found


def edge(profile, near):
    """Where a profile along z falls from the liver's to the lung's value, by the level between them; near: index."""
    below, above = profile[near - 12:near - 4].mean(), profile[near + 5:near + 13].mean()
    level = (below + above) / 2
    for k in range(near - 4, near + 5):
        if profile[k] >= level > profile[k + 1]:
            return k + (profile[k] - level) / (profile[k] - profile[k + 1])
    raise SystemExit(f"no edge near voxel {near}")


def index_of(mm):
    return mm / VOXEL + (SIZE - 1) / 2


def measure(scene, volumes):
    """Heights of the dome, mm, for each phase: in the meshes, in the volume."""
    places, rows = None, []
    for phase, volume in enumerate(volumes):
        scene.breathe(phase=phase / PHASES)
        lung = scene["lung right"].mesh
        vertices = np.asarray(lung.vertices, float)
        if places is None:  # the top of the dome is where the base of the lung is highest
            liver = np.asarray(scene["liver"].mesh.vertices, float)
            top = liver[liver[:, 2].argmax()]
            i, j = (round(index_of(top[k])) for k in range(2))
            columns = [(i + p, j + q) for p in range(-2, 3) for q in range(-2, 3)]
            places = [tuple((k - (SIZE - 1) / 2) * VOXEL for k in column) for column in columns]
        heights = lowest_crossings(vertices, np.asarray(lung.faces), places)
        seen = [(edge(volume[:, q, p], round(index_of(z))) - (SIZE - 1) / 2) * VOXEL for (p, q), z in zip(columns, heights)]
        rows.append((heights.mean(), np.mean(seen)))
    return np.array(rows), places


def panel(volume, row, text, level):
    """A coronal slice, the head on top, with a line at the height of the meshes."""
    grey = np.round(np.clip(volume[::-1, row, :] / 0.35, 0, 1) * (GREYS - 1)) / (GREYS - 1)
    image = Image.fromarray((grey * 255).astype(np.uint8)).convert("RGB")
    draw = ImageDraw.Draw(image)
    y = SIZE - 1 - index_of(level)
    draw.line([(0, y), (22, y)], fill=(255, 196, 64))
    draw.text((5, 4), text, fill=LIGHT)
    return image


def graph(rows, width, height):
    image = Image.new("RGB", (width, height), DARK)
    draw = ImageDraw.Draw(image)
    low, high = rows.min() - 2, rows.max() + 2
    left, right, top, bottom = 60, width - 200, 24, height - 40

    def at(phase, mm):
        return left + phase * (right - left) / (PHASES - 1), bottom - (mm - low) * (bottom - top) / (high - low)

    for mm in range(int(np.ceil(low)), int(high) + 1, 2):
        draw.line([at(0, mm), at(PHASES - 1, mm)], fill=(52, 60, 70))
        draw.text((left - 34, at(0, mm)[1] - 6), f"{mm:4d}", fill=LIGHT)
    draw.line([at(k, rows[k, 0]) for k in range(PHASES)], fill=(255, 196, 64), width=2)
    for k in range(PHASES):
        x, y = at(k, rows[k, 1])
        draw.ellipse([x - 4, y - 4, x + 4, y + 4], outline=(110, 190, 255), width=2)
        draw.text((x - 10, bottom + 8), f"{k / PHASES:.3g}", fill=LIGHT)
    draw.text((left, 4), "height of the dome under the right lung, mm", fill=LIGHT)
    draw.text((left, height - 16), "phase of the breath, 0 at end-inspiration", fill=LIGHT)
    draw.line([(right + 30, 40), (right + 60, 40)], fill=(255, 196, 64), width=2)
    draw.text((right + 68, 34), "meshes", fill=LIGHT)
    draw.ellipse([right + 41, 61, right + 49, 69], outline=(110, 190, 255), width=2)
    draw.text((right + 68, 59), "volumes", fill=LIGHT)
    draw.text((right + 30, 90), f"at most {abs(rows[:, 1] - rows[:, 0]).max():.2f} mm apart", fill=LIGHT)
    return image


def main(program, out, folder):
    folder.mkdir(parents=True, exist_ok=True)
    program = str(Path(program).resolve())
    write_scene(folder, program)
    volumes = reconstruct(folder, program)
    with sk.Scene(folder / "scan.json") as scene:
        rows, places = measure(scene, volumes)
    for phase, (mesh, volume) in enumerate(rows):
        print(f"phase {phase / PHASES:.3f}: {mesh:8.3f} mm in the meshes, {volume:8.3f} mm in the volume, {volume - mesh:+.3f}")
    row = round(index_of(np.mean([y for _, y in places])))
    picture = Image.new("RGB", (4 * (SIZE + 6) + 6, 2 * (SIZE + 6) + 6 + 220), DARK)
    for phase, volume in enumerate(volumes):
        where = (6 + phase % 4 * (SIZE + 6), 6 + phase // 4 * (SIZE + 6))
        picture.paste(panel(volume, row, f"phase {phase / PHASES:.3g}", rows[phase, 0]), where)
    picture.paste(graph(rows, picture.width, 220), (0, picture.height - 220))
    picture.quantize(256, dither=Image.Dither.NONE).save(out, optimize=True)
    return int(abs(rows[:, 1] - rows[:, 0]).max() > BAR_MM)


if __name__ == "__main__":
    if len(sys.argv) not in (3, 4):
        sys.exit(__doc__)
    with tempfile.TemporaryDirectory() as temporary:
        sys.exit(main(sys.argv[1], sys.argv[2], Path(sys.argv[3] if len(sys.argv) == 4 else temporary)))
