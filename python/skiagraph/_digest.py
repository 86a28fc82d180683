"""The hash of a scan whose scene was changed after its file was read. Private.

A file of projections keeps the hash of its scan. scan() continues an unfinished file only if the hashes are equal. The library's
hash covers the text of the scene and its files; changes that were made in Python since are hashed here.
"""
from __future__ import annotations

import hashlib
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from .beam import Beam, Response
from .counter import Counter
from .material import Material
from .mesh import Mesh

if TYPE_CHECKING:
    from .scan import Scan
    from ._state import State

#: Options that skg_scan_hash_get knows, and options on which no image depends.
_KNOWN = frozenset(("precision", "quantity", "tolerance", "falloff", "supersampling", "noise", "repair", "clip", "unite", "bands",
                    "band_weight", "noise_seed", "swank", "electronic_kev", "quantum_step_kev"))
_IDLE = frozenset(("strategy", "tile", "overlaps", "profile"))


def digest(given: str, state: State, trajectory: Scan | None, options: Mapping[str, Any]) -> str:
    """The hash of a scan: that of the library if nothing was changed, so that the command knows the scan as well."""
    kev = state.require_beam().energies
    changes = _changes(state)
    others = {name: value for name, value in options.items() if value is not None and name not in _KNOWN | _IDLE}
    if trajectory is not None:
        changes["views"] = [np.concatenate((v.source, v.detector, v.column_step, v.row_step)) for v in trajectory]
        changes["pixels"] = [*trajectory[0].pixels, trajectory[0].projection]
        if trajectory[0].radius:
            changes["radius"] = trajectory[0].radius
    if not changes and not others:
        return given
    made = hashlib.sha256(given.encode())
    for item in (changes, others):
        _add(made, item, kev)
    return made.hexdigest()


def _changes(state: State) -> dict[str, Any]:
    found: dict[str, Any] = {}
    for number, part in enumerate(state.parts()):
        added, mesh = number >= state.file_parts, part.mesh
        if added or (part.pose != state.read_poses[number]).any():
            found[f"pose {number}"] = part.pose
        if added:
            found[f"part {number}"] = [part.inside or "", part.priority, mesh.faces]
        if added and part.volume:
            found[f"volume {number}"] = state.volumes[part._name]
        elif added or number in state.materials:
            found[f"material {number}"] = part.material
        if added or mesh._changed:
            found[f"vertices {number}"] = mesh
    if state.removed:
        found["removed"] = state.removed
    if "beam" in state.changed:
        found["beam"] = state.require_beam()
    return found


def _add(made: Any, value: Any, kev: Any) -> None:
    """Adds a value by its content, with its kind, so that different values give different bytes."""
    made.update(f"[{type(value).__name__} ".encode())
    if isinstance(value, Mapping):
        for name in sorted(value):
            made.update(f"{name}=".encode())
            _add(made, value[name], kev)
    elif isinstance(value, (list, tuple)):
        for item in value:
            _add(made, item, kev)
    elif isinstance(value, Mesh):
        made.update(value.vertices.tobytes())
    elif isinstance(value, Material):
        made.update(value.attenuation(kev).tobytes())
    elif isinstance(value, Beam):
        made.update(value.energies.tobytes() + value.photons.tobytes() + b"absolute" * value.absolute)
    elif isinstance(value, Response):
        made.update(np.array([value.at(float(e)) for e in kev]).tobytes())
    elif isinstance(value, Counter):
        for e in kev:
            made.update(value.counts(float(e)).tobytes())
            made.update(b"".join(value.spread(float(e), w).tobytes() for w in range(len(value))))
    elif isinstance(value, np.ndarray):
        made.update(f"{value.shape} {value.dtype} ".encode() + value.tobytes())
    else:
        made.update(repr(value).encode())
    made.update(b"]")
