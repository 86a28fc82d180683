"""Images and path lengths."""
from __future__ import annotations

import dataclasses
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .._device import warn
from .._interface import SceneError
from .._picture import write_picture
from .files import write_other
from .state import Node, World, millimetres, world

__all__ = [
    "computeLBuffer", "computePathLength", "computeSpectralImage", "computeXRayImage", "getLastLBuffer", "getLastXRayImage",
    "getWhiteImage", "getWhiteSpectralImage", "saveLastLBuffer", "saveLastPathLength", "saveLastXRayImage",
]


def blank() -> NDArray[np.float32]:
    """Zeros of the size of the detector."""
    return np.zeros((world.pixels[1], world.pixels[0]), np.float32)


def _image(of: World, integrate: bool) -> NDArray[np.float32]:
    """MeV or photons per pixel; numbers the frame for the noise."""
    if not world.has_beam():
        warn("there is no beam, so that the image is 0; call setMonoChromatic, addEnergyBinToSpectrum or setVoltage")
        return blank()
    scene = of.scene()
    options = {**world.options(), "index": world.frame}
    image = scene.image(unit="MeV", **options) if integrate else scene.image("photons", **options)
    world.frame += world.noise
    return image


def computeXRayImage(anIntegrateEnergyFlag: Any = True, anotherFlag: bool = True) -> NDArray[np.float32]:
    """[row, column]: MeV per pixel, or photons per pixel. An array before the flag is filled with the image besides."""
    into = anIntegrateEnergyFlag if isinstance(anIntegrateEnergyFlag, np.ndarray) else None
    image = _image(world, bool(anIntegrateEnergyFlag) if into is None else anotherFlag)
    if into is not None:
        into[...] = image
    world.images["image"] = image
    return image


def _bands(of: World) -> NDArray[np.float32]:
    if not world.bands:
        raise SceneError("there are no bands; call setPhotonCountingBands")
    image = of.scene().image("photons", bands=world.bands, index=world.frame, **world.options())
    world.frame += world.noise
    return image


def computeSpectralImage() -> NDArray[np.float32]:
    """[band, row, column]: photons per pixel in each of the bands."""
    return _bands(world)


def getWhiteSpectralImage() -> NDArray[np.float32]:
    """Photons per pixel in each of the bands without the meshes, [band, row, column]."""
    return _bands(_white())


def getLastXRayImage() -> NDArray[np.float32]:
    """Zeros before the first image."""
    image: NDArray[np.float32] = world.images.get("image", blank())
    return image


def _white() -> World:
    """The world without its meshes."""
    return dataclasses.replace(world, nodes={"root": Node("")}, _scene=None, _made_of=None)


def getWhiteImage(anIntegrateEnergyFlag: bool = True) -> NDArray[np.float32]:
    """The image without meshes; with noise another one each time."""
    return _image(_white(), anIntegrateEnergyFlag)


def computeLBuffer(aLabel: str) -> NDArray[np.float32]:
    """Path lengths through a mesh, of an outer surface without the inner ones, [row, column], cm."""
    if not world.node(aLabel).surface:
        raise SceneError(f"{aLabel}: is not in the X-ray renderer; call addPolygonMeshAsInnerSurface")
    lengths: NDArray[np.float32] = world.scene(world.has_beam() and _has_materials()).lengths(aLabel)
    lengths /= np.float32(millimetres("cm"))
    world.images["lengths"] = lengths
    return lengths


def _has_materials() -> bool:
    return all(node.material is not None for node in world.nodes.values() if node.surface)


computePathLength = computeLBuffer


def getLastLBuffer() -> NDArray[np.float32]:
    """Zeros before the first one."""
    lengths: NDArray[np.float32] = world.images.get("lengths", blank())
    return lengths


def saveLastXRayImage(aFileName: str = "image.tif", useCompression: bool = True) -> None:
    """.png, .tif, .mha, .mhd with .raw, .txt or .dcm, in MeV. Never compressed, except PNG."""
    save(aFileName, getLastXRayImage(), "energy", "MeV per pixel")


def saveLastLBuffer(aFileName: str = "lengths.tif", useCompression: bool = True) -> None:
    """.png, .tif, .mha, .mhd with .raw, .txt or .dcm, in cm."""
    save(aFileName, getLastLBuffer(), "path length", "cm")


saveLastPathLength = saveLastLBuffer


def save(path: str, image: Any, name: str, unit: str) -> None:
    """Writes an image of the detector, or several."""
    view = world.view()
    spacing = float(np.linalg.norm(view.column_step)), float(np.linalg.norm(view.row_step))
    if not write_other(path, image, spacing, f"{name} ({unit})" if unit else name):
        write_picture(path, image, names=[name], unit=unit, view=view)
