"""The detector, and its noise."""
from __future__ import annotations

import os
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .state import ENERGIES, millimetres, three, unit, world

__all__ = [
    "clearDetectorEnergyResponse", "clearLSF", "disablePoissonNoise", "enablePoissonNoise",
    "getDetectorNumberOfPixels", "getDetectorPixelSpacing", "getDetectorPosition", "getDetectorRightVector",
    "getDetectorSize", "getDetectorUpVector", "getSDD", "getSourceDetectorDistance",
    "loadDetectorEnergyResponse", "setDetectorEnergyResponse", "setDetectorNumberOfPixels",
    "setDetectorPixelPitch", "setDetectorPixelSize", "setDetectorPosition", "setDetectorRightVector",
    "setDetectorSize", "setDetectorUpVector", "setLSF", "setOversamplingFactor", "setPhotonCountingBands",
    "setScintillator", "setSeed", "usePoissonNoise",
]


def setDetectorPosition(x: float, y: float, z: float, aUnitOfLength: str) -> None:
    world.detector = three(x, y, z, millimetres(aUnitOfLength))


def getDetectorPosition(aUnitOfLength: str) -> tuple[float, float, float]:
    return three(*world.detector, 1 / millimetres(aUnitOfLength))


def setDetectorUpVector(x: float, y: float, z: float) -> None:
    world.up = three(x, y, z)


def setDetectorRightVector(x: float, y: float, z: float) -> None:
    world.right = three(x, y, z)


def getDetectorUpVector() -> tuple[float, ...]:
    return _direction(world.scene(False).view.row_step)


def getDetectorRightVector() -> tuple[float, ...]:
    return _direction(world.scene(False).view.column_step)


def _direction(step: NDArray[np.float64]) -> tuple[float, ...]:
    return tuple((step / np.linalg.norm(step)).tolist())


def setDetectorNumberOfPixels(aWidth: int, aHeight: int) -> None:
    world.pixels = int(aWidth), int(aHeight)


def getDetectorNumberOfPixels() -> tuple[int, int]:
    return world.pixels


def setDetectorPixelSize(aWidth: float, aHeight: float, aUnitOfLength: str) -> None:
    world.size, world.spacing = None, (aWidth * millimetres(aUnitOfLength), aHeight * millimetres(aUnitOfLength))


setDetectorPixelPitch = setDetectorPixelSize


def setDetectorSize(aWidth: float, aHeight: float, aUnitOfLength: str) -> None:
    world.spacing, world.size = None, (aWidth * millimetres(aUnitOfLength), aHeight * millimetres(aUnitOfLength))


def getDetectorSize(aUnitOfLength: str) -> tuple[float, float]:
    x, y = getDetectorPixelSpacing(aUnitOfLength)
    return x * world.pixels[0], y * world.pixels[1]


def getDetectorPixelSpacing(aUnitOfLength: str) -> tuple[float, float]:
    view, mm = world.scene(False).view, millimetres(aUnitOfLength)
    return float(np.linalg.norm(view.column_step)) / mm, float(np.linalg.norm(view.row_step)) / mm


def getSourceDetectorDistance(aUnitOfLength: str) -> float:
    return float(np.linalg.norm(np.subtract(world.detector, world.source))) / millimetres(aUnitOfLength)


getSDD = getSourceDetectorDistance


def setOversamplingFactor(aFactor: int = 1) -> None:
    world.detector_keys["Oversampling"] = int(aFactor)


def setLSF(aLSF: Sequence[float]) -> None:
    """Along rows only, as gVXR has it."""
    world.detector_keys["LSF"] = [[float(value) for value in aLSF], [1]]


def clearLSF() -> None:
    world.detector_keys.pop("LSF", None)


def setScintillator(aMaterial: str, aThickness: float, aUnitOfLength: str) -> None:
    clearDetectorEnergyResponse()
    world.detector_keys["Scintillator"] = {"Material": aMaterial, "Thickness": float(aThickness), "Unit": aUnitOfLength}


def loadDetectorEnergyResponse(aFileName: str, aUnitOfEnergy: str) -> None:
    clearDetectorEnergyResponse()
    world.detector_keys["EnergyResponse"] = {"File": os.path.abspath(aFileName), "Unit": aUnitOfEnergy}


def setDetectorEnergyResponse(anEnergyResponse: Any, aUnitOfEnergy: str) -> None:
    clearDetectorEnergyResponse()
    rows = np.asarray(anEnergyResponse, dtype=float)
    world.detector_keys["EnergyResponse"] = {"LUT": rows.tolist(), "Unit": aUnitOfEnergy}


def clearDetectorEnergyResponse() -> None:
    world.detector_keys.pop("EnergyResponse", None)
    world.detector_keys.pop("Scintillator", None)


def setPhotonCountingBands(aMinEnergy: float, aMaxEnergy: float, aUnitOfEnergy: str, aNumberOfBands: int) -> None:
    kev = unit(aUnitOfEnergy, ENERGIES)
    world.bands = np.linspace(aMinEnergy * kev, aMaxEnergy * kev, int(aNumberOfBands) + 1).tolist()


def enablePoissonNoise() -> None:
    world.noise = True


def disablePoissonNoise() -> None:
    world.noise = False


def usePoissonNoise() -> bool:
    return world.noise


def setSeed(aRandomGeneratorSeed: int) -> None:
    world.seed, world.frame = int(aRandomGeneratorSeed), 0
