"""The readout of the detector: an image times a gain, plus a bias that varies from pixel to pixel, as 16-bit whole numbers."""
from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from .images import blank, computeXRayImage, getWhiteImage, getWhiteSpectralImage, save
from .scans import computeCTAcquisition
from .state import world
from .tube import getTotalEnergyWithDetectorResponse, getTotalEnergyWithoutDetectorResponse

__all__ = [
    "computeCTAcquisitionWithGain", "computeXRayImageWithGain", "getDetectorBias", "getDetectorGain", "getDetectorStdDevBias",
    "getLastProjectionSetWithGain", "getNoiseGenerator", "getTotalEnergyWithDetectorResponseWithGain",
    "getTotalEnergyWithoutDetectorResponseWithGain", "getWhiteImageWithGain", "getWhiteSpectralImageWithGain",
    "saveLastXRayImageWithGain", "setDetectorBias", "setDetectorGain", "setDetectorStdDevBias",
]


def setDetectorGain(aGain: float) -> None:
    """The factor of the ...WithGain images, 1 until it is set."""
    world.gain = float(aGain)


def getDetectorGain() -> float:
    """The factor of the ...WithGain images."""
    return world.gain


def setDetectorBias(aBias: float) -> None:
    """Sets the bias that is added to the ...WithGain images, in their unit."""
    world.bias = float(aBias)


def getDetectorBias() -> float:
    """The bias that is added to the ...WithGain images."""
    return world.bias


def setDetectorStdDevBias(aStdDevBias: float) -> None:
    """The standard deviation of the bias, from pixel to pixel and from image to image."""
    world.bias_deviation = float(aStdDevBias)


def getDetectorStdDevBias() -> float:
    """The standard deviation of the bias."""
    return world.bias_deviation


def getNoiseGenerator() -> str:
    """Where the random numbers of the noise come from."""
    return "Skiagraph, by seed, frame and pixel"


#: The greatest number of the readout.
FULL = 65535


def _with_gain(image: Any) -> NDArray[np.uint16]:
    """Gain x image + bias, rounded, from 0 to 65535; the next call has another bias noise."""
    made = np.asarray(image, np.float32) * np.float32(world.gain) + np.float32(world.bias)
    if world.bias_deviation > 0:
        random = np.random.default_rng((world.seed, world.readouts))
        made += world.bias_deviation * random.standard_normal(made.shape, np.float32)
        world.readouts += 1
    read: NDArray[np.uint16] = np.rint(made).clip(0, FULL).astype(np.uint16)
    return read


def computeXRayImageWithGain(anIntegrateEnergyFlag: Any = True, anotherFlag: bool = True) -> NDArray[np.uint16]:
    """computeXRayImage with gain and bias. An array before the flag is filled with the image besides."""
    into = anIntegrateEnergyFlag if isinstance(anIntegrateEnergyFlag, np.ndarray) else None
    image = _with_gain(computeXRayImage(anIntegrateEnergyFlag if into is None else anotherFlag))
    if into is not None:
        into[...] = image
    world.images["gain"] = image
    return image


def saveLastXRayImageWithGain(aFileName: str = "image.tif", useCompression: bool = True) -> None:
    """The formats of saveLastXRayImage."""
    save(aFileName, world.images.get("gain", blank()), "energy", "MeV per pixel")


def getWhiteImageWithGain(anIntegrateEnergyFlag: bool = True) -> NDArray[np.uint16]:
    """getWhiteImage with gain and bias."""
    return _with_gain(getWhiteImage(anIntegrateEnergyFlag))


def getWhiteSpectralImageWithGain() -> NDArray[np.uint16]:
    """getWhiteSpectralImage with gain and bias."""
    return _with_gain(getWhiteSpectralImage())


def computeCTAcquisitionWithGain(*arguments: Any, **keys: Any) -> NDArray[np.float32]:
    """computeCTAcquisition with its arguments; projections and white images have gain and bias."""
    images = computeCTAcquisition(*arguments, **keys, _read=_with_gain)
    world.images["scan with gain"] = images
    return images


def getLastProjectionSetWithGain() -> NDArray[np.float32]:
    """[n, row, column]; n is 0 before the first scan with gain."""
    images: NDArray[np.float32] = world.images.get("scan with gain", blank()[None][:0])
    return images


def getTotalEnergyWithDetectorResponseWithGain(anApplyFiltrationFlag: bool = True) -> float:
    """getTotalEnergyWithDetectorResponse as a pixel is read: the mean of getWhiteImageWithGain without falloff."""
    return _total(getTotalEnergyWithDetectorResponse(anApplyFiltrationFlag))


def getTotalEnergyWithoutDetectorResponseWithGain(anApplyFiltrationFlag: bool = True) -> float:
    """getTotalEnergyWithoutDetectorResponse as a pixel is read."""
    return _total(getTotalEnergyWithoutDetectorResponse(anApplyFiltrationFlag))


def _total(energy: float) -> float:
    """As a pixel is read."""
    return float(min(max(round(world.gain * energy + world.bias), 0), FULL))
