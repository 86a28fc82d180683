"""Meshes and the scene graph."""
from __future__ import annotations

import collections
import os
import time
import weakref
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .._interface import ArgumentError, FileError
from ..matrices import rotate
from ..mesh import Mesh
from . import wheel
from .state import Node, millimetres, world
from .subtract import subtracted

__all__ = [
    "addMesh", "addPolygonMeshAsInnerSurface", "addPolygonMeshAsOuterSurface", "emptyMesh", "getChildLabel",
    "getFaceNormalVectorSet", "getIndexNumber", "getIndexSet", "getMeshFilename", "getMeshUnitOfLength",
    "getNumberOfChildren", "getNumberOfFaceNormalVectors", "getNumberOfPrimitives", "getNumberOfVertexNormalVectors",
    "getVertexNormalVectorSet", "getVertexNumber", "getVertexSet", "hasNormalVectorsInverted", "invertNormalVectors",
    "isInnerSurface", "isOuterSurface", "loadMeshFile", "loadSceneGraph", "makeCube", "makeCuboid", "makeCylinder",
    "makeSphere", "makeTriangularMesh", "rayIntersect", "removeMeshAndChildren", "removePolygonMeshesFromSceneGraph",
    "removePolygonMeshesFromXRayRenderer", "saveSTLfile", "subtractMesh",
]


def _loaded(label: str, mesh: Mesh, parent: str) -> None:
    world.add(label, mesh, parent)


#: Meshes of files that are alive, by the file's state and the unit; and the last few that were read, which stay alive.
_of_files: weakref.WeakValueDictionary[Any, Mesh] = weakref.WeakValueDictionary()
_latest: collections.deque[Mesh] = collections.deque(maxlen=4)
#: A file that changed this recently may change once more at the same time by the clock of its file system, s.
_SETTLED = 2.0


def _read(path: str, unit_mm: float) -> Mesh:
    """The mesh of a file. A script that loads a file anew for each image gets the mesh that is there, if the file is unchanged."""
    try:
        state = os.stat(path)
    except OSError:
        return Mesh.load(path, unit_mm=unit_mm)  # which says what is wrong
    key = (state.st_dev, state.st_ino, state.st_size, state.st_mtime_ns, state.st_ctime_ns, os.path.basename(path), unit_mm)
    mesh = _of_files.get(key)
    if mesh is None:
        settled = time.time() - max(state.st_mtime, state.st_ctime) > _SETTLED
        mesh = Mesh.load(path, unit_mm=unit_mm)
        if settled:
            _of_files[key] = mesh
    _latest.append(mesh)
    return mesh


def loadMeshFile(aLabel: str, aFileName: str, aUnitOfLength: str, addToRendererAsInnerSurface: bool = True,
                 aParent: str = "root") -> None:
    """In the folder of this package, welsh-dragon-small.stl is the mesh of gVXR's wheel (skiagraph.gvxr.dragon)."""
    if not os.path.exists(aFileName) and os.path.basename(aFileName) == wheel.DRAGON:
        raise FileError(f"{aFileName}: is not there; {wheel.ADVICE}")
    _loaded(aLabel, _read(aFileName, millimetres(aUnitOfLength)), aParent)
    world.node(aLabel).file, world.node(aLabel).unit = os.path.abspath(aFileName), aUnitOfLength
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


def makeTriangularMesh(aLabel: str, aVertexSet: Any, aTriangleIndexSet: Any = None, aUnitOfLength: str = "cm",
                       aParent: str = "root") -> None:
    """Flat lists, or rows of three. Without indices (label, vertices, unit, parent) each three vertices are a triangle."""
    vertices = np.asarray(aVertexSet, dtype=float).reshape(-1, 3)
    if isinstance(aTriangleIndexSet, str):
        aTriangleIndexSet, aUnitOfLength, aParent = None, aTriangleIndexSet, "root" if aUnitOfLength == "cm" else aUnitOfLength
    faces = np.arange(len(vertices)) if aTriangleIndexSet is None else np.asarray(aTriangleIndexSet)
    _loaded(aLabel, Mesh(vertices, faces.reshape(-1, 3), unit_mm=millimetres(aUnitOfLength), name=aLabel), aParent)


def loadSceneGraph(aFileName: str, aUnitOfLength: str) -> None:
    """All meshes of the file together, as one with the file's name, in the X-ray renderer."""
    label = os.path.splitext(os.path.basename(aFileName))[0]
    loadMeshFile(label, aFileName, aUnitOfLength)


def emptyMesh(aLabel: str, aParent: str = "root") -> None:
    world.add(aLabel, None, aParent)


def _beside(destination: str, source: str) -> NDArray[np.float64]:
    """The source's vertices as the destination's, each by its own matrix."""
    matrix = np.linalg.inv(world.world_matrix(destination)) @ world.world_matrix(source)
    vertices: NDArray[np.float64] = world.mesh(source).vertices @ matrix[:3, :3].T + matrix[:3, 3]
    return vertices


def addMesh(aDestination: str, aSource: str) -> None:
    """The destination's vertices and the source's, each by its own matrix."""
    target, vertices, faces = world.node(aDestination), _beside(aDestination, aSource), world.mesh(aSource).faces
    if target.mesh is not None:
        faces = np.concatenate([target.mesh.faces, faces + len(target.mesh.vertices)])
        vertices = np.concatenate([target.mesh.vertices, vertices])
    target.mesh = Mesh(vertices, faces, name=aDestination)


def subtractMesh(aDestination: str, aSource: str) -> None:
    """Takes from the destination what the source has in it. The destination, or each of its pieces, has to be convex as it was
    before anything was subtracted. What two sources share is taken twice."""
    target, old = world.node(aDestination), world.mesh(aDestination)
    solid = target.cut[1] if target.cut is not None and target.cut[0] is old else old
    vertices, faces = subtracted((old.vertices, old.faces), (solid.vertices, solid.faces),
                                 (_beside(aDestination, aSource), world.mesh(aSource).faces), aDestination)
    target.mesh = Mesh(vertices, faces, name=aDestination)
    target.cut = target.mesh, solid


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
    children = world.children(aLabel)
    if not 0 <= i < len(children):
        raise ArgumentError(f"{aLabel!r} has {len(children)} children; there is no number {i}, counted from 0")
    return children[i]


def getNumberOfPrimitives(aLabel: str) -> int:
    return len(getIndexSet(aLabel)) // 3


def getVertexNumber(aLabel: str) -> int:
    return len(getVertexSet(aLabel)) // 3


def getIndexNumber(aLabel: str) -> int:
    return len(getIndexSet(aLabel))


def getVertexSet(aLabel: str) -> NDArray[np.float64]:
    """x, y, z of each vertex in turn, mm; none of an empty node."""
    mesh = world.node(aLabel).mesh
    return np.zeros(0) if mesh is None else mesh.vertices.ravel()


def getIndexSet(aLabel: str) -> NDArray[np.int32]:
    mesh = world.node(aLabel).mesh
    return np.zeros(0, np.int32) if mesh is None else mesh.faces.ravel()


def getMeshFilename(aLabel: str) -> str:
    """"" if the mesh was made."""
    return world.node(aLabel).file


def getMeshUnitOfLength(aLabel: str) -> str:
    """"N/A" if the mesh was made."""
    return world.node(aLabel).unit


# Normals


def _normals(label: str) -> NDArray[np.float64]:
    """Of each triangle, its area long, as the corners are ordered."""
    mesh = world.mesh(label)
    a, b, c = (mesh.vertices[mesh.faces[:, k]] for k in range(3))
    return np.cross(b - a, c - a) / 2


def _unit(vectors: NDArray[np.float64]) -> NDArray[np.float64]:
    lengths = np.linalg.norm(vectors, axis=1, keepdims=True)
    return (vectors / np.where(lengths > 0, lengths, 1)).ravel()


def getFaceNormalVectorSet(aLabel: str) -> NDArray[np.float64]:
    """x, y, z for each triangle."""
    return _unit(_normals(aLabel))


def getVertexNormalVectorSet(aLabel: str) -> NDArray[np.float64]:
    """x, y, z for each vertex: the mean of its triangles' by area."""
    mesh, normals = world.mesh(aLabel), _normals(aLabel)
    found = np.zeros((len(mesh.vertices), 3))
    for k in range(3):
        np.add.at(found, mesh.faces[:, k], normals)
    return _unit(found)


def getNumberOfFaceNormalVectors(aLabel: str) -> int:
    return len(world.mesh(aLabel).faces)


def getNumberOfVertexNormalVectors(aLabel: str) -> int:
    return len(world.mesh(aLabel).vertices)


def invertNormalVectors(aLabel: str) -> None:
    """Turns a leaky mesh inside out. A closed one points outward whatever is asked."""
    node, mesh = world.node(aLabel), world.mesh(aLabel)
    node.mesh, node.inverted = Mesh(mesh.vertices, mesh.faces[:, ::-1], name=aLabel), not node.inverted


def hasNormalVectorsInverted(aLabel: str) -> bool:
    return world.node(aLabel).inverted


def rayIntersect(aLabel: str, aRayOriginX: float, aRayOriginY: float, aRayOriginZ: float, aRayDirectionX: float,
                 aRayDirectionY: float, aRayDirectionZ: float) -> tuple[float, ...]:
    """Where a ray meets the triangles of a mesh, as multiples of its direction, rising; origin and direction in mm."""
    mesh, matrix = world.mesh(aLabel), world.scene_matrix @ world.world_matrix(aLabel)
    corners = (mesh.vertices @ matrix[:3, :3].T + matrix[:3, 3])[mesh.faces]
    origin = np.array([aRayOriginX, aRayOriginY, aRayOriginZ], dtype=float)
    direction = np.array([aRayDirectionX, aRayDirectionY, aRayDirectionZ], dtype=float)
    side, other = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    across = np.cross(direction, other)
    area = np.einsum("ij,ij->i", side, across)
    scale = 1 / np.where(area == 0, np.inf, area)  # Moeller and Trumbore
    start = origin - corners[:, 0]
    u, turned = np.einsum("ij,ij->i", start, across) * scale, np.cross(start, side)
    v, distance = turned @ direction * scale, np.einsum("ij,ij->i", other, turned) * scale
    hit = (area != 0) & (u >= 0) & (v >= 0) & (u + v <= 1) & (distance >= 0)
    return tuple(np.unique(distance[hit]).tolist())


def saveSTLfile(aLabel: str, aFileName: str = "", aBinaryFlag: bool = True) -> None:
    """The label is the name of the file if none is given. As text if the flag is false."""
    mesh, path = world.mesh(aLabel), aFileName or f"{aLabel}.stl"
    if aBinaryFlag:
        mesh.save(path)
        return
    normals = _unit(_normals(aLabel)).reshape(-1, 3)
    with open(path, "w", encoding="ascii") as file:
        file.write("solid skiagraph\n")
        for normal, corners in zip(normals, mesh.vertices[mesh.faces]):
            file.write("facet normal {:.9g} {:.9g} {:.9g}\nouter loop\n".format(*normal))
            file.writelines("vertex {:.9g} {:.9g} {:.9g}\n".format(*corner) for corner in corners)
            file.write("endloop\nendfacet\n")
        file.write("endsolid skiagraph\n")
