"""A gradient through a volume with PyTorch, which keeps a record of every point for the way back, beside bench_gradient's.

The same volume, rays and points as gradient_volume.c: 256 points a ray, 200 x 200 pixels, the derivative of a loss by the six numbers of a
twist of the volume. usage: python3 bench/gradient_volume.py [BENCH_GRADIENT], by default build/bin/bench_gradient; needs PyTorch.
"""
from __future__ import annotations

import csv
import os
import statistics
import subprocess
import sys
import tempfile
import time

import torch

SIDE, POINTS, PIXELS, REPEATS = 256, 256, 200, 7
SIZE, PITCH = 480.0, 480.0 / PIXELS  # mm
SOURCE, CENTRE = torch.tensor([0.0, -860.0, -20.0]), torch.tensor([0.0, 140.0, -20.0])


def volume() -> torch.Tensor:
    """An ellipsoid of lungs and bones, 1/mm."""
    axis = 2 * torch.arange(SIDE) / SIDE - 1
    z, y, x = torch.meshgrid(axis, axis, axis, indexing="ij")
    body, bones = x * x + 2 * y * y + 0.6 * z * z, torch.sin(40 * z) * torch.sin(9 * x)
    cells = torch.full_like(body, 0.02)
    cells[body < 0.3] = 0.005
    cells[(body > 0.75) & (bones > 0.6)] = 0.05
    cells[body > 0.9] = 0
    return cells


def places() -> tuple[torch.Tensor, torch.Tensor]:
    """The points of all rays, [pixel, point, 3], and the steps between them, mm."""
    across = (torch.arange(PIXELS) - 0.5 * (PIXELS - 1)) * PITCH
    row, column = torch.meshgrid(-across, across, indexing="ij")
    pixels = torch.stack([column, torch.zeros_like(row), row], dim=-1).reshape(-1, 3) + CENTRE
    way = pixels - SOURCE
    share = (torch.arange(POINTS) + 0.5) / POINTS
    return SOURCE + share[None, :, None] * way[:, None, :], way.norm(dim=1) / POINTS


def gradient(cells: torch.Tensor, points: torch.Tensor, steps: torch.Tensor, weights: torch.Tensor) -> torch.Tensor:
    """By the twist: the points move against the volume."""
    twist = torch.zeros(6, requires_grad=True)
    moved = points - twist[:3] - torch.cross(twist[3:].expand_as(points), points, dim=-1)
    cell = SIZE / SIDE
    where = moved / (0.5 * cell * (SIDE - 1))  # -1 and 1: the middles of the outermost cells
    values = torch.nn.functional.grid_sample(cells[None, None], where[None, None], align_corners=True)
    image = values[0, 0, 0].sum(dim=-1) * steps
    (image * weights).sum().backward()
    assert twist.grad is not None
    return twist.grad


def ours(program: str) -> float:
    """The least time of image and gradient of all poses, ms."""
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "gradient.csv")
        subprocess.run([program, "--csv", path], check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        with open(path, encoding="utf-8") as file:
            for row in csv.DictReader(file):
                if row["what"].startswith("volume"):
                    return float(row["min_ms"]) / float(row["images"])
    raise SystemExit(f"{program} has no row of the volume")


def main() -> None:
    program = sys.argv[1] if len(sys.argv) > 1 else os.path.join("build", "bin", "bench_gradient")
    torch.set_num_threads(os.cpu_count() or 1)
    cells, (points, steps) = volume(), places()
    weights = (torch.arange(PIXELS * PIXELS) % 7 - 3) * 1e-6
    times = []
    for _ in range(REPEATS):
        begun = time.perf_counter()
        gradient(cells, points, steps, weights)
        times.append(1e3 * (time.perf_counter() - begun))
    mesh = ours(program)
    print(f"PyTorch {torch.__version__}, {torch.get_num_threads()} threads: image and gradient through a volume of {SIDE} cells a side "
          f"{min(times):.0f} ms (median {statistics.median(times):.0f}); of the thorax's meshes {mesh:.2f} ms, {min(times) / mesh:.0f} times.")


if __name__ == "__main__":
    main()
