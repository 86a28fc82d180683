"""Shapes that gVXR makes beside cubes, cylinders and spheres."""
from __future__ import annotations

from typing import Any

import numpy as np

from .._interface import ArgumentError
from ..mesh import Mesh
from . import packing
from .state import millimetres, world

__all__ = ["makeFoamInCuboid", "makeIsoSurface", "makeSpheresInCylinder", "makeStepWedge"]

#: Up to this share of the box, spheres find a place at random.
_LOOSE = 0.2


def makeStepWedge(aLabel: str, aNumberOfSteps: int = 10, aTotalLength: float = 10, aWidth: float = 1,
                  aFirstStepHeight: float = 1, anOtherStepHeight: float = 0.1, aUnitOfLength: str = "cm",
                  aParent: str = "root") -> None:
    """Steps along x that rise from z = 0."""
    mm = millimetres(aUnitOfLength)
    heights = (aFirstStepHeight + anOtherStepHeight * np.arange(int(aNumberOfSteps))) * mm
    made = Mesh.steps(aTotalLength * mm, aWidth * mm, heights)
    world.add(aLabel, Mesh(made.vertices + (0, 0, heights[-1] / 2), made.faces, name=aLabel), aParent)


def makeIsoSurface(aLabel: str, anIsoValue: Any, aVoxelDataSet: Any, aWidth: int, aHeight: int, aDepth: int,
                   aSpacingX: float, aSpacingY: float, aSpacingZ: float, aUnitOfLength: str = "cm",
                   aParent: str = "root") -> None:
    """The surface of a volume, [z, y, x] or a flat list of as many. The middle of its first voxel is at the spacings.

    The value may follow the volume, too.
    """
    if np.ndim(anIsoValue) > 0:  # (label, volume, value, ...)
        anIsoValue, aVoxelDataSet = aVoxelDataSet, anIsoValue
    values = np.asarray(aVoxelDataSet, dtype=float)
    if values.size != aWidth * aHeight * aDepth:
        raise ArgumentError(f"{aLabel}: the volume has {values.size} values instead of {aWidth} x {aHeight} x {aDepth}")
    steps = np.array([aSpacingX, aSpacingY, aSpacingZ], dtype=float) * millimetres(aUnitOfLength)
    centred = Mesh.isosurface(values.reshape(aDepth, aHeight, aWidth), anIsoValue, steps)
    middle = steps * (np.array([aWidth, aHeight, aDepth]) + 1) / 2
    world.add(aLabel, Mesh(centred.vertices + middle, centred.faces, name=aLabel), aParent)


def makeFoamInCuboid(aPorosityName: str, aBoundingVolumeName: str, aCuboidWidth: float, aCuboidHeight: float,
                     aCuboidDepth: float, aPorosityRadius: Any, aPercentageOfVolume: float,
                     aPercentageDeviation: float = 10, aVoxelSpacing: float = 0, aUnitOfLength: str = "mm",
                     aVerboseLevel: int = 0) -> None:
    """Spheres that do not overlap. aPorosityRadius: the mean radius, or it and its standard deviation, a length.

    There are no voxels: the pores are exact, and aVoxelSpacing and aBoundingVolumeName have no effect.
    """
    mm = millimetres(aUnitOfLength)
    radius, *deviation = np.atleast_1d(np.asarray(aPorosityRadius, dtype=float)).tolist()
    spread = deviation[0] / radius if deviation else aPercentageDeviation / 100
    box = np.array([aCuboidWidth * mm, aCuboidHeight * mm, aCuboidDepth * mm])
    share = aPercentageOfVolume / 100
    if share <= _LOOSE:
        made = Mesh.foam(box.tolist(), radius * mm, share, spread=spread, seed=world.seed)
    else:
        random = np.random.default_rng(world.seed)
        radii = packing.radii_of(box, radius * mm, spread, share, random)
        made = Mesh.spheres(packing.pack(box, radii, random), radii)
    world.add(aPorosityName, made, "root")


def makeSpheresInCylinder(aCylinderLabel: str, aCylinderNumberOfSectors: int, aCylinderRadius: float, aCylinderHeight: float,
                          aSphereLabel: str, aSphereNumberOfRings: int, aSphereNumberOfSectors: int, aSphereRadius: float,
                          aPercentVolume: float, aUnitOfLength: str = "cm", aParent: str = "root") -> int:
    """A cylinder along z and the spheres in it, which do not overlap. Returns their number, which fills the percentage."""
    mm = millimetres(aUnitOfLength)
    outer, height, radius = aCylinderRadius * mm, aCylinderHeight * mm, aSphereRadius * mm
    wanted = round(aPercentVolume / 100 * outer ** 2 * height / (4 / 3 * radius ** 3))
    places = _places(outer - radius, height / 2 - radius, radius, wanted, np.random.default_rng(world.seed))
    world.add(aCylinderLabel, Mesh.cylinder(outer, height, int(aCylinderNumberOfSectors)), aParent)
    world.add(aSphereLabel, Mesh.spheres(places, radius, int(aSphereNumberOfSectors)), aParent)
    return wanted


def _places(reach: float, half: float, radius: float, wanted: int, random: np.random.Generator) -> Any:
    """Centres of spheres in a cylinder, at random where they fit."""
    if wanted < 1 or reach <= 0 or half <= 0:
        raise ArgumentError("no sphere fits into the cylinder; give smaller spheres or a larger percentage")
    found = np.empty((wanted, 3))
    for count in range(wanted):
        for _ in range(2000):
            place = random.uniform((-reach, -reach, -half), (reach, reach, half))
            if np.hypot(*place[:2]) <= reach and (((found[:count] - place) ** 2).sum(1) >= 4 * radius ** 2).all():
                found[count] = place
                break
        else:
            raise ArgumentError(f"no place is left after {count} of {wanted} spheres; give a smaller percentage")
    return found
