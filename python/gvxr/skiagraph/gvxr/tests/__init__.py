"""gVXR's two tests of an installation: one radiograph of the dragon, or of a sphere if the dragon is not there."""
from __future__ import annotations

import os

import numpy as np
from numpy.typing import NDArray

from .. import (
    addPolygonMeshAsInnerSurface, computeXRayImage, createWindow, destroy, getOpenGlRenderer, loadMeshFile, makeSphere,
    moveToCentre, setDensity, setDetectorNumberOfPixels, setDetectorPixelSize, setDetectorPosition, setDetectorUpVector,
    setMixture, setMonoChromatic, setSourcePosition, usePointSource, wheel)

__all__ = ["test_gvxr", "test_offscreen"]


def _radiograph() -> NDArray[np.float32]:
    """A titanium alloy at 80 keV."""
    createWindow()
    setSourcePosition(-40.0, 0.0, 0.0, "cm")
    usePointSource()
    setMonoChromatic(0.08, "MeV", 1000)
    setDetectorPosition(10.0, 0.0, 0.0, "cm")
    setDetectorUpVector(0, 0, -1)
    setDetectorNumberOfPixels(640, 320)
    setDetectorPixelSize(0.5, 0.5, "mm")
    path = os.path.join(os.path.dirname(os.path.dirname(__file__)), wheel.DRAGON)
    if os.path.exists(path):
        loadMeshFile("Dragon", path, "mm")
    else:
        print(f"a sphere stands for the dragon: {wheel.ADVICE}")
        makeSphere("Dragon", 32, 64, 4, "cm")
        addPolygonMeshAsInnerSurface("Dragon")
    moveToCentre("Dragon")
    setMixture("Dragon", "Ti90Al6V4")
    setDensity("Dragon", 4.43, "g/cm3")
    return computeXRayImage()


def _check() -> None:
    """Computes the radiograph, and says what it found."""
    image = _radiograph()
    print(f"{image.shape[1]} x {image.shape[0]} pixels, {image.min():g} to {image.max():g} MeV, by {getOpenGlRenderer()}")
    destroy()
    assert 0 <= image.min() < 0.5 * image.max() <= 40.001


def test_offscreen() -> None:
    """One radiograph."""
    _check()


def test_gvxr() -> None:
    """One radiograph, without a window."""
    _check()
