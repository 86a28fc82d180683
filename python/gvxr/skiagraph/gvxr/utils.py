"""gVXR's module utils: plots by Matplotlib, the scene in a notebook, and spectra.

Spectra are those of Skiagraph's own tube, so that neither SpekPy nor xpecgen is needed: the flags has_... of packages that
are not needed are True.

>>> image = np.array([[1.0, 2.0], [3.0, 4.0]])
>>> float(standardisation(image).mean())
0.0
>>> applyLogScaleAndNegative(image)[0].round(3).tolist()
[1.0, 0.5]
"""
from __future__ import annotations

import importlib.util
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .._interface import UnsupportedError
from .._show import Page
from .display import takeScreenshot
from .spectra import *
from .spectra import Loaded, Spectrum
from .state import world


def _has(name: str) -> bool:
    return importlib.util.find_spec(name) is not None


has_k3d = has_spekpy = has_xpecgen = has_skimage = has_PIL = True
has_MPL, has_widgets = _has("matplotlib"), _has("ipywidgets")
is_running_on_Google_Colab = _has("google.colab") if _has("google") else False


def _pyplot() -> Any:
    try:
        from matplotlib import pyplot  # type: ignore[import-not-found, import-untyped, unused-ignore]
    except ImportError:
        raise UnsupportedError("this plot needs Matplotlib, which is not installed: pip install matplotlib") from None
    return pyplot


# Images


def standardisation(img: Any) -> NDArray[np.float64]:
    """With the mean 0 and the standard deviation 1."""
    values = np.asarray(img, dtype=float)
    made: NDArray[np.float64] = (values - values.mean()) / values.std()
    return made


def logImage(xray_image: Any, min_val: float, max_val: float) -> NDArray[np.float64]:
    """The logarithm, 0 at min_val and 1 at max_val."""
    floor = 1e-9  # of a value of 0
    low, high = np.log(min_val + floor), np.log(max_val + floor)
    made: NDArray[np.float64] = (np.log(np.asarray(xray_image, dtype=float) + floor) - low) / (high - low if high != low else 1)
    return made


def applyLogScaleAndNegative(image: Any) -> NDArray[np.float64]:
    """The logarithm of an image, negative: the least value is 1 (white), the greatest 0."""
    values = np.asarray(image, dtype=float)
    return 1 - logImage(values, float(values.min()), float(values.max()))


def sharpen(image: Any, ksize: float, alpha: float) -> NDArray[Any]:
    """Adds alpha times what a Gaussian blur with this standard deviation, in pixels, takes away; the range stays."""
    values = np.asarray(image)
    blurred = values.astype(float)
    reach = max(int(4 * ksize + 0.5), 1)
    kernel = np.exp(-0.5 * (np.arange(-reach, reach + 1) / max(ksize, 1e-6)) ** 2)
    kernel /= kernel.sum()
    for axis in range(blurred.ndim):
        width = [(reach, reach) if k == axis else (0, 0) for k in range(blurred.ndim)]
        padded = np.pad(blurred, width, mode="edge")
        blurred = np.apply_along_axis(np.convolve, axis, padded, kernel, "valid")
    made: NDArray[Any] = np.clip(values + alpha * (values - blurred), values.min(), values.max()).astype(values.dtype)
    return made


def rgb2k3d(R: int, G: int, B: int) -> int:
    """A colour as one number: 0xRRGGBB."""
    return (int(R) & 255) << 16 | (int(G) & 255) << 8 | int(B) & 255


# Plots


def _shown(axes: Any, image: Any, title: str, **looks: Any) -> None:
    picture = axes.imshow(image, **{"cmap": "gray", **looks})
    axes.figure.colorbar(picture, ax=axes, orientation="horizontal")
    axes.set_title(title)


def _finish(figure: Any, fname: str | None) -> None:
    figure.tight_layout()
    if fname is not None:
        figure.savefig(fname, bbox_inches="tight")


def saveProjections(x_ray_image: Any, fname: str | None = None, gamma: float = 0.5, figsize: Any = (17, 7.5)) -> None:
    """Plots an image with linear, logarithmic and power-law grey values, and writes the plot."""
    pyplot = _pyplot()
    from matplotlib.colors import LogNorm, PowerNorm  # type: ignore[import-not-found, import-untyped, unused-ignore]

    figure, axes = pyplot.subplots(1, 3, figsize=figsize)
    _shown(axes[0], x_ray_image, "linear")
    _shown(axes[1], x_ray_image, "logarithmic", norm=LogNorm())
    _shown(axes[2], x_ray_image, f"power law, gamma = {gamma:g}", norm=PowerNorm(gamma=1 / gamma))
    _finish(figure, fname)


def compareWithGroundTruth(groundTruth: Any, testImage: Any, fname: str | None = None, figsize: Any = (17, 7.5)) -> None:
    """Plots two images with the same grey values, and how far the second is below the first in percent."""
    truth, test = np.asarray(groundTruth, dtype=float), np.asarray(testImage, dtype=float)
    low, high = truth.min(), truth.max()
    figure, axes = _pyplot().subplots(1, 3, figsize=figsize)
    _shown(axes[0], truth, "Ground truth", vmin=low, vmax=high)
    _shown(axes[1], test, "Simulation", vmin=low, vmax=high)
    with np.errstate(divide="ignore", invalid="ignore"):
        _shown(axes[2], 100 * (truth - test) / truth, "Relative difference / %", cmap="RdBu", vmin=-5, vmax=5)
    _finish(figure, fname)


def interactPlotPowerLaw(xray_image: Any, gamma: float = 0.5, figsize: Any = (10, 5)) -> None:
    """Plots an image with power-law grey values; in a notebook with ipywidgets, a slider changes gamma."""
    pyplot = _pyplot()
    from matplotlib.colors import PowerNorm

    def plot(gamma: float) -> None:
        figure, axes = pyplot.subplots(figsize=figsize)
        _shown(axes, xray_image, f"power law, gamma = {gamma:g}", norm=PowerNorm(gamma=1 / gamma))
        figure.tight_layout()

    if has_widgets:
        from ipywidgets import FloatSlider, interact  # type: ignore[import-not-found, import-untyped, unused-ignore]

        interact(plot, gamma=FloatSlider(value=gamma, min=0.09, max=5.0, step=0.1, description="gamma"))
    else:
        plot(gamma)


def plotScreenshot() -> None:
    """Plots a picture of the scene from outside."""
    axes = _pyplot().subplots(figsize=(10, 10))[1]
    axes.imshow(takeScreenshot())
    axes.axis("off")


def visualise(use_log: bool = False, use_negative: bool = False, sharpen_ksize: int = 1, sharpen_alpha: float = 0.0) -> Page:
    """The scene as a page that turns with the mouse, for a cell of a notebook; display() and save() show it elsewhere.

    It is Skiagraph's own page and not a plot of K3D. Its detector shows the image, whatever is asked of its grey values.
    """
    return world.scene(False).show()


visualize = visualise
