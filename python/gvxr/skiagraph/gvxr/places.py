"""Where meshes and the scene stand."""
from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from .._interface import ArgumentError
from ..matrices import rotate, translate
from ..mesh import Mesh
from .state import centred, millimetres, three, world

__all__ = [
    "applyCurrentLocalTransformation", "getLocalTransformationMatrix", "getNodeAndChildrenBoundingBox",
    "getNodeAndChildrenBoundingBoxCenter", "getNodeAndChildrenBoundingBoxCentre", "getNodeOnlyBoundingBox",
    "getNodeOnlyBoundingBoxCenter", "getNodeOnlyBoundingBoxCentre", "getNodeWorldTransformationMatrix",
    "getIdentityMatrix4", "getNodeLocalTransformationMatrix", "getRootTransformationMatrix",
    "getSceneTransformationMatrix", "moveToCenter", "moveToCentre", "resetSceneTransformation", "rotateNode",
    "rotateScene", "scaleNode", "scaleScene", "setLocalTransformationMatrix", "setNodeTransformationMatrix",
    "setRootTransformationMatrix", "setSceneTransformationMatrix", "shearNode",
    "translateNode", "translateScene",
]


def _transform(label: str, matrix: NDArray[np.float64]) -> None:
    node = world.node(label)
    node.matrix = node.matrix @ matrix


def _turn(angles: tuple[float, ...]) -> NDArray[np.float64]:
    """(angle, x, y, z), or (yaw, pitch, roll) about z, y and x; degrees."""
    if len(angles) == 4:
        return rotate(angles[1:], angles[0])
    if len(angles) == 3:
        return rotate("z", angles[0]) @ rotate("y", angles[1]) @ rotate("x", angles[2])
    raise ArgumentError("give (angle, x, y, z) or (yaw, pitch, roll)")


def rotateNode(aLabel: str, *angles: float) -> None:
    """(angle, x, y, z), or (yaw, pitch, roll); degrees."""
    _transform(aLabel, _turn(angles))


def translateNode(aLabel: str, x: float, y: float, z: float, aUnitOfLength: str) -> None:
    _transform(aLabel, translate(*three(x, y, z, millimetres(aUnitOfLength))))


def scaleNode(aLabel: str, x: float, y: float, z: float) -> None:
    _transform(aLabel, np.diag([x, y, z, 1.0]))


def shearNode(aLabel: str, yx: float, zx: float, xy: float, zy: float, xz: float, yz: float) -> None:
    """x += xy y + xz z, y += yx x + yz z, z += zx x + zy y."""
    _transform(aLabel, np.array([[1, xy, xz, 0], [yx, 1, yz, 0], [zx, zy, 1, 0], [0, 0, 0, 1.0]]))


def moveToCentre(aLabel: str = "root") -> None:
    _transform(aLabel, centred(world.bounds(world.below(aLabel))))


moveToCenter = moveToCentre


def _columns(matrix: NDArray[np.float64]) -> NDArray[np.float64]:
    return np.ascontiguousarray(matrix.T)


def getLocalTransformationMatrix(aLabel: str) -> NDArray[np.float64]:
    """16 numbers, column by column, mm."""
    return _columns(world.node(aLabel).matrix).ravel()


def setLocalTransformationMatrix(aLabel: str, aMatrix: Any) -> None:
    world.node(aLabel).matrix = np.asarray(aMatrix, dtype=float).reshape(4, 4).T.copy()


setNodeTransformationMatrix = setLocalTransformationMatrix


def getNodeWorldTransformationMatrix(aLabel: str) -> NDArray[np.float64]:
    return _columns(world.world_matrix(aLabel))


def getNodeLocalTransformationMatrix(aLabel: str) -> NDArray[np.float64]:
    """[4, 4], of which a row is a column of the matrix."""
    return _columns(world.node(aLabel).matrix)


def getRootTransformationMatrix() -> NDArray[np.float64]:
    return _columns(world.node("root").matrix)


def setRootTransformationMatrix(aMatrix: Any) -> None:
    setLocalTransformationMatrix("root", aMatrix)


def setSceneTransformationMatrix(aMatrix: Any) -> None:
    world.scene_matrix = np.asarray(aMatrix, dtype=float).reshape(4, 4).T.copy()


def getIdentityMatrix4() -> tuple[float, ...]:
    return tuple(np.eye(4).ravel().tolist())


def applyCurrentLocalTransformation(aLabel: str) -> None:
    node, mesh = world.node(aLabel), world.mesh(aLabel)
    vertices = mesh.vertices @ node.matrix[:3, :3].T + node.matrix[:3, 3]
    node.mesh, node.matrix = Mesh(vertices, mesh.faces, name=aLabel), np.eye(4)


def rotateScene(*angles: float) -> None:
    """(angle, x, y, z), or (yaw, pitch, roll); degrees."""
    world.scene_matrix = world.scene_matrix @ _turn(angles)


def translateScene(x: float, y: float, z: float, aUnitOfLength: str) -> None:
    world.scene_matrix = world.scene_matrix @ translate(*three(x, y, z, millimetres(aUnitOfLength)))


def scaleScene(x: float, y: float, z: float, aUnitOfLength: str = "mm") -> None:
    """Times the mm of the unit, as if the factors were lengths."""
    mm = millimetres(aUnitOfLength)
    world.scene_matrix = world.scene_matrix @ np.diag([x * mm, y * mm, z * mm, 1.0])


def resetSceneTransformation() -> None:
    world.scene_matrix = np.eye(4)


def getSceneTransformationMatrix() -> NDArray[np.float64]:
    return _columns(world.scene_matrix)


def getNodeOnlyBoundingBox(aLabel: str, aUnitOfLength: str = "cm") -> tuple[float, ...]:
    """Least x, y, z, then greatest, in the world."""
    return tuple((world.bounds(iter([aLabel])) / millimetres(aUnitOfLength)).tolist())


def getNodeAndChildrenBoundingBox(aLabel: str, aUnitOfLength: str = "cm") -> tuple[float, ...]:
    return tuple((world.bounds(world.below(aLabel)) / millimetres(aUnitOfLength)).tolist())


def _middle(box: tuple[float, ...]) -> tuple[float, ...]:
    return tuple((box[k] + box[k + 3]) / 2 for k in range(3))


def getNodeOnlyBoundingBoxCentre(aLabel: str, aUnitOfLength: str = "cm") -> tuple[float, ...]:
    return _middle(getNodeOnlyBoundingBox(aLabel, aUnitOfLength))


getNodeOnlyBoundingBoxCenter = getNodeOnlyBoundingBoxCentre


def getNodeAndChildrenBoundingBoxCentre(aLabel: str, aUnitOfLength: str = "cm") -> tuple[float, ...]:
    return _middle(getNodeAndChildrenBoundingBox(aLabel, aUnitOfLength))


getNodeAndChildrenBoundingBoxCenter = getNodeAndChildrenBoundingBoxCentre
