"""Where the detector is."""
from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..matrices import rotate
from .state import millimetres, three, world

__all__ = [
    "autoAlignDetector", "getDetectorNumberOfPixels", "getDetectorPixelArea", "getDetectorPixelSpacing",
    "getDetectorPosition", "getDetectorRightVector", "getDetectorSize", "getDetectorUpVector", "getDetectorVertices",
    "getSDD", "getSourceDetectorDistance", "rotateDetector", "setDetectorNumberOfPixels", "setDetectorPixelPitch",
    "setDetectorPixelSize", "setDetectorPosition", "setDetectorRightVector", "setDetectorSize", "setDetectorUpVector",
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
    return _direction(world.view().row_step) if _is_complete() else world.up


def getDetectorRightVector() -> tuple[float, ...]:
    """0, 0, 0 before source and detector are there."""
    return _direction(world.view().column_step) if _is_complete() else world.right or (0.0, 0.0, 0.0)


def _is_complete() -> bool:
    return min(world.pixels) > 0 and bool(world.size or world.spacing) and world.source != world.detector


def _direction(step: NDArray[np.float64]) -> tuple[float, ...]:
    return tuple((step / np.linalg.norm(step)).tolist())


def _three(step: NDArray[np.float64]) -> tuple[float, float, float]:
    return three(*_direction(step))


def rotateDetector(anAngle: float, x: float, y: float, z: float) -> None:
    """Turns its directions about its centre, degrees. A right vector that follows the beam goes on following it."""
    turn = rotate((x, y, z), anAngle)[:3, :3]
    if world.right is not None:
        world.right = three(*(turn @ world.right))
    world.up = three(*(turn @ world.up))


def autoAlignDetector(aFlag: bool = True) -> None:
    """Whether the right vector follows the beam, as it does until it is set; false keeps it where it is. Up stays."""
    right = np.cross(np.subtract(world.detector, world.source), world.up)
    if aFlag:
        world.right = None
    elif world.right is None and right.any():
        world.right = _three(right)


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
    """0, 0 before it is known."""
    mm = millimetres(aUnitOfLength)
    if world.spacing:
        return world.spacing[0] / mm, world.spacing[1] / mm
    if world.size and min(world.pixels) > 0:
        return world.size[0] / world.pixels[0] / mm, world.size[1] / world.pixels[1] / mm
    return 0.0, 0.0


def getDetectorPixelArea(aUnitOfLength: str) -> float:
    x, y = getDetectorPixelSpacing(aUnitOfLength)
    return x * y


def getDetectorVertices() -> tuple[float, ...]:
    """x, y, z in mm of the corners of two triangles; none before source and detector are there."""
    if not _is_complete():
        return ()
    view = world.view()
    right, up = view.column_step * view.pixels[0] / 2, view.row_step * view.pixels[1] / 2
    a, b, c, d = (view.detector + i * right + j * up for i, j in ((-1, -1), (1, -1), (1, 1), (-1, 1)))
    return tuple(float(value) for corner in (a, b, c, a, c, d) for value in corner)


def getSourceDetectorDistance(aUnitOfLength: str) -> float:
    return float(np.linalg.norm(np.subtract(world.detector, world.source))) / millimetres(aUnitOfLength)


getSDD = getSourceDetectorDistance
