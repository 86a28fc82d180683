"""gVXR's comparisons of arrays: means, extremes, correlation and errors."""
from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from .._interface import ArgumentError
from ..matrices import rotate
from .state import three, world

__all__ = [
    "computeRMSE", "computeZNCC", "getImageHeght", "getImageRow", "getImageWidth", "getMaxValue", "getMean", "getMinValue",
    "getPSNR", "getStddev", "lineariseTest", "loadReference", "loadTest", "radian2degree",
]


def _array(values: Any) -> NDArray[np.float64]:
    found = np.asarray(values, dtype=float)
    if not found.size:
        raise ArgumentError("the array is empty")
    return found


def getMinValue(a3DVolume: Any) -> float:
    return float(_array(a3DVolume).min())


def getMaxValue(a3DVolume: Any) -> float:
    return float(_array(a3DVolume).max())


def getMean(anImage: Any) -> float:
    return float(_array(anImage).mean())


def getStddev(anImage: Any) -> float:
    return float(_array(anImage).std())


def getImageWidth(anImage: Any) -> int:
    return int(np.shape(anImage)[1])


def getImageHeght(anImage: Any) -> int:
    return int(np.shape(anImage)[0])


def getImageRow(anImage: Any, j: int) -> NDArray[np.float64]:
    row: NDArray[np.float64] = _array(anImage)[int(j)]
    return row


def loadReference(aReferenceSet: Any) -> None:
    """For computeZNCC and computeRMSE without arguments."""
    world.images["reference"] = _array(aReferenceSet).ravel()


def loadTest(aTestSet: Any) -> None:
    """For computeZNCC and computeRMSE without arguments."""
    world.images["test"] = _array(aTestSet).ravel()


def lineariseTest(aThreshold: float, aScalingFactor: float) -> None:
    """Of the test: -log(factor x value), values below the threshold counting as the threshold."""
    test, = _pair((), "test")
    world.images["test"] = -np.log(aScalingFactor * np.maximum(aThreshold, test))


def _pair(arguments: tuple[Any, ...], *names: str) -> list[NDArray[np.float64]]:
    """The arrays that were given, or those that were loaded."""
    for name in names[len(arguments):]:
        if name not in world.images:
            raise ArgumentError(f"there is no {name}; call load{name.capitalize()}, or give the arrays")
    found = [_array(value).ravel() for value in arguments] or [world.images[name] for name in names]
    if len({len(values) for values in found}) > 1:
        raise ArgumentError(f"the arrays have {' and '.join(str(len(values)) for values in found)} values; give as many")
    return found


def computeZNCC(*arguments: Any) -> float:
    """The zero-normalised cross-correlation of two arrays, -1 to 1."""
    a, b = _pair(arguments, "reference", "test")
    return float(np.mean((a - a.mean()) * (b - b.mean())) / (a.std() * b.std()))


def computeRMSE(*arguments: Any) -> float:
    """The root of the mean squared difference of two arrays."""
    a, b = _pair(arguments, "reference", "test")
    return float(np.sqrt(np.mean((a - b) ** 2)))


def getPSNR(aNumberOfRotation: int = 8, anAngularStepSize: float = 45.0) -> float:
    """dB: the greatest value of the images without noise over the root of the mean squared noise; the meshes turn about
    the detector's up vector."""
    scene, view = world.scene(), world.view()
    views = [rotate(three(*world.up), -k * anAngularStepSize) @ view for k in range(max(int(aNumberOfRotation), 1))]
    clean = scene.images(views=views, noise=False, response=world.response)
    noisy = scene.images(views=views, noise=True, noise_seed=world.seed, index=world.frame, response=world.response)
    return float(20 * np.log10(clean.max() / np.sqrt(np.mean((noisy.astype(float) - clean) ** 2))))


def radian2degree(anAngle: float) -> float:
    return float(np.degrees(anAngle))
