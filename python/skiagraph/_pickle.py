"""A scene by its content, for pickle. Private."""
from __future__ import annotations

from typing import TYPE_CHECKING, Any

from ._interface import SceneError
from ._library import ffi, string
from ._source import Kept
from ._state import State, beam_of

if TYPE_CHECKING:
    from .scene import Scene


def content(state: State) -> dict[str, Any]:
    """Contents of a pickled scene: the text it was read from, with all its files, and the changes since."""
    parts = state.parts()
    old, new = parts[:state.file_parts], parts[state.file_parts:]
    arrays = [part.label for part in new if part.volume]
    if arrays:
        raise SceneError(f"{arrays[0]}: a volume that add_volume() added is not pickled; add it anew where the scene arrives, or read a "
                         "scene whose sample names its file (the key Volume)")
    moved = {number: part.mesh.vertices for number, part in enumerate(old) if part.mesh._changed}
    if moved and state.breath:
        raise SceneError(f"{parts[min(moved)].label}: its vertices were assigned, and the scene breathes; pickle it before "
                         "one of both")
    return {
        "source": state.source.content(), "device": state.device, "view": state.view,
        "beam": state.beam if "beam" in state.changed else None, "changed": state.changed,
        "removed": state.removed, "poses": [part.pose for part in old],
        "materials": {number: material for number, material in state.materials.items() if number < len(old)},
        "vertices": moved, "breath": state.breath,
        "trajectory": state.trajectory, "frames": state.frames,
        "tuned": None if state.tuned == ffi.NULL else string("skg_setup_text_get", state.tuned),
        "added": [{"label": part.label, "mesh": part.mesh, "material": part.material, "inside": part.inside,
                   "pose": part.pose, "priority": part.priority} for part in new],
    }


def opened(content: dict[str, Any]) -> State:
    """The scene as it was read."""
    kept = Kept(content["source"])
    state = State.read(kept.source, content["device"], kept.elsewhere)
    state.kept = kept  # its files stay as long as the scene
    return state


def restore(scene: Scene, state: State, content: dict[str, Any]) -> None:
    """The changes since."""
    for label in content["removed"]:
        if label in scene:  # not one that was added and removed again
            scene.remove(label)
    for part, pose in zip(scene, content["poses"]):
        part.pose = pose
    for number, material in content["materials"].items():
        scene.parts[number].material = material
    for number, vertices in content["vertices"].items():
        scene.parts[number].mesh.vertices = vertices
    for part in content["added"]:
        scene.add(part.pop("label"), part.pop("mesh"), **part)
    state.view, state.changed = content["view"], content["changed"]
    state.trajectory, state.frames = content["trajectory"], content["frames"]
    if content["tuned"] is not None:
        state.tune(state.light(content["tuned"], []))
        state.beam = beam_of(state.tuned)
    if content["beam"] is not None:
        scene.beam = content["beam"]
    if content["breath"]:
        scene.breathe(**content["breath"])
