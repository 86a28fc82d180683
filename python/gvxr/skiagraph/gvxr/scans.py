"""CT scans."""
from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .._device import warn
from .._interface import ArgumentError
from ..matrices import rotate
from ..view import View
from .images import blank, getWhiteImage, save
from .space import getMagnification
from .state import millimetres, three, world

__all__ = [
    "computeCTAcquisition", "getAngleSetCT", "getCentreOfRotationPositionCT", "getDetectorPositionSet",
    "getDetectorRightVectorSet", "getDetectorUpVectorSet", "getFirstAngleCT", "getIncludeLastAngleFlagCT", "getLastAngleCT",
    "getLastProjectionSet", "getNumberOfProjectionsCT", "getOptimalNumberOfProjectionsCT", "getProjectionOutputPathCT",
    "getRotationAxisCT", "getScreenshotOutputPathCT", "getSourcePositionSet", "getWhiteImagesInFlatFieldCT",
    "saveLastProjectionSet",
]


def _as_is(image: Any) -> NDArray[np.float32]:
    made: NDArray[np.float32] = image
    return made


def _project(views: Sequence[View], integrate: bool, whites: int, read: Callable[[Any], NDArray[Any]]) -> NDArray[np.float32]:
    if not world.has_beam():
        warn("there is no beam, so that the projections are 0; call setMonoChromatic, addEnergyBinToSpectrum or setVoltage")
        return read(np.stack([blank()] * len(views))).astype(np.float32)
    options = {**world.options(), "index": world.frame}
    seen = world.scene().images("energy" if integrate else "photons", unit="MeV" if integrate else None, views=views, **options)
    images = read(seen).astype(np.float32, copy=False)
    world.frame += len(views) * world.noise
    if whites > 0:
        varies = world.noise or world.bias_deviation > 0
        images /= np.mean([read(getWhiteImage(integrate)) for _ in range(whites if varies else 1)], axis=0)
    return images


def angles_of(count: int, first: float, last: float, closed: bool) -> list[float]:
    """Degrees; closed: the last angle is that of the last projection."""
    made: list[float] = np.linspace(first, last, count, endpoint=closed).tolist()
    return made


def computeCTAcquisition(aProjectionOutputPath: str, aScreenshotOutputPath: str, aNumberOfProjections: int,
                         aFirstAngle: float, anIncludeLastAngleFlag: bool, aLastAngle: float,
                         aNumberOfWhiteImagesInFlatField: int, aPositionOfCentreOfRotationX: float,
                         aPositionOfCentreOfRotationY: float, aPositionOfCentreOfRotationZ: float, aUnitOfLength: str,
                         aAxisOfRotationX: float, aAxisOfRotationY: float, aAxisOfRotationZ: float,
                         anIntegrateEnergyFlag: bool = True, aVerboseLevel: int = 0, *,
                         _read: Callable[[Any], NDArray[Any]] = _as_is) -> NDArray[np.float32]:
    """A circular scan, [n, row, column]. With white images: divided by their mean. The meshes turn about the axis.

    aProjectionOutputPath: a folder, which gets a TIFF for each projection, or a file, .tif or .mha; "": none.
    """
    count = int(aNumberOfProjections)
    if count < 1:
        raise ArgumentError(f"{count} projections; at least 1")
    angles = angles_of(count, aFirstAngle, aLastAngle, bool(anIncludeLastAngleFlag))
    centre = three(aPositionOfCentreOfRotationX, aPositionOfCentreOfRotationY, aPositionOfCentreOfRotationZ,
                   millimetres(aUnitOfLength))
    axis, view = three(aAxisOfRotationX, aAxisOfRotationY, aAxisOfRotationZ), world.view()
    views = [rotate(axis, -angle, about=centre) @ view for angle in angles]  # source and detector turn back
    whites = int(aNumberOfWhiteImagesInFlatField)
    images = _project(views, bool(anIntegrateEnergyFlag), whites, _read)
    world.images["scan"] = images
    world.scan = {"path": str(aProjectionOutputPath), "pictures": str(aScreenshotOutputPath), "first": float(aFirstAngle),
                  "last": float(aLastAngle), "closed": bool(anIncludeLastAngleFlag), "whites": whites, "centre": centre,
                  "axis": axis, "angles": angles, "views": views}
    if aScreenshotOutputPath:
        warn(f"{aScreenshotOutputPath}: no screenshots are written; takeScreenshot makes one")
    if aProjectionOutputPath:
        _write(str(aProjectionOutputPath), images)
    return images


def _write(path: str, images: NDArray[np.float32]) -> None:
    if os.path.splitext(path)[1].lower() in (".tif", ".tiff", ".mha"):
        os.makedirs(os.path.dirname(path) or ".", exist_ok=True)
        saveLastProjectionSet(path)
        return
    os.makedirs(path, exist_ok=True)
    for i, image in enumerate(images):
        save(os.path.join(path, f"projection_{i:04}.tiff"), image, "projection", "")


def getLastProjectionSet() -> NDArray[np.float32]:
    """[n, row, column]; n is 0 before the first scan."""
    images: NDArray[np.float32] = world.images.get("scan", blank()[None][:0])
    return images


def saveLastProjectionSet(aFileName: str = "projections.tif", useCompression: bool = True) -> None:
    """One file with a page or channel a projection."""
    save(aFileName, getLastProjectionSet(), "projection", "")


def _said(name: str, default: Any) -> Any:
    return world.scan.get(name, default)


def _in(position: Any, length: str) -> tuple[float, float, float]:
    """A position in mm in another unit."""
    return three(*(np.asarray(position, dtype=float) / millimetres(length)))


def getAngleSetCT() -> tuple[float, ...]:
    return tuple(_said("angles", ()))


def getNumberOfProjectionsCT() -> int:
    return len(_said("angles", ()))


def getFirstAngleCT() -> float:
    return float(_said("first", 0))


def getLastAngleCT() -> float:
    return float(_said("last", 0))


def getIncludeLastAngleFlagCT() -> bool:
    return bool(_said("closed", False))


def getProjectionOutputPathCT() -> str:
    return str(_said("path", ""))


def getScreenshotOutputPathCT() -> str:
    return str(_said("pictures", ""))


def getWhiteImagesInFlatFieldCT() -> int:
    return int(_said("whites", 0))


def getCentreOfRotationPositionCT(aUnitOfLength: str) -> tuple[float, float, float]:
    return _in(_said("centre", (0, 0, 0)), aUnitOfLength)


def getRotationAxisCT() -> tuple[float, float, float]:
    return three(*_said("axis", (0, 0, 0)))


def getOptimalNumberOfProjectionsCT() -> int:
    """As many as half the circumference of the field of view has pixels."""
    return round(np.pi * world.pixels[0] / getMagnification())


def getSourcePositionSet(aUnitOfLength: str) -> tuple[tuple[float, float, float], ...]:
    return tuple(_in(view.source, aUnitOfLength) for view in _said("views", ()))


def getDetectorPositionSet(aUnitOfLength: str) -> tuple[tuple[float, float, float], ...]:
    return tuple(_in(view.detector, aUnitOfLength) for view in _said("views", ()))


def getDetectorRightVectorSet() -> tuple[tuple[float, float, float], ...]:
    return tuple(three(*(view.column_step / np.linalg.norm(view.column_step))) for view in _said("views", ()))


def getDetectorUpVectorSet() -> tuple[tuple[float, float, float], ...]:
    return tuple(three(*(view.row_step / np.linalg.norm(view.row_step))) for view in _said("views", ()))
