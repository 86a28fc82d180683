"""Path lengths beside closed forms: a turned cuboid, a sphere of triangles, the cylinder of the paper."""
from __future__ import annotations

import numpy as np
import skiagraph as sk
from page import Page, number

PIXELS = (512, 512)
SOURCE, DETECTOR, PITCH = np.array([0.0, 0, -1000]), np.array([0.0, 0, 200]), 0.4  # mm


def view() -> sk.View:
    return sk.View(source=SOURCE, detector=DETECTOR, column_step=(PITCH, 0, 0), row_step=(0, PITCH, 0), pixels=PIXELS)


def rays() -> np.ndarray:
    """Unit vectors from the source to the pixels' centres, [row, column, 3]."""
    columns, rows = (PITCH * (np.arange(n) - (n - 1) / 2) for n in PIXELS)
    x, y = np.meshgrid(columns, rows)
    to = np.stack([x, y, np.zeros_like(x)], axis=-1) + DETECTOR - SOURCE
    return to / np.linalg.norm(to, axis=-1, keepdims=True)


def cuboid(size: np.ndarray, pose: np.ndarray) -> np.ndarray:
    """Exact lengths through a cuboid: the intersection of three slabs."""
    turn = pose[:3, :3]
    start, along = turn.T @ (SOURCE - pose[:3, 3]), rays() @ turn
    with np.errstate(divide="ignore"):
        near, far = (-size / 2 - start) / along, (size / 2 - start) / along
    return np.maximum(np.maximum(near, far).min(axis=-1) - np.minimum(near, far).max(axis=-1), 0)


def sphere(radius: float) -> np.ndarray:
    along = rays()
    middle = -(along @ SOURCE)
    square = radius**2 - (SOURCE @ SOURCE - middle**2)
    return 2 * np.sqrt(np.maximum(square, 0))


def _row(name: str, mesh: sk.Mesh, pose: np.ndarray | None, exact: np.ndarray, precision: str) -> tuple[list[str], float, float]:
    scene = sk.Scene()
    scene.view = view()
    scene.beam = sk.Beam.mono(60, 1)
    part = scene.add("body", mesh, material="water")
    if pose is not None:
        part.pose = pose
    error = (scene.lengths("body", precision=precision).astype(float) - exact) / exact.max()
    seen = exact > 0
    rms, worst = float(np.sqrt(np.mean(error[seen] ** 2))), float(np.abs(error).max())
    return [name, precision, number(float(exact.max())), number(rms, 2), number(worst, 2)], rms, worst


def add(page: Page) -> None:
    page.claim("Path lengths", "closed forms in double precision (`bench/validate/lengths.py`).",
               f"Lengths through a body on a detector of {PIXELS[0]} x {PIXELS[1]} pixels of {PITCH} mm, the source at 1000 mm, "
               "the detector at 1200 mm. Errors are shares of the longest path L: root mean square over the pixels that see the "
               "body, and the largest of all pixels. A sphere of triangles lies inside the sphere, so its error is that of the "
               "mesh and falls with the number of triangles.")
    size = np.array([120.0, 80, 50])
    pose = sk.translate(7, -4, 11) @ sk.rotate("x", 31) @ sk.rotate("y", 17) @ sk.rotate("z", 8)
    box = sk.Mesh.cuboid(*size)
    rows, bars = [], []
    for precision, rms_bar, bar in (("single", 3e-7, 3e-5), ("double", 1e-11, 1e-11)):
        row, rms, worst = _row("cuboid, turned about three axes", box, pose, cuboid(size, pose), precision)
        rows.append(row)
        bars += [(f"path lengths of a cuboid, {precision}, rms / L", rms, rms_bar),
                 (f"path lengths of a cuboid, {precision}, largest / L", worst, bar)]
    for segments in (64, 256, 1024):
        row, rms, _ = _row(f"sphere of {segments} segments", sk.Mesh.sphere(80, segments), None, sphere(80), "single")
        rows.append(row)
    bars.append(("path lengths of a sphere of 1024 segments, rms / L", rms, 1e-4))
    page.table(["body", "precision", "L, mm", "rms / L", "largest / L"], rows)
    for what, value, bar in bars:
        page.judge(what, value, bar, "")
