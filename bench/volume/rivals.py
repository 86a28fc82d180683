#!/usr/bin/env python3
"""Images of a volume of cells beside DiffDRR's Siddon and RTK's Joseph (PyPI: diffdrr, itk-rtk), on this machine's processors and in one run:
milliseconds an image, and how far line integrals are from sums in double precision.

    python3 -m venv /tmp/rivals && /tmp/rivals/bin/pip install diffdrr itk-rtk cffi numpy
    cmake --install BUILD --component python --prefix /tmp/package
    PYTHONPATH=/tmp/package /tmp/rivals/bin/python bench/volume/rivals.py

All three see the same rays: from a point to the centres of the pixels of a detector across the beam. What is timed is an image from cells
that are in memory already: the library's from a plan that stands, RTK's with its filter made anew, DiffDRR's without gradients and in patches of
rays, as its memory asks for. Contenders take turns, and the least time of each counts. A contender that is not installed is left out.
The cells are those of bench_volume: a body with lungs, spine and noise."""
import argparse
import time

import numpy as np

import skiagraph as sk

SIDE_MM, SOURCE_MM, DETECTOR_MM, WIDTH_MM = 360.0, 700.0, 300.0, 560.0  # of the cube; from its middle; of the detector
PATCH = 32768  # rays that DiffDRR takes at once
CHECKED = 400  # rays that are summed in double


def make_cells(side: int) -> np.ndarray:
    """Attenuation coefficients in 1/cm, [z, y, x]."""
    at = 2 * (np.arange(side) + 0.5) / side - 1
    z, y, x = np.meshgrid(at, at, at, indexing="ij")
    hu = np.where((np.abs(x) - 0.4) ** 2 * 10 + y * y * 4 + z * z < 1, -780.0, np.where(x * x + (y - 0.4) ** 2 < 0.01, 500.0, 40.0))
    hu += np.random.default_rng(1).integers(-32, 32, hu.shape)
    hu[x * x * 1.3 + y * y * 2.4 > 1] = -1000
    return (0.2 * (1 + hu / 1000)).astype(np.float32)


def rays(size: int) -> tuple[np.ndarray, np.ndarray]:
    """The source, and the pixels [row, column, 3], mm: the beam runs to lower z."""
    at = (np.arange(size) - 0.5 * (size - 1)) * (WIDTH_MM / size)
    pixels = np.empty((size, size, 3))
    pixels[..., 0], pixels[..., 1], pixels[..., 2] = at[None, :], at[:, None], -DETECTOR_MM
    return np.array([0, 0, SOURCE_MM]), pixels


def exact(cells: np.ndarray, source: np.ndarray, pixel: np.ndarray) -> float:
    """The line integral of one ray, from plane to plane in double precision."""
    side = cells.shape[0]
    start, end = ((p + SIDE_MM / 2) / SIDE_MM * side for p in (source, pixel))
    way = end - start
    crossed = [(np.arange(side + 1) - start[k]) / way[k] for k in range(3) if way[k] != 0]
    t = np.unique(np.clip(np.concatenate([*crossed, [0, 1]]), 0, 1))
    middle = start + np.outer(0.5 * (t[1:] + t[:-1]), way)
    index = np.floor(middle).astype(int)
    inside = np.all((index >= 0) & (index < side), axis=1)
    found = cells[index[inside, 2], index[inside, 1], index[inside, 0]].astype(np.float64)
    return float(np.sum(found * np.diff(t)[inside]) * np.linalg.norm(pixel - source) / 10)


def ours(cells: np.ndarray, size: int):
    scene, step = sk.Scene(), SIDE_MM / cells.shape[0]
    affine = np.diag([step, step, step, 1])
    affine[:3, 3] = 0.5 * (step - SIDE_MM)
    scene.add_volume("patient", cells, affine, "mu")
    scene.view = sk.View(source=(0, 0, SOURCE_MM), detector=(0, 0, -DETECTOR_MM), column_step=(WIDTH_MM / size, 0, 0),
                         row_step=(0, WIDTH_MM / size, 0), pixels=(size, size))
    scene.beam = sk.Beam.mono(60, 1)
    return lambda: scene.image("attenuation")


def of_diffdrr(cells: np.ndarray, size: int):
    import torch
    from diffdrr.renderers import Siddon
    source, pixels = rays(size)
    side = cells.shape[0]

    def indices(p: np.ndarray) -> "torch.Tensor":
        return torch.tensor((p + SIDE_MM / 2) / SIDE_MM * side - 0.5, dtype=torch.float32)
    volume, renderer = torch.tensor(cells).permute(2, 1, 0).contiguous(), Siddon()
    start, ends = indices(source)[None, None], indices(pixels.reshape(1, -1, 3))
    mm = torch.tensor(np.linalg.norm(pixels - source, axis=-1).reshape(1, 1, -1) / 10, dtype=torch.float32)

    def image() -> np.ndarray:
        with torch.no_grad():
            parts = [renderer(volume, start, ends[:, k:k + PATCH], mm[..., k:k + PATCH]) for k in range(0, size * size, PATCH)]
        return torch.cat([p.reshape(-1) for p in parts]).reshape(size, size).numpy()
    return image


def of_rtk(cells: np.ndarray, size: int):
    import itk
    from itk import RTK as rtk
    kind = itk.Image[itk.F, 3]
    step = SIDE_MM / cells.shape[0]
    volume = itk.image_from_array(cells)
    volume.SetSpacing([step] * 3)
    volume.SetOrigin([0.5 * (step - SIDE_MM)] * 3)
    geometry = rtk.ThreeDCircularProjectionGeometry.New()
    geometry.AddProjection(SOURCE_MM, SOURCE_MM + DETECTOR_MM, 0)
    pitch = WIDTH_MM / size
    empty = rtk.ConstantImageSource[kind].New()
    empty.SetOrigin([-0.5 * pitch * (size - 1)] * 2 + [0])
    empty.SetSpacing([pitch, pitch, 1])
    empty.SetSize([size, size, 1])
    empty.Update()

    def image() -> np.ndarray:
        joseph = rtk.JosephForwardProjectionImageFilter[kind, kind].New()
        joseph.SetGeometry(geometry)
        joseph.InPlaceOff()  # the blank projection is there for the next one
        joseph.SetInput(0, empty.GetOutput())
        joseph.SetInput(1, volume)
        joseph.Update()
        return itk.array_from_image(joseph.GetOutput())[0] / 10
    return image


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--cells", type=int, default=256, help="along each side of the cube (256)")
    parser.add_argument("--size", type=int, default=512, help="pixels along each side of the detector (512)")
    parser.add_argument("--repeats", type=int, default=5, help="turns (5)")
    given = parser.parse_args()
    cells = make_cells(given.cells)
    images, least, shown = {}, {}, {}
    for name, make in {"library": ours, "RTK Joseph": of_rtk, "DiffDRR Siddon": of_diffdrr}.items():
        try:
            images[name] = make(cells, given.size)
        except ImportError as reason:
            print(f"{name} is left out: {reason}")
    for turn in range(given.repeats + 1):  # the first turn compiles, and is not counted
        for name, image in images.items():
            begun = time.perf_counter()
            shown[name] = image()
            took = 1000 * (time.perf_counter() - begun)
            least[name] = min(least.get(name, np.inf), took) if turn else np.inf
    source, pixels = rays(given.size)
    chosen = np.random.default_rng(2).integers(0, given.size, (CHECKED, 2))
    sums = np.array([exact(cells, source, pixels[r, c]) for r, c in chosen])
    print(f"{given.cells}^3 cells, {given.size} x {given.size} pixels, least of {given.repeats}; errors of {CHECKED} rays over the "
          "largest sum, in the root mean square and at most\n")
    print("| contender | ms an image | over the library's | error | largest error |\n|---|---|---|---|---|")
    for name in images:
        off = np.abs(shown[name][chosen[:, 0], chosen[:, 1]] - sums) / sums.max()
        print(f"| {name} | {least[name]:.0f} | {least[name] / least['library']:.1f} | {np.sqrt(np.mean(off ** 2)):.1e} | {off.max():.1e} |")


if __name__ == "__main__":
    main()
