"""Pictures of the scene. There is no window: takeScreenshot draws the scene as it stands."""
from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from .._interface import ArgumentError
from .state import world

__all__ = [
    "getAmbientColour", "getDiffuseColour", "getLatestScreenshot", "getSceneRotationMatrix", "getShininess",
    "getSpecularColour", "getWindowSize", "getZoom", "setAmbiantColour", "setColor", "setColour", "setDiffuseColour",
    "setSceneRotationMatrix", "setShininess", "setSpecularColour", "setWindowBackGroundColor", "setWindowBackGroundColour",
    "setWindowSize", "setZoom", "takeScreenshot",
]

_WHITE = (1.0, 1.0, 1.0, 1.0)


def _colour(label: str, kinds: tuple[str, ...], rgba: tuple[float, float, float, float]) -> None:
    for kind in kinds:
        world.node(label).colours[kind] = tuple(float(value) for value in rgba)


def setColour(aLabel: str, R: float, G: float, B: float, A: float) -> None:
    """Ambient, diffuse and specular; takeScreenshot shows it."""
    _colour(aLabel, ("ambient", "diffuse", "specular"), (R, G, B, A))


setColor = setColour


def setAmbiantColour(aLabel: str, R: float, G: float, B: float, A: float) -> None:
    _colour(aLabel, ("ambient",), (R, G, B, A))


def setDiffuseColour(aLabel: str, R: float, G: float, B: float, A: float) -> None:
    _colour(aLabel, ("diffuse",), (R, G, B, A))


def setSpecularColour(aLabel: str, R: float, G: float, B: float, A: float) -> None:
    _colour(aLabel, ("specular",), (R, G, B, A))


def getAmbientColour(aLabel: str) -> tuple[float, ...]:
    return world.node(aLabel).colours.get("ambient", _WHITE)


def getDiffuseColour(aLabel: str) -> tuple[float, ...]:
    return world.node(aLabel).colours.get("diffuse", _WHITE)


def getSpecularColour(aLabel: str) -> tuple[float, ...]:
    return world.node(aLabel).colours.get("specular", _WHITE)


def setShininess(aLabel: str, aShininessValue: float) -> None:
    """Kept, and not shown."""
    world.node(aLabel).shininess = float(aShininessValue)


def getShininess(aLabel: str) -> float:
    return world.node(aLabel).shininess


def setWindowSize(aWidth: int, aHeight: int, aWindowID: int = -1) -> None:
    """The size of a screenshot."""
    world.look["size"] = int(aWidth), int(aHeight)


def getWindowSize(aWindowID: int = -1) -> tuple[int, int]:
    width, height = world.look.get("size", (500, 500))
    return int(width), int(height)


def setWindowBackGroundColour(R: float, G: float, B: float, aWindowID: int = -1) -> None:
    """Kept, and not shown: the background is that of the library."""
    world.look["background"] = float(R), float(G), float(B)


setWindowBackGroundColor = setWindowBackGroundColour


def setZoom(aZoomValue: float) -> None:
    """Kept; a screenshot shows the whole scene, whatever it is."""
    world.look["zoom"] = float(aZoomValue)


def getZoom() -> float:
    return float(world.look.get("zoom", 2500.0))


def setSceneRotationMatrix(aRotationMatrix: Any) -> None:
    """How the scene is turned before it is seen along -z, with y up: 16 numbers, column by column."""
    matrix = np.asarray(aRotationMatrix, dtype=float)
    if matrix.size != 16:
        raise ArgumentError(f"the rotation matrix has {matrix.size} numbers; give 16, column by column")
    world.look["rotation"] = tuple(matrix.ravel().tolist())


def getSceneRotationMatrix() -> tuple[float, ...]:
    return tuple(world.look.get("rotation", np.eye(4).ravel().tolist()))


def takeScreenshot(aWindowID: int = -1) -> NDArray[np.float64]:
    """[row, column, red green blue], 0 to 1: source, detector with the last image, and meshes."""
    eye: dict[str, Any] = {}
    if "rotation" in world.look:
        turn = np.reshape(world.look["rotation"], (4, 4))[:3, :3]  # its rows are the columns of the matrix
        eye = {"direction": turn[:, 2], "up": turn[:, 1]}
    image = world.images.get("image")
    scene = world.scene(False)
    if image is not None and image.shape != scene.view.shape:
        image = None
    colours = {label: node.colours["diffuse"] for label, node in world.nodes.items()
               if "diffuse" in node.colours and label in scene}
    shown = scene.picture(getWindowSize(), image=image, colours=colours, **eye) / 255
    world.look["screenshot"] = shown
    return shown


def getLatestScreenshot() -> NDArray[np.float64]:
    """The last one, or a new one if there is none."""
    shown: NDArray[np.float64] | None = world.look.get("screenshot")
    return takeScreenshot() if shown is None else shown
