"""Beginning anew, units, scene files."""
from __future__ import annotations

from .. import _library
from .._device import device_of
from .state import ENERGIES, LENGTHS, unit, world

__all__ = [
    "destroy", "destroyAllWindows", "getMajorVersionOfCoreGVXR", "getMajorVersionOfSimpleGVXR", "getMinorVersionOfCoreGVXR",
    "getMinorVersionOfSimpleGVXR", "getOpenGlRenderer", "getOpenGlVendor", "getOpenGlVersion", "getPatchVersionOfCoreGVXR",
    "getPatchVersionOfSimpleGVXR", "getUnitOfEnergy", "getUnitOfLength", "getVersionOfCoreGVXR", "getVersionOfSimpleGVXR",
    "loadSceneFile", "terminate",
]

#: The release of gVXR whose calls these are.
_RELEASE = (2, 1, 0)


def destroyAllWindows() -> None:
    """Forgets everything: meshes, source, detector."""
    world.reset()


destroy = terminate = destroyAllWindows


def getUnitOfLength(aUnitOfLength: str) -> float:
    return unit(aUnitOfLength, LENGTHS)


def getUnitOfEnergy(aUnitOfEnergy: str) -> float:
    return unit(aUnitOfEnergy, ENERGIES) / unit("MeV", ENERGIES)


def loadSceneFile(aFileName: str) -> None:
    """Ours: replaces what is set by a scene file ("JSON 1.0.0"), which gVXR reads by its module json2gvxr.

    The meshes of the file, its focal spot and its detector's response, blur and oversampling stay; the rest may change.
    """
    world.load(aFileName)


def getMajorVersionOfCoreGVXR() -> int:
    """Of the gVXR whose calls these are; the name of Skiagraph is in getVersionOfCoreGVXR."""
    return _RELEASE[0]


def getMinorVersionOfCoreGVXR() -> int:
    return _RELEASE[1]


def getPatchVersionOfCoreGVXR() -> int:
    return _RELEASE[2]


getMajorVersionOfSimpleGVXR = getMajorVersionOfCoreGVXR
getMinorVersionOfSimpleGVXR = getMinorVersionOfCoreGVXR
getPatchVersionOfSimpleGVXR = getPatchVersionOfCoreGVXR


def getVersionOfCoreGVXR() -> str:
    """Says that it is Skiagraph."""
    return f"Skiagraph {_library.text(_library.lib.skg_version())}, with the calls of gVXR {'.'.join(map(str, _RELEASE))}"


getVersionOfSimpleGVXR = getVersionOfCoreGVXR


def getOpenGlVendor() -> str:
    """OpenGL is not used: of the device of OpenCL."""
    return str(device_of(None).info["platform_name"])


def getOpenGlRenderer() -> str:
    """OpenGL is not used: the device of OpenCL."""
    return str(device_of(None).info["name"])


def getOpenGlVersion() -> str:
    """OpenGL is not used: of the driver of OpenCL."""
    return "OpenCL, " + str(device_of(None).info["driver"])
