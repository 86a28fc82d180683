"""Where rounding shows: thin plates, parts that touch, and the stated bound of the precision beside the error."""
from __future__ import annotations

from typing import Any

import numpy as np
import skiagraph as sk
from page import Page
from skiagraph import _library
from skiagraph.scene import state_of

DISTANCE, SIZE, PIXELS = 1400.0, 256.0, 128  # of the detector from the source, its side, mm
SHIFT = 6e-5 * SIZE / PIXELS + 4 * 2.0**-24 * 354  # mm: two last places of a column, four of a coordinate of the largest part


def view(shift: tuple[float, float] = (0.0, 0.0), projection: str = "point") -> sk.View:
    pitch = SIZE / PIXELS
    return sk.View(source=(0, 0, -1000), detector=(shift[0], shift[1], DISTANCE - 1000), column_step=(pitch, 0, 0), row_step=(0, pitch, 0),
                   pixels=(PIXELS, PIXELS), projection=projection)


def rays(shift: tuple[float, float]) -> np.ndarray:
    places = SIZE / PIXELS * (np.arange(PIXELS) - (PIXELS - 1) / 2)
    x, y = np.meshgrid(places + shift[0], places + shift[1])
    to = np.stack([x, y, np.full_like(x, DISTANCE)], axis=-1)
    return to / np.linalg.norm(to, axis=-1, keepdims=True)


def lengths(size: np.ndarray, pose: np.ndarray, shift: tuple[float, float]) -> np.ndarray:
    """Exact lengths through a cuboid, in extended precision."""
    turn = pose[:3, :3].astype(np.longdouble)
    start = turn.T @ (np.array([0, 0, -1000], np.longdouble) - pose[:3, 3])
    along = rays(shift).astype(np.longdouble) @ turn
    near, far = (-size / 2 - start) / along, (size / 2 - start) / along
    return np.maximum(np.maximum(near, far).min(axis=-1) - np.minimum(near, far).max(axis=-1), 0).astype(float)


SHIFTS = [(x * SHIFT, y * SHIFT) for x in (-1, 0, 1) for y in (-1, 0, 1)]


def plate(draw: np.random.Generator, thickness: float) -> tuple[np.ndarray, np.ndarray]:
    """Size and pose of a plate of any tilt, turned in its own plane."""
    size = np.array([*np.exp(draw.uniform(np.log(1), np.log(500), 2)), thickness])
    turn = sk.rotate("z", draw.uniform(0, 360)) @ sk.rotate("x", draw.uniform(0, 90)) @ sk.rotate("z", draw.uniform(0, 360))
    return size, sk.translate(*draw.uniform(-20, 20, 3)) @ turn


def scene_of(meshes: list[tuple[str, Any, np.ndarray, str]], kev: float = 60) -> sk.Scene:
    scene = sk.Scene()
    scene.view, scene.beam = view(), sk.Beam.mono(kev, 1)
    for label, mesh, pose, material in meshes:
        scene.add(label, mesh, material=material).pose = pose
    return scene


def plates(page: Page) -> None:
    page.claim("Thin plates", "closed forms in extended precision (`bench/validate/precision.py`).",
               f"Lengths in `single` through 40 plates for each thickness, with sides of 1 to 500 mm and any tilt, on {PIXELS} x {PIXELS} "
               f"pixels of {SIZE / PIXELS:g} mm, source at 1000 mm, detector at 1400 mm. The error is that outside the interval which the exact "
               "length takes when the ray is shifted by four last places of a coordinate and two of a pixel. Its bar is 3e-5 of the longest path L or 2e-6 of the "
               "extent D along the rays, whichever is larger ([numerics.md](numerics.md#precision)). `bench_hard` draws more bodies.")
    draw, rows = np.random.default_rng(20261123), []
    for thickness in (0.01, 0.1, 1.0, 3.0):
        lit = outside = close = 0
        worst, relative = 0.0, 0.0
        for _ in range(40):
            size, pose = plate(draw, thickness)
            found = scene_of([("plate", sk.Mesh.cuboid(*size), pose, "water")]).lengths("plate").astype(float)
            exact = np.stack([lengths(size, pose, shift) for shift in SHIFTS])
            error = np.maximum(np.maximum(exact.min(0) - found, found - exact.max(0)), 0)
            longest, deep = exact.max(), float(np.abs(size * pose[2, :3]).sum())
            bar, seen = max(3e-5 * longest, 2e-6 * deep), exact[4] > 0
            lit += int(seen.sum())
            outside += int((error > bar).sum())
            close += int((error[seen] <= 3e-5 * longest + 5e-7 * deep).sum())
            if longest > 0:
                worst, relative = max(worst, float(error.max() / bar)), max(relative, float(error.max() / longest))
        rows.append([f"{thickness:g} mm", str(lit), f"{100 * close / lit:.3f} %", str(outside), f"{worst:.2g}", f"{relative:.2g}"])
    page.table(["thickness", "pixels", "within 3e-5 L + 5e-7 D", "outside the bar", "largest error / bar", "largest error / L"], rows)


def seams(page: Page) -> None:
    page.claim("Parts that touch", "the picture of the block before it was cut, by the same program.",
               "A cuboid of 60 mm x 60 mm x 40 mm of water is cut into two parts by a plane through the centres of a column of pixels, in "
               "turn for each of 16 columns. A pixel is wrong if its -ln I/I0 differs from that of the whole cuboid by more than 1e-4 of "
               "the largest.")
    rows = []
    for projection in ("point", "parallel"):
        for precision in ("single", "double"):
            wrong = pixels = 0
            for column in range(PIXELS // 2 - 8, PIXELS // 2 + 8):
                x = SIZE / PIXELS * (column - (PIXELS - 1) / 2) * (1000 / DISTANCE if projection == "point" else 1)
                whole = scene_of([("block", sk.Mesh.cuboid(60, 60, 40), sk.translate(0, 0, 0), "water")])
                pieces = scene_of([(name, mesh, sk.translate(0, 0, 0), "water") for name, mesh in cut(x, projection)])
                for scene in (whole, pieces):
                    scene.view = view(projection=projection)
                before, after = (s.image("attenuation", precision=precision).astype(float) for s in (whole, pieces))
                wrong += int((np.abs(after - before) > 1e-4 * before.max()).sum())
                pixels += int((before > 0).sum())
            rows.append([projection, precision, str(pixels), str(wrong)])
    page.table(["beam", "precision", "pixels of the block", "wrong"], rows)


def cut(x: float, projection: str) -> list[tuple[str, Any]]:
    """The two halves of the block at the plane through x (at z = 0) and the source, or across a parallel beam's columns."""
    lean = x / 1000 if projection == "point" else 0.0  # mm of x for each mm of z
    faces = [(0, 2, 3), (0, 3, 1), (4, 5, 7), (4, 7, 6), (0, 1, 5), (0, 5, 4), (2, 6, 7), (2, 7, 3), (0, 4, 6), (0, 6, 2), (1, 3, 7), (1, 7, 5)]
    made = []
    for name, left, right in (("left", None, x), ("right", x, None)):
        corners = [[(-30.0 if left is None else left + lean * z) if side < 0 else (30.0 if right is None else right + lean * z), y, z]
                   for z in (-20.0, 20.0) for y in (-30.0, 30.0) for side in (-1, 1)]
        made.append((name, sk.Mesh(np.array(corners), np.array(faces))))
    return made


def bounds(page: Page) -> None:
    page.claim("The bound of the precision", "images in `double`, and the interval that they take when the detector is shifted by four last "
               "places of a coordinate.", "Scenes of one to three plates and cuboids of water, bone, aluminium or lead at 60 keV, drawn at random: "
               "`bound_precision` of `plan` beside the largest relative error of I/I0 in `single` outside that interval, of pixels to which more "
               "than 1e-6 of the open beam arrives. A ratio below 1 is an error above the bound.")
    draw, rows = np.random.default_rng(20261124), []
    for what, low, high in (("plates of 10 um to 0.3 mm", 0.01, 0.3), ("cuboids of 3 to 60 mm", 3.0, 60.0)):
        ratios = []
        for _ in range(40):
            parts = []
            for i in range(int(draw.integers(1, 4))):
                size, pose = plate(draw, float(np.exp(draw.uniform(np.log(low), np.log(high)))))
                name = str(draw.choice(["water", "HU:1329", "Al", "Pb"] if high < 1 else ["water", "HU:1329", "Al"]))
                parts.append((f"part {i}", sk.Mesh.cuboid(*size), sk.translate(0, 0, 150.0 * (i - 1)) @ pose, name))
            scene = scene_of(parts)
            state = state_of(scene)  # not part of the package's own interface yet
            with state.calls():
                bound = _library.number("skg_plan_precision_bound_get", state.plan({"quantity": "transmission"}))
            found = scene.image("transmission").astype(float)
            exact = []
            for shift in SHIFTS:
                scene.view = view(shift)
                exact.append(scene.image("transmission", precision="double").astype(float))
            lowest, highest = np.min(exact, 0), np.max(exact, 0)
            error = np.maximum(np.maximum(lowest - found, found - highest), 0) / np.maximum(exact[4], 1e-6)
            ratios.append(bound / max(float(error.max()), 1e-9))
        rows.append([what, str(len(ratios)), str(sum(r < 1 for r in ratios)), f"{min(ratios):.2g}", f"{float(np.median(ratios)):.2g}"])
    page.table(["scenes", "number", "with an error above the bound", "smallest bound / error", "median bound / error"], rows)


def add(page: Page) -> None:
    plates(page)
    seams(page)
    bounds(page)
