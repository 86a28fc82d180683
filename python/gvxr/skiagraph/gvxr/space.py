"""Distances and magnification, and a mesh that is moved to a distance."""
from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from .._interface import SceneError
from ..matrices import translate
from .detector import getDetectorPixelSpacing, getDetectorSize, getSourceDetectorDistance
from .state import millimetres, world

__all__ = [
    "applySOD", "getBestSOD", "getFOV", "getFieldOfView", "getMagnification", "getODD", "getObjectDetectorDistance",
    "getProjectionPixelSize", "getSOD", "getSourceObjectDistance", "getVisibilityCheckReport",
]


def _middle(label: str) -> NDArray[np.float64]:
    bounds = world.bounds(world.below(label))
    return (bounds[:3] + bounds[3:]) / 2


def getSOD(*arguments: str) -> float:
    """(unit), or (label, unit): from the source to the middle of the bounds of a mesh, or of all."""
    *label, length = arguments
    return float(np.linalg.norm(_middle(*label or ("root",)) - world.source)) / millimetres(length)


getSourceObjectDistance = getSOD


def getODD(aUnitOfLength: str) -> float:
    """From the middle of the bounds of all meshes to that of the detector."""
    return float(np.linalg.norm(_middle("root") - world.detector)) / millimetres(aUnitOfLength)


getObjectDetectorDistance = getODD


def getMagnification() -> float:
    """At the middle of the bounds of all meshes; 1 in a parallel beam."""
    return 1.0 if world.shape == "ParallelBeam" else getSourceDetectorDistance("mm") / getSOD("mm")


def getFOV(aUnitOfLength: str) -> float:
    """The width that the detector sees there."""
    return getDetectorSize(aUnitOfLength)[0] / getMagnification()


getFieldOfView = getFOV


def getProjectionPixelSize(aUnitOfLength: str) -> tuple[float, float]:
    """The size of a pixel there."""
    x, y = getDetectorPixelSpacing(aUnitOfLength)
    return x / getMagnification(), y / getMagnification()


def getBestSOD(aLabel: str, aUnitOfLength: str, aMultiplicativeFactor: float = 1.05) -> float:
    """Where the sphere about the mesh just fits on the detector, or where it would touch the detector if that is nearer.

    aMultiplicativeFactor: how much larger than the mesh this sphere is.
    """
    bounds = world.bounds(world.below(aLabel))
    diameter = aMultiplicativeFactor * float(np.linalg.norm(bounds[3:] - bounds[:3]))
    distance = getSourceDetectorDistance("mm")
    side = min(getDetectorSize("mm"))
    if not side > 0:
        raise SceneError("the detector has no size; call setDetectorNumberOfPixels and setDetectorPixelSize")
    return min(diameter / side * distance, distance - diameter / 2) / millimetres(aUnitOfLength)


def applySOD(aLabel: str, aSourceObjectDistance: float, aUnitOfLength: str) -> None:
    """Moves a mesh along the line from the source to the detector until its middle is this far from the source along it."""
    line = np.subtract(world.detector, world.source)
    if not line.any():
        raise SceneError("source and detector are at one place; call setSourcePosition and setDetectorPosition first")
    line = line / np.linalg.norm(line)
    now = float(np.dot(_middle(aLabel) - world.source, line))
    shift = (aSourceObjectDistance * millimetres(aUnitOfLength) - now) * line
    node = world.node(aLabel)
    above = world.world_matrix(node.parent) if node.parent else np.eye(4)
    node.matrix = np.linalg.inv(above) @ translate(*shift) @ above @ node.matrix


def getVisibilityCheckReport(aUnitOfLength: str, aNode: str = "root") -> str:
    """How many pixels each mesh covers, by the sides of its bounds."""
    mm = millimetres(aUnitOfLength)
    (x, y), (u, v) = getDetectorPixelSpacing(aUnitOfLength), getProjectionPixelSize(aUnitOfLength)
    lines = [f"Pixels of the detector: {x:g} x {y:g} {aUnitOfLength}; in the middle of the meshes: {u:g} x {v:g} "
             f"{aUnitOfLength}"]
    view = world.view()
    for label in world.below(aNode):
        mesh: Any = world.node(label).mesh
        if mesh is None:
            continue
        matrix = world.world_matrix(label)
        corners = mesh.vertices @ matrix[:3, :3].T + matrix[:3, 3]
        sides = [float(np.ptp(corners @ (step / np.linalg.norm(step)))) / mm for step in (view.column_step, view.row_step)]
        lines.append(f"{label}: {sides[0]:g} x {sides[1]:g} {aUnitOfLength}, {sides[0] / u:.0f} x {sides[1] / v:.0f} pixels")
    return "\n".join(lines) + "\n"
