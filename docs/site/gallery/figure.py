"""Pictures of the gallery: images with a scale bar and a colour bar with its unit, cards, and pages that turn."""
import os
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
from PIL import Image

#: The scenes of the repository's examples.
SCENES = next(folder / "examples/scenes" for folder in Path(__file__).resolve().parents if (folder / "examples/scenes").is_dir())


def pixel_at(view, point=(0, 0, 0)):
    """mm of a column in the plane through a point, parallel to the detector: the detector's own step over the magnification."""
    normal = np.cross(view.column_step, view.row_step)
    whole, part = normal @ (view.detector - view.source), normal @ (np.asarray(point) - view.source)
    return np.linalg.norm(view.column_step) * part / whole


def scale_bar(axes, image, mm_per_pixel):
    """A bar of a round length, a quarter of the width or less, with its length in mm."""
    rows, columns = image.shape[:2]
    length = max(n for n in (0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 50, 100, 200) if n <= columns * mm_per_pixel / 4)
    x, y, width = 0.05 * columns, 0.94 * rows, length / mm_per_pixel
    box = {"facecolor": "black", "edgecolor": "none", "alpha": 0.5, "pad": 2}
    axes.plot([x, x + width], [y, y], color="white", linewidth=3, solid_capstyle="butt")
    axes.text(x + width / 2, y - 0.015 * rows, f"{length:g} mm", color="white", ha="center", va="bottom", bbox=box, fontsize=8)


def show(axes, image, mm_per_pixel, title, unit=None, cmap="gray", limits=(None, None)):
    """Draws [row][column] into axes. unit: what the colour bar says; None: no bar."""
    drawn = axes.imshow(image, cmap=cmap, vmin=limits[0], vmax=limits[1], interpolation="nearest")
    axes.set_title(title, fontsize=10)
    axes.set_axis_off()
    scale_bar(axes, image, mm_per_pixel)
    if unit:
        plt.colorbar(drawn, cax=axes.inset_axes((1.03, 0, 0.05, 1)), label=unit)  # as high as the image


def row(count, width=4.2, height=3.6):
    """Axes side by side, and their figure."""
    made, axes = plt.subplots(1, count, figsize=(width * count, height), layout="constrained")
    return (axes, made) if count > 1 else ([axes], made)


def card(name, image, cmap="gray", limits=(None, None), middle=(0.5, 0.5), side=1.0):
    """Writes the picture by which the gallery's first page shows an example: card-NAME.png, a square of the image.

    middle: of the square, in shares of the rows and the columns. side: its length over the image's shorter side.
    """
    half = side * min(image.shape[:2]) / 2
    row, column = (np.clip(share * length, half, length - half) for share, length in zip(middle, image.shape))
    square = image[round(row - half):round(row + half), round(column - half):round(column + half)]
    if image.ndim == 2:
        square = plt.get_cmap(cmap)(plt.Normalize(*limits)(square), bytes=True)
    Image.fromarray(square).convert("RGB").resize((320, 320), Image.LANCZOS).save(Path(__file__).parent / f"card-{name}.png")


def turning(name, scene):
    """Writes the page of scene.show() as turn-NAME.html: beside this file, or where the site has what its pages show."""
    page = scene.show()
    if len(page.html) > 1.5e6:
        raise ValueError(f"turn-{name}.html has {len(page.html)} bytes, and a reader waits for it; give it a scene of fewer triangles")
    page.save(Path(os.environ.get("SKG_SITE_EXTRA", Path(__file__).parent)) / f"turn-{name}.html")
