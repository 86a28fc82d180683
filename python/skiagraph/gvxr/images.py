"""Images, path lengths and scans."""
from __future__ import annotations

import os
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .._interface import ArgumentError, SceneError
from .._picture import write_picture
from ..material import Material
from ..matrices import rotate
from ..mesh import Mesh
from .state import World, millimetres, three, world

__all__ = [
    "computeCTAcquisition", "computeLBuffer", "computePathLength", "computeSpectralImage", "computeXRayImage",
    "getAngleSetCT", "getLastLBuffer", "getLastProjectionSet", "getLastXRayImage", "getWhiteImage",
    "saveLastLBuffer", "saveLastPathLength", "saveLastProjectionSet", "saveLastXRayImage",
]


def computeXRayImage(anIntegrateEnergyFlag: bool = True) -> NDArray[np.float32]:
    """[row, column]: MeV per pixel, or photons per pixel."""
    scene = world.scene()
    if anIntegrateEnergyFlag:
        image = scene.image(unit="MeV", index=world.frame, **world.options())
    else:
        image = scene.image("photons", index=world.frame, **world.options())
    world.frame += world.noise
    world.images["image"] = image
    return image


def computeSpectralImage() -> NDArray[np.float32]:
    """[band, row, column]: photons per pixel in each of the bands."""
    if not world.bands:
        raise SceneError("there are no bands; call setPhotonCountingBands")
    image = world.scene().image("photons", bands=world.bands, index=world.frame, **world.options())
    world.frame += world.noise
    return image


def getLastXRayImage() -> NDArray[np.float32]:
    image: NDArray[np.float32] = _last("image", "computeXRayImage")
    return image


def _last(what: str, call: str) -> Any:
    if what not in world.images:
        raise SceneError(f"there is none yet; call {call}")
    return world.images[what]


def getWhiteImage(anIntegrateEnergyFlag: bool = True) -> NDArray[np.float32]:
    """The image without meshes; with noise another one each time."""
    white = World(**{name: getattr(world, name) for name in _SETTINGS})
    white.add("nothing", Mesh.cube(1), "root").surface = "inner"
    white.nodes["nothing"].material = Material.mu(0)
    scene = white.scene()
    image = (scene.image(unit="MeV", index=world.frame, **world.options()) if anIntegrateEnergyFlag
             else scene.image("photons", index=world.frame, **world.options()))
    world.frame += world.noise
    return image


_SETTINGS = ("source", "shape", "grid", "detector", "up", "right", "pixels", "spacing", "size", "spectrum", "per_cm2",
             "tube", "filters", "detector_keys", "noise", "seed")


def computeLBuffer(aLabel: str) -> NDArray[np.float32]:
    """Path lengths through a mesh, of an outer surface without the inner ones, [row, column], cm."""
    lengths: NDArray[np.float32] = world.scene(False).lengths(aLabel)
    lengths /= np.float32(millimetres("cm"))
    world.images["lengths"] = lengths
    return lengths


computePathLength = computeLBuffer


def getLastLBuffer() -> NDArray[np.float32]:
    lengths: NDArray[np.float32] = _last("lengths", "computeLBuffer")
    return lengths


def saveLastXRayImage(aFileName: str, useCompression: bool = True) -> None:
    """.png, .tif or .mha, in MeV. Never compressed, except PNG."""
    _save(aFileName, getLastXRayImage(), "energy", "MeV per pixel")


def saveLastLBuffer(aFileName: str, useCompression: bool = True) -> None:
    """.png, .tif or .mha, in cm."""
    _save(aFileName, getLastLBuffer(), "path length", "cm")


saveLastPathLength = saveLastLBuffer


def _save(path: str, image: NDArray[np.float32], name: str, unit: str) -> None:
    write_picture(path, image, names=[name], unit=unit, view=world.scene(False).view)


def _scan(angles: Sequence[float], axis: Sequence[float], centre: Sequence[float], integrate: bool,
          whites: int) -> NDArray[np.float32]:
    """The meshes turn about the axis: source and detector turn back."""
    scene = world.scene()
    views = [rotate(axis, -angle, about=centre) @ scene.view for angle in angles]
    options = {**world.options(), "index": world.frame}
    images = scene.images("energy" if integrate else "photons", unit="MeV" if integrate else None, views=views, **options)
    world.frame += len(views) * world.noise
    if whites > 0:
        images /= np.mean([getWhiteImage(integrate) for _ in range(whites if world.noise else 1)], axis=0)
    return images


def computeCTAcquisition(aProjectionOutputPath: str, aScreenshotOutputPath: str, aNumberOfProjections: int,
                         aFirstAngle: float, anIncludeLastAngleFlag: bool, aLastAngle: float,
                         aNumberOfWhiteImagesInFlatField: int, aPositionOfCentreOfRotationX: float,
                         aPositionOfCentreOfRotationY: float, aPositionOfCentreOfRotationZ: float, aUnitOfLength: str,
                         aAxisOfRotationX: float, aAxisOfRotationY: float, aAxisOfRotationZ: float,
                         anIntegrateEnergyFlag: bool = True, aVerboseLevel: int = 0) -> None:
    """A circular scan; getLastProjectionSet gives it, [n, row, column]. With white images: divided by their mean."""
    count = int(aNumberOfProjections)
    if count < 1:
        raise ArgumentError(f"{count} projections; at least 1")
    angles = np.linspace(aFirstAngle, aLastAngle, count, endpoint=bool(anIncludeLastAngleFlag)).tolist()
    centre = three(aPositionOfCentreOfRotationX, aPositionOfCentreOfRotationY, aPositionOfCentreOfRotationZ,
                    millimetres(aUnitOfLength))
    axis = three(aAxisOfRotationX, aAxisOfRotationY, aAxisOfRotationZ)
    images = _scan(angles, axis, centre, bool(anIntegrateEnergyFlag), int(aNumberOfWhiteImagesInFlatField))
    world.images["scan"], world.angles = images, angles
    if aProjectionOutputPath:
        os.makedirs(aProjectionOutputPath, exist_ok=True)
        for i, image in enumerate(images):
            _save(os.path.join(aProjectionOutputPath, f"projection-{i:05}.tif"), image, "projection", "")


def getLastProjectionSet() -> NDArray[np.float32]:
    images: NDArray[np.float32] = _last("scan", "computeCTAcquisition")
    return images


def getAngleSetCT() -> tuple[float, ...]:
    return tuple(world.angles)


def saveLastProjectionSet(aFileName: str, useCompression: bool = True) -> None:
    """One file with a page or channel a projection."""
    _save(aFileName, getLastProjectionSet(), "projection", "")
