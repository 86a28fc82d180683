"""Taking parts out of a scene. Private."""
from __future__ import annotations

import difflib
from typing import TYPE_CHECKING

from ._interface import SceneError
from ._library import call, ffi, integer, make, struct
from .part import LabelError

if TYPE_CHECKING:
    from ._state import State

#: Labels that an error names.
_MAX = 12


def unknown_label(label: str, labels: list[str]) -> LabelError:
    near = difflib.get_close_matches(label, labels, 1)
    if not labels:
        there = "the scene has no parts"
    elif len(labels) > _MAX:
        there = f"there are {len(labels)}, such as " + ", ".join(map(repr, near or labels[:3]))
    else:
        there = "there " + ("is " if len(labels) == 1 else "are ") + ", ".join(map(repr, labels))
    return LabelError(f"there is no part {label!r}; " + (f"did you mean {near[0]!r}? " if near else "") + there)


def remove(state: State, number: int) -> None:
    """The scene with all parts but this one. The library's scenes only grow, so that it is made anew."""
    record = struct("skg_scan_record")
    call("skg_setup_record_get", state.setup, record)
    if record.moving_count:
        raise SceneError("parts of the scene move from one projection of its scan to the next (Poses), which are found by "
                         "their numbers; take the part out of the file instead")
    if state.breath:
        raise SceneError("the scene was posed by breathe(), which needs all of its parts; take the part out of the file instead")
    removed = state.parts()[number].label
    made = make("skg_scene_create", "skg_scene", state.device.handle)
    parts = []
    for old in range(integer("skg_scene_part_count", state.handle)):
        parts.append(struct("skg_part"))
        call("skg_scene_part_get", state.handle, old, parts[-1])
    above = parts[number].inside
    # Inner parts come after the parts that they lie in, which the library wants to find.
    order = _outward(parts, number)
    numbers: dict[int, int] = {}
    for new, old in enumerate(order):
        inside = above if parts[old].inside == number else parts[old].inside
        parts[old].inside = numbers[inside] if inside >= 0 else -1
        call("skg_scene_part_add", made, parts[old], ffi.NULL)
        numbers[old] = new
    _replace(state, made, order, number)
    state.keep_meshes([parts[old].mesh for old in order])
    state.removed.append(removed)


def _outward(parts: list[object], number: int) -> list[int]:
    """The numbers of the others, in their order where what they lie in comes first."""
    left, order = [k for k in range(len(parts)) if k != number], []
    while left:
        for k in left:
            inside = parts[k].inside  # type: ignore[attr-defined]
            if inside not in left:
                order.append(k)
                left.remove(k)
                break
    return order


def _replace(state: State, made: object, order: list[int], number: int) -> None:
    from_file = number < state.file_parts
    state.materials = {order.index(old): matter for old, matter in state.materials.items() if old != number}
    state.names = [state.names[old] for old in order]
    state.read_poses = [state.read_poses[old] for old in order if old < state.file_parts]
    state.file_parts -= from_file
    state.plans.clear()
    state.forget_motion()
    before, state.own_handle, state.handle = state.own_handle, made, made
    if before != ffi.NULL:
        state.device.drop("skg_scene", before)
