"""A scene by its content, for pickle. Private."""
from __future__ import annotations

from typing import TYPE_CHECKING, Any

from ._interface import SceneError
from ._source import Kept

if TYPE_CHECKING:
    from .scene import Scene


def content(scene: Scene) -> dict[str, Any]:
    """What the scene was read from, with all its files, and what was changed since."""
    parts = list(scene)
    old, new = parts[:scene._file_parts], parts[scene._file_parts:]
    moved = {part._number: part.mesh.vertices for part in old if part.mesh._changed}
    if moved and scene._breath:
        raise SceneError(f"{parts[min(moved)].label}: its vertices were assigned, and the scene breathes; pickle it before "
                         "one of both")
    return {
        "source": scene._source.content(), "device": scene._device._config, "view": scene._view,
        "beam": scene._beam if "beam" in scene._changed else None, "changed": scene._changed,
        "removed": scene._removed, "poses": [part.pose for part in old],
        "materials": {number: material for number, material in scene._materials.items() if number < len(old)},
        "vertices": moved, "breath": scene._breath,
        "trajectory": scene._trajectory, "frames": scene._frames,
        "added": [{"label": part.label, "mesh": part.mesh, "material": part.material, "inside": part.inside,
                   "pose": part.pose, "priority": part.priority} for part in new],
    }


def restore(scene: Scene, state: dict[str, Any]) -> None:
    kept = Kept(state["source"])
    scene._open(kept.source, state["device"], kept.elsewhere)
    scene._kept = kept  # its files stay as long as the scene
    for label in state["removed"]:
        if label in scene:  # not one that was added and removed again
            scene.remove(label)
    for part, pose in zip(scene, state["poses"]):
        part.pose = pose
    for number, material in state["materials"].items():
        list(scene)[number].material = material
    for number, vertices in state["vertices"].items():
        list(scene)[number].mesh.vertices = vertices
    for part in state["added"]:
        scene.add(part.pop("label"), part.pop("mesh"), **part)
    scene._view, scene._changed = state["view"], state["changed"]
    scene._trajectory, scene._frames = state["trajectory"], state["frames"]
    if state["beam"] is not None:
        scene.beam = state["beam"]
    if state["breath"]:
        scene.breathe(**state["breath"])
