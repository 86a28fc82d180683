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


def makeIsoSurface(aLabel: str, *arguments: Any) -> None:
    """The surface of a volume [z, y, x]: (volume, value, cx, cy, cz, sx, sy, sz, unit, parent), centred at cx, cy, cz.

    A volume of whole numbers may have two values: what lies from the one to the other is inside. A flat volume comes with its
    width, height and depth instead of a centre, after or before the value; the middle of its first voxel is at the spacings.
    """
    words = [word for word in arguments if isinstance(word, str)]
    numbers = list(arguments[:len(arguments) - len(words)])
    if words and isinstance(arguments[-1], (bool, int)):  # a flag after the parent, which has no effect
        numbers = list(arguments[:-1 - len(words)])
    unit, parent = [*words, *("cm", "root")[len(words):]]
    value_first = np.ndim(numbers[0]) == 0
    volume = np.asarray(numbers.pop(1 if value_first else 0))
    *values, x, y, z, sx, sy, sz = numbers
    steps = np.array([sx, sy, sz], dtype=float) * millimetres(unit)
    if volume.ndim == 3 and not value_first:
        middle = np.array([x, y, z], dtype=float) * millimetres(unit)
    else:
        if volume.size != x * y * z:
            raise ArgumentError(f"{aLabel}: the volume has {volume.size} values instead of {x} x {y} x {z}")
        volume, middle = volume.reshape(z, y, x), steps * (np.array([x, y, z]) + 1) / 2
    if volume.dtype.kind in "biu" and not value_first or len(values) == 2:  # whole numbers: the surface lies between the voxels
        low, high = [*values, np.inf][:2]
        volume, values = ((volume >= low) & (volume <= high)).astype(np.float32), [0.5]
    centred = Mesh.isosurface(np.asarray(volume, dtype=float), values[0], steps)
    world.add(aLabel, Mesh(centred.vertices + middle, centred.faces, name=aLabel), parent)


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
