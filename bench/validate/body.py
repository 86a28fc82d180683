"""The Monte Carlo image of the paper's cube, and the generated thorax beside organs and published exposures."""
from __future__ import annotations

import csv
import glob
import os
import subprocess
import tempfile
from typing import Any

import numpy as np
import skiagraph as sk
from page import Page

HERE = os.path.dirname(os.path.abspath(__file__))


def monte_carlo(page: Page, build: str, data: str) -> None:
    page.claim("A Monte Carlo simulation", "EGSnrc (commit 9edee3eb, 2026-11), analogue transport, of the paper's cube of soft "
               "tissue (3 cm) with a cylinder of bone (1 cm) at 80 keV; not part of the repository.",
               "I/I0 with 8 x 8 rays in a pixel, by `bench_mc`, with the attenuation coefficients of that simulation. NCC is the "
               "zero-mean normalised cross-correlation; errors are relative. The largest errors are those of pixels at "
               "silhouettes, where the reference's rays are unevenly spaced ([bench/README.md](../bench/README.md#against-monte-carlo)).")
    prefix = os.path.join(data, "montecarlo", "a_")
    if not os.path.exists(prefix + "primary.mhd"):
        page.text("The images were not there when this page was made.")
        return
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "mc.csv")
        subprocess.run([os.path.join(build, "bin", "bench_mc"), "--scene", os.path.join(HERE, "..", "mc", "cube.json"),
                        "--reference", prefix, "--csv", path], check=False, stdout=subprocess.DEVNULL)
        with open(path, encoding="utf-8") as file:
            rows = [row for row in csv.DictReader(file) if "single" in row["image"]]
    page.table(["image", "NCC", "mean error", "largest error"],
               [[row["image"], row["ncc"], row["mean_error"], row["largest_error"]] for row in rows])
    page.judge("Monte Carlo, primary radiation, mean error", float(rows[0]["mean_error"]), 1e-4, "")
    page.judge("Monte Carlo, total radiation, 1 - NCC", 1 - float(rows[1]["ncc"]), 1e-4, "",
               "scatter is left out here")


#: Material of each part of bench/mc/cube.json by this project's own tables, instead of the simulation's coefficients.
OWN = {"soft tissue": ["HU", 51], "bone": ["HU", 1329]}


def _reference(data: str, name: str, shape: tuple[int, int]) -> np.ndarray:
    return np.fromfile(os.path.join(data, "montecarlo", name + ".raw"), "<f4").reshape(shape).astype(float)


def _cube(materials: dict[str, Any]) -> np.ndarray:
    settings = {f"Samples.{label}.Material": material for label, material in materials.items()}
    with sk.Scene(os.path.join(HERE, "..", "mc", "cube.json"), settings=settings) as scene:
        return scene.image("transmission", supersampling=8).astype(float)


def _water(distance: float, half: float, material: Any) -> np.ndarray:
    """I/I0 behind 20 cm of water: the detector's plane at `distance` behind the middle, with 32 x 32 pixels; lengths in mm."""
    pitch = 2 * half / 32
    scene = sk.Scene()
    scene.view = sk.View(source=(-900, 0, 0), detector=(distance, 0, 0), column_step=(0, pitch, 0), row_step=(0, 0, pitch), pixels=(32, 32))
    scene.beam = sk.Beam.mono(60, 1)
    scene.add("slab", sk.Mesh.cuboid(200, 300, 300), material=material)
    return scene.image("transmission", supersampling=8).astype(float)


def shadows(page: Page, data: str) -> None:
    page.claim("A Monte Carlo simulation, in the shadow", "EGSnrc (commit 9edee3eb, 2026-11): the cube above, and a slab of 20 cm of water "
               "at 60 keV with the detector directly behind it (W0) and 20 cm behind it (W1); not part of the repository.",
               "The primary's I/I0, ours over the reference, of all pixels whose rays meet the object, by this project's coefficients and by those of the "
               "simulation, whose table of incoherent scattering is 0.2 % below XCOM's. Scatter, which is left out here, is given as the "
               "simulation's share of the primary in the middle.")
    if not os.path.exists(os.path.join(data, "montecarlo", "w0_primary.raw")):
        page.text("The images were not there when this page was made.")
        return
    rows, worst = [], {"own": 0.0, "theirs": 0.0}

    def add_row(name: str, middle: slice, primary: np.ndarray, flat: np.ndarray, scatter: np.ndarray, own: np.ndarray, theirs: np.ndarray) -> None:
        share = primary / flat
        seen = share < 0.99
        cells = []
        for key, image in (("own", own), ("theirs", theirs)):
            error = (image / share - 1)[seen]
            worst[key] = max(worst[key], float(abs(error).mean()))
            cells += [f"{abs(error).mean():.2g}", f"{abs(error).max():.2g}"]
        ratio = scatter[middle, middle].sum() / primary[middle, middle].sum()
        rows.append([name, *cells, f"{100 * ratio:.1f} %"])

    cube = {what: _reference(data, "a_" + what, (301, 301)) for what in ("primary", "open", "scatter")}
    add_row("cube and cylinder, 80 keV", slice(145, 156), cube["primary"], cube["open"], cube["scatter"], _cube(OWN), _cube({}))
    for name, distance in (("W0", 100.00001), ("W1", 300.0)):
        water = {what: _reference(data, f"{name.lower()}_{what}", (32, 32)) for what in ("primary", "open", "scatter")}
        add_row(f"20 cm of water, {name}", slice(14, 18), water["primary"], water["open"], water["scatter"], _water(distance, 150, "water"),
                _water(distance, 150, "mu:0.20554967"))
    page.table(["object", "mean error, our coefficients", "largest", "mean error, the simulation's", "largest", "scatter / primary, middle"], rows)
    page.judge("Monte Carlo, shadow, our coefficients, mean error", 100 * worst["own"], 1, "%")
    page.judge("Monte Carlo, shadow, the simulation's coefficients, mean error", 100 * worst["theirs"], 0.01, "%")


#: Fields of 20 mm x 20 mm: x (to the left) and z (up from the top of the right dome) in the plane y = 0, mm.
FIELDS = {"right lung": (-80, 30), "heart": (45, 30), "spine": (0, 30), "below the right dome": (-75, -100)}
CLINICAL = {"heart": 0.21, "below the right dome": 0.10}


def transmissions(folder: str) -> dict[str, float]:
    settings = {"Source.Beam": {"kVp": 120, "Filter": [["Al", 3, "mm"]]}}
    with sk.Scene(os.path.join(folder, "thorax.json"), settings=settings) as scene:
        image, view = scene.image("transmission").astype(float), scene.view
    found = {}
    middle = [(n - 1) / 2 for n in view.pixels]
    scale = np.linalg.norm(view.detector - view.source) / abs(view.source[1])  # from the plane y = 0
    pitch = np.linalg.norm(view.column_step), np.linalg.norm(view.row_step)
    for name, (x, z) in FIELDS.items():
        column = middle[0] + (x * scale - view.detector[0]) / view.column_step[0]
        row = middle[1] + (view.source[2] + (z - view.source[2]) * scale - view.detector[2]) / view.row_step[2]
        half = [int(round(10 * scale / p)) for p in pitch]
        field = image[int(row) - half[1]:int(row) + half[1] + 1, int(column) - half[0]:int(column) + half[0] + 1]
        found[name] = float(np.median(field))
    return found


ORGANS = {"liver": ["liver"], "spleen": ["spleen"], "kidney left": ["kidney_l"], "kidney right": ["kidney_r"],
          "stomach": ["stomach"], "gallbladder": ["gallbladder"], "trachea": ["trachea"],
          "lung left": ["lung_l_upper", "lung_l_lower"], "lung right": ["lung_r_upper", "lung_r_middle", "lung_r_lower"],
          "scapula left": ["scapula_l"], "clavicle left": ["clavicle_l"], "rib 6 left": ["rib_l06"]}


def volume(path: str) -> float:
    """ml"""
    return float(sk.Mesh.load(path).health["volume"]) / 1000


def thorax(page: Page, data: str) -> None:
    page.claim("The generated thorax: exposures", "E. Mah, E. Samei, D. J. Peck, Evaluation of a quality control phantom for "
               "digital chest radiography, Journal of Applied Clinical Medical Physics 2(2) (2001) 90-101: exposures of clinical "
               "chest radiographs, over that of the lung.", "Transmitted energy at 120 kV with 3 mm of aluminium, medians of 20 mm x "
               "20 mm, over that of the right lung; x to the left and z up from the top of the right dome, in mm. The reference has scattered radiation and full inspiration; the image has "
               "neither, so an agreement within a few hundredths is all that it can show.")
    with tempfile.TemporaryDirectory() as folder:
        sk.thorax(folder)
        found = transmissions(folder)
        volumes = {name: volume(os.path.join(folder, name.replace(" ", "-") + ".ply")) for name in ORGANS}
    lung = found["right lung"]
    page.table(["field", "transmission", "over the lung, ours", "clinical"],
               [[f"{name}, x {FIELDS[name][0]}, z {FIELDS[name][1]}", value, f"{value / lung:.2f}", f"{CLINICAL[name]:.2f}" if name in CLINICAL else ""]
                for name, value in found.items()])
    for name, reference in CLINICAL.items():
        page.judge(f"thorax, {name} over lung", found[name] / lung - reference, 0.1, "")
    _organs(page, data, volumes)


def _organs(page: Page, data: str, volumes: dict[str, float]) -> None:
    page.claim("The generated thorax: volumes", "BodyParts3D 3.0, (c) The Database Center for Life Science, CC BY 4.0: organ "
               "surfaces of one man, lying; not part of the repository.",
               "Volumes in ml at 42,000 triangles. One man is no norm: what counts is that no organ is far from a man's. There is "
               "no bar.")
    folder = os.path.join(data, "bodyparts3d")
    rows: list[list[Any]] = []
    for name, files in ORGANS.items():
        paths = [os.path.join(folder, file + ".obj") for file in files]
        real = sum(volume(path) for path in paths) if all(map(os.path.exists, paths)) else None
        rows.append([name, f"{volumes[name]:.0f}", f"{real:.0f}" if real else "", f"{volumes[name] / real:.2f}" if real else ""])
    page.table(["organ", "ours", "BodyParts3D", "ratio"], rows)


def add(page: Page, build: str, data: str) -> None:
    monte_carlo(page, build, data)
    shadows(page, data)
    thorax(page, data)
