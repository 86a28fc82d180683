"""Taking parts out of a scene. Private."""
from __future__ import annotations

import difflib
from typing import TYPE_CHECKING

from ._interface import SceneError
from ._library import call, ffi, integer, make, struct
from .part import LabelError

if TYPE_CHECKING:
    from .scene import Scene

#: Labels that an error names.
_MOST = 12


def unknown_label(label: str, labels: list[str]) -> LabelError:
    near = difflib.get_close_matches(label, labels, 1)
    if not labels:
        there = "the scene has no parts"
    elif len(labels) > _MOST:
        there = f"there are {len(labels)}, such as " + ", ".join(map(repr, near or labels[:3]))
    else:
        there = "there " + ("is " if len(labels) == 1 else "are ") + ", ".join(map(repr, labels))
    return LabelError(f"there is no part {label!r}; " + (f"did you mean {near[0]!r}? " if near else "") + there)


def remove(scene: Scene, number: int) -> None:
    """The scene with all parts but this one. The library's scenes only grow, so that it is made anew."""
    record = struct("skg_scan_record")
    call("skg_setup_record_get", scene._setup, record)
    if record.moving_count:
        raise SceneError("parts of the scene move from one projection of its scan to the next (Poses), which are found by "
                         "their numbers; take the part out of the file instead")
    if scene._breath:
        raise SceneError("the scene was posed by breathe(), which needs all of its parts; take the part out of the file instead")
    removed = list(scene)[number].label
    made = make("skg_scene_create", "skg_scene", scene._device.handle)
    parts = []
    for old in range(integer("skg_scene_part_count", scene._parts_handle)):
        parts.append(struct("skg_part"))
        call("skg_scene_part_get", scene._parts_handle, old, parts[-1])
    above = parts[number].inside
    # Those inside come after what they lie in, which the library wants to find.
    order = _outward(parts, number)
    numbers: dict[int, int] = {}
    for new, old in enumerate(order):
        inside = above if parts[old].inside == number else parts[old].inside
        parts[old].inside = numbers[inside] if inside >= 0 else -1
        call("skg_scene_add", made, parts[old], ffi.NULL)
        numbers[old] = new
    _replace(scene, made, order, number)
    scene._removed.append(removed)


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


def _replace(scene: Scene, made: object, order: list[int], number: int) -> None:
    from_file = number < scene._file_parts
    scene._materials = {order.index(old): matter for old, matter in scene._materials.items() if old != number}
    scene._names = [scene._names[old] for old in order]
    scene._read_poses = [scene._read_poses[old] for old in order if old < scene._file_parts]
    scene._file_parts -= from_file
    scene._plans.clear()
    scene._forget_motion()
    before, scene._own_parts, scene._parts_handle = scene._own_parts, made, made
    if before != ffi.NULL:
        scene._device.drop("skg_scene", before)
