"""Beginning anew, units, scene files."""
from __future__ import annotations

from .state import ENERGIES, LENGTHS, unit, world

__all__ = [
    "destroy", "destroyAllWindows", "getUnitOfEnergy", "getUnitOfLength", "loadSceneFile", "terminate",
]


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
