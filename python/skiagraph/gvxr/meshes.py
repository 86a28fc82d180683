"""Meshes and the scene graph."""
from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..matrices import rotate
from ..mesh import Mesh
from .state import Node, millimetres, world

__all__ = [
    "addMesh", "addPolygonMeshAsInnerSurface", "addPolygonMeshAsOuterSurface", "emptyMesh", "getChildLabel",
    "getIndexSet", "getNumberOfChildren", "getNumberOfPrimitives", "getVertexSet", "isInnerSurface",
    "isOuterSurface", "loadMeshFile", "makeCube", "makeCuboid", "makeCylinder", "makeSphere",
    "makeTriangularMesh", "removeMeshAndChildren", "removePolygonMeshesFromSceneGraph",
    "removePolygonMeshesFromXRayRenderer", "saveSTLfile",
]


def _loaded(label: str, mesh: Mesh, parent: str) -> None:
    world.add(label, mesh, parent)


def loadMeshFile(aLabel: str, aFileName: str, aUnitOfLength: str, addToRendererAsInnerSurface: bool = True,
                 aParent: str = "root") -> None:
    _loaded(aLabel, Mesh.load(aFileName, unit_mm=millimetres(aUnitOfLength)), aParent)
    if addToRendererAsInnerSurface:
        addPolygonMeshAsInnerSurface(aLabel)


def makeCube(aLabel: str, aLength: float = 1, aUnitOfLength: str = "cm", aParent: str = "root") -> None:
    _loaded(aLabel, Mesh.cube(aLength * millimetres(aUnitOfLength)), aParent)


def makeCuboid(aLabel: str, aWidth: float = 1, aHeight: float = 1, aDepth: float = 1, aUnitOfLength: str = "cm",
               aParent: str = "root") -> None:
    mm = millimetres(aUnitOfLength)
    _loaded(aLabel, Mesh.cuboid(aWidth * mm, aHeight * mm, aDepth * mm), aParent)


def makeCylinder(aLabel: str, aNumberOfSectors: int = 10, aHeight: float = 1, aRadius: float = 0.5,
                 aUnitOfLength: str = "cm", aParent: str = "root") -> None:
    """Along y."""
    mm = millimetres(aUnitOfLength)
    along_z = Mesh.cylinder(aRadius * mm, aHeight * mm, aNumberOfSectors)
    turned = along_z.vertices @ rotate("x", -90)[:3, :3].T
    _loaded(aLabel, Mesh(turned, along_z.faces, name=aLabel), aParent)


def makeSphere(aLabel: str, aNumberOfRings: int = 10, aNumberOfSectors: int = 10, aRadius: float = 0.5,
               aUnitOfLength: str = "cm", aParent: str = "root") -> None:
    """Half as many rings as sectors, whatever is asked."""
    _loaded(aLabel, Mesh.sphere(aRadius * millimetres(aUnitOfLength), aNumberOfSectors), aParent)


def makeTriangularMesh(aLabel: str, aVertexSet: Any, aTriangleIndexSet: Any, aUnitOfLength: str,
                       aParent: str = "root") -> None:
    """Flat lists, or rows of three."""
    vertices = np.asarray(aVertexSet, dtype=float).reshape(-1, 3)
    faces = np.asarray(aTriangleIndexSet).reshape(-1, 3)
    _loaded(aLabel, Mesh(vertices, faces, unit_mm=millimetres(aUnitOfLength), name=aLabel), aParent)


def emptyMesh(aLabel: str, aParent: str = "root") -> None:
    world.add(aLabel, None, aParent)


def addMesh(aDestination: str, aSource: str) -> None:
    """The destination's vertices and the source's, each by its own matrix."""
    target, source = world.node(aDestination), world.mesh(aSource)
    matrix = np.linalg.inv(world.world_matrix(aDestination)) @ world.world_matrix(aSource)
    vertices = source.vertices @ matrix[:3, :3].T + matrix[:3, 3]
    faces = source.faces
    if target.mesh is not None:
        faces = np.concatenate([target.mesh.faces, faces + len(target.mesh.vertices)])
        vertices = np.concatenate([target.mesh.vertices, vertices])
    target.mesh = Mesh(vertices, faces, name=aDestination)


def addPolygonMeshAsInnerSurface(aLabel: str) -> None:
    world.node(aLabel).surface = "inner"


def addPolygonMeshAsOuterSurface(aLabel: str) -> None:
    world.node(aLabel).surface = "outer"


def isInnerSurface(aLabel: str) -> bool:
    return world.node(aLabel).surface == "inner"


def isOuterSurface(aLabel: str) -> bool:
    return world.node(aLabel).surface == "outer"


def removePolygonMeshesFromXRayRenderer() -> None:
    for node in world.nodes.values():
        node.surface = ""


def removePolygonMeshesFromSceneGraph() -> None:
    world.nodes = {"root": Node("")}


def removeMeshAndChildren(aLabel: str) -> None:
    for label in list(world.below(aLabel)):
        del world.nodes[label]


def getNumberOfChildren(aLabel: str) -> int:
    return len(world.children(aLabel))


def getChildLabel(aLabel: str, i: int) -> str:
    return world.children(aLabel)[i]


def getNumberOfPrimitives(aLabel: str) -> int:
    return len(world.mesh(aLabel).faces)


def getVertexSet(aLabel: str) -> NDArray[np.float64]:
    """x, y, z of each vertex in turn, mm."""
    return world.mesh(aLabel).vertices.ravel()


def getIndexSet(aLabel: str) -> NDArray[np.int32]:
    return world.mesh(aLabel).faces.ravel()


def saveSTLfile(aLabel: str, aFileName: str) -> None:
    world.mesh(aLabel).save(aFileName)
