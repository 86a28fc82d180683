"""Implicit surfaces: densities about points and line segments, their volume, and a mesh of it."""
from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .._interface import ArgumentError, SceneError
from ..mesh import Mesh
from .state import millimetres, world

__all__ = [
    "addControlLineSegment", "addControlPoint", "createImplicitSurface", "createMeshFromImplicitSurface",
    "destroyAllImplicitSurfaces", "destroyImplicitSurface", "getImplicitSurfaceLabelSet", "getImplicitSurfaceLastVoxelisation",
    "getImplicitSurfaceLastVoxelization", "getNumberOfControlLineSegments", "getNumberOfControlPoints",
    "getNumberOfImplicitSurfaces", "implicitSurfaceExists", "setControlLineSegmentParameters", "setControlPointParameters",
    "voxeliseImplicitSurface", "voxelizeImplicitSurface",
]

_Values = NDArray[np.float64]


def _metaball(r: _Values, a: float, b: float) -> _Values:
    near = a * (1 - 3 * (r / b) ** 2)
    return np.where(r <= b / 3, near, np.where(r <= b, 1.5 * a * (1 - r / b) ** 2, 0.0))


def _soft_object(r: _Values, a: float, b: float) -> _Values:
    s = (r / b) ** 2
    return np.where(r <= b, a * (1 - 4 * s ** 3 / 9 + 17 * s ** 2 / 9 - 22 * s / 9), 0.0)


#: The densities that gVXR documents, by the distance in mm.
_DENSITIES: dict[str, Callable[[_Values, float, float], _Values]] = {
    "sphere": lambda r, a, b: 1 / np.maximum(r, 1e-6) ** 2, "blobbymolecule": lambda r, a, b: a * np.exp(-b * r ** 2),
    "metaball": _metaball, "softobject": _soft_object}


@dataclass
class _Surface:
    #: [from, to, density, a, b]; a point has one place twice.
    points: list[list[Any]] = field(default_factory=list)
    lines: list[list[Any]] = field(default_factory=list)
    volume: NDArray[np.float32] | None = None
    spacing: tuple[float, float, float] = (1.0, 1.0, 1.0)
    centre: tuple[float, float, float] = (0.0, 0.0, 0.0)


def _surfaces() -> dict[str, _Surface]:
    found: dict[str, _Surface] = world.look.setdefault("implicit", {})
    return found


def _surface(label: str) -> _Surface:
    if label not in _surfaces():
        raise SceneError(f"there is no implicit surface {label!r}; there are {', '.join(map(repr, _surfaces())) or 'none'}")
    return _surfaces()[label]


def _density(name: str) -> str:
    plain = name.lower().replace(" ", "").replace("_", "")
    if plain not in _DENSITIES:
        raise ArgumentError(f"the density {name!r} is unknown; there are sphere, blobby molecule, metaball and soft object")
    return plain


def createImplicitSurface(aLabel: str) -> None:
    _surfaces()[aLabel] = _Surface()


def destroyImplicitSurface(aLabel: str) -> None:
    """One that is not there stays so."""
    _surfaces().pop(aLabel, None)


def destroyAllImplicitSurfaces() -> None:
    _surfaces().clear()


def getNumberOfImplicitSurfaces() -> int:
    return len(_surfaces())


def getImplicitSurfaceLabelSet() -> tuple[str, ...]:
    return tuple(_surfaces())


def implicitSurfaceExists(aLabel: str) -> bool:
    return aLabel in _surfaces()


def addControlPoint(aLabel: str, aPositionX: float, aPositionY: float, aPositionZ: float, aUnitOfLength: str,
                    aDentityFunction: str, aParameterA: float, aParameterB: float = 0.0) -> None:
    """b is in mm."""
    place = np.array([aPositionX, aPositionY, aPositionZ], dtype=float) * millimetres(aUnitOfLength)
    _surface(aLabel).points.append([place, place, _density(aDentityFunction), float(aParameterA), float(aParameterB)])


def addControlLineSegment(aLabel: str, aPosition1X: float, aPosition1Y: float, aPosition1Z: float, aPosition2X: float,
                          aPosition2Y: float, aPosition2Z: float, aUnitOfLength: str, aDentityFunction: str,
                          aParameterA: float, aParameterB: float = 0.0) -> None:
    """b is in mm."""
    mm = millimetres(aUnitOfLength)
    ends = (np.array([aPosition1X, aPosition1Y, aPosition1Z]) * mm, np.array([aPosition2X, aPosition2Y, aPosition2Z]) * mm)
    _surface(aLabel).lines.append([*ends, _density(aDentityFunction), float(aParameterA), float(aParameterB)])


def _change(found: list[list[Any]], number: int, density: str, a: float, b: float) -> None:
    if not 0 <= number < len(found):
        raise ArgumentError(f"there is no number {number}; there are {len(found)}, counted from 0")
    found[number][2:] = [_density(density), float(a), float(b)]


def setControlPointParameters(aLabel: str, aPointID: int, aDentityFunction: str, aParameterA: float,
                              aParameterB: float = 0.0) -> None:
    _change(_surface(aLabel).points, aPointID, aDentityFunction, aParameterA, aParameterB)


def setControlLineSegmentParameters(aLabel: str, aLineSegmentID: int, aDentityFunction: str, aParameterA: float,
                                    aParameterB: float = 0.0) -> None:
    _change(_surface(aLabel).lines, aLineSegmentID, aDentityFunction, aParameterA, aParameterB)


def getNumberOfControlPoints(aLabel: str) -> int:
    return len(_surface(aLabel).points)


def getNumberOfControlLineSegments(aLabel: str) -> int:
    return len(_surface(aLabel).lines)


def voxeliseImplicitSurface(aLabel: str, aNumberOfVoxelX: int, aNumberOfVoxelY: int, aNumberOfVoxelZ: int,
                            aCentrePositionX: float, aCentrePositionY: float, aCentrePositionZ: float, aVoxelWidth: float,
                            aVoxelHeight: float, aVoxelDepth: float, aUnitOfLength: str, aVerboseLevel: int = 0) -> None:
    """The sum of the densities at the middle of each voxel."""
    surface, mm = _surface(aLabel), millimetres(aUnitOfLength)
    surface.spacing = aVoxelWidth * mm, aVoxelHeight * mm, aVoxelDepth * mm
    surface.centre = aCentrePositionX * mm, aCentrePositionY * mm, aCentrePositionZ * mm
    counts = (aNumberOfVoxelX, aNumberOfVoxelY, aNumberOfVoxelZ)
    x, y, z = ((np.arange(n) - (n - 1) / 2) * step + middle for n, step, middle in zip(counts, surface.spacing, surface.centre))
    places = np.stack(np.broadcast_arrays(x, y[:, None], z[:, None, None]), axis=-1)
    volume = np.zeros(places.shape[:3])
    for start, end, density, a, b in surface.points + surface.lines:
        along = end - start
        share = np.clip((places - start) @ along / max(float(along @ along), 1e-30), 0, 1)
        distance = np.linalg.norm(places - start - share[..., None] * along, axis=-1)
        volume += _DENSITIES[density](distance, a, b)
    surface.volume = volume.astype(np.float32)


voxelizeImplicitSurface = voxeliseImplicitSurface


def getImplicitSurfaceLastVoxelisation(aLabel: str) -> NDArray[np.float32]:
    """[z, y, x]"""
    volume = _surface(aLabel).volume
    if volume is None:
        raise SceneError(f"{aLabel}: has no volume yet; call voxeliseImplicitSurface")
    return volume


getImplicitSurfaceLastVoxelization = getImplicitSurfaceLastVoxelisation


def createMeshFromImplicitSurface(aImplicitSurfaceLabel: str, aMeshLabel: Any, aLowerIsoValue: Any = None,
                                  anUpperIsoValue: Any = None, aParent: Any = "root", aVerboseLevel: int = 0) -> None:
    """(surface, mesh, iso value), or (surface, mesh, lower, upper value): where the volume lies between them. A parent and a
    level of words may follow. (surface, iso value), as gVXR 2.0 has it, names the mesh as the surface."""
    if aLowerIsoValue is None:
        aMeshLabel, aLowerIsoValue = aImplicitSurfaceLabel, aMeshLabel
    if isinstance(anUpperIsoValue, str):
        anUpperIsoValue, aParent = None, anUpperIsoValue
    surface, volume = _surface(aImplicitSurfaceLabel), getImplicitSurfaceLastVoxelisation(aImplicitSurfaceLabel)
    above = volume.astype(float) - aLowerIsoValue
    if anUpperIsoValue is not None:
        above = np.minimum(above, anUpperIsoValue - volume)
    made = Mesh.isosurface(above, 0, surface.spacing)
    world.add(aMeshLabel, Mesh(made.vertices + np.array(surface.centre), made.faces, name=aMeshLabel), aParent)
