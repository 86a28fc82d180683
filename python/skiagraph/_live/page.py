"""The page of `skiagraph live` with the surfaces of a scene. Private."""
from __future__ import annotations

import base64
import importlib.resources
import json
import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .._interface import UnsupportedError
from .._library import call, ffi
from .core import letter, written
from .subject import Subject

#: Moments of the breath, between which the page moves vertices in straight lines.
_MOMENTS = 12
#: Triangles of a page; of a scene with more, vertices that are close together become one.
_MOST = 100_000


class _Blob:
    """Blocks of bytes, each of which begins at a multiple of 4."""

    def __init__(self) -> None:
        self.bytes = bytearray()

    def add(self, array: NDArray[Any]) -> int:
        self.bytes += bytes(-len(self.bytes) % 4)
        at = len(self.bytes)
        self.bytes += array.tobytes()
        return at


def html(subject: Subject) -> bytes:
    """The page, of the scene as it is at the beginning of the subject."""
    file = importlib.resources.files("skiagraph").joinpath("live.html")
    if not file.is_file():
        raise UnsupportedError("the page live.html is not in the package skiagraph; install the package, or build the target "
                               "python_interface")
    text, blob = file.read_text(encoding="utf-8"), _Blob()
    scene = json.dumps(finite(_scene(subject, blob))).replace("<", "\\u003c")
    head, rest = text.split('"SCENE"', 1)
    middle, tail = rest.split("BYTES", 1)
    return "".join((head, scene, middle, base64.b64encode(blob.bytes).decode(), tail)).encode()


def _scene(subject: Subject, blob: _Blob) -> dict[str, Any]:
    state = subject.state
    parts = state.parts()
    total = sum(part.mesh._counts()[1] for part in parts)
    share = min(1.0, _MOST / max(total, 1))
    origins = [_thin(part.mesh.vertices, part.mesh.faces, share) for part in parts]
    moments: list[list[NDArray[np.float32]]] = [[] for _ in parts]
    for _ in subject.moments(_MOMENTS):
        for part, base, (origin, _faces), frames in zip(parts, subject.base, origins, moments):
            frames.append((part.mesh.vertices[origin] @ base[:3, :3].T + base[:3, 3]).astype(np.float32))
    colours = np.empty((len(parts), 4), np.uint8)
    call("skg_look_colours_get", state.handle, ffi.cast("uint8_t *", ffi.from_buffer(colours)))
    made = [_part(part, colour, frames, faces, blob) for part, colour, frames, (_, faces) in zip(parts, colours, moments, origins)]
    box = np.zeros((2, 3))
    if made:
        box[:] = np.min([its["low"] for its in made], axis=0), np.max([its.pop("high") for its in made], axis=0)
    keep: list[Any] = []
    jaws = state.plans.options(state.options_setup, {}, keep).collimation
    view = letter("skg_live_view_write", written(state.require_view()), jaws, ffi.cast("double *", ffi.from_buffer(box)))
    return {"parts": made, "image": None, "name": (state.source.path or "scene").rsplit("/", 1)[-1],
            "view": json.loads(view), "box": box.tolist(), "path": [],
            "motion": {"frames": _MOMENTS, "seconds": subject.period} if subject.breathes else None}


def _part(part: Any, colour: Any, frames: list[NDArray[np.float32]], faces: NDArray[Any], blob: _Blob) -> dict[str, Any]:
    """Positions as 16 bits between the least and the largest of all frames, and the numbers of corners."""
    if all((frame == frames[0]).all() for frame in frames):
        frames = frames[:1]
    positions, wide = np.stack(frames).astype(np.float64), len(frames[0]) > 65536
    flat = positions.reshape(-1, 3)
    low, high = (flat.min(axis=0), flat.max(axis=0)) if len(flat) else (np.zeros(3), np.zeros(3))
    step = (high - low) / 65535
    numbers = np.rint((flat - low) / np.where(step > 0, step, 1)).astype("<u2")
    material = part.material
    return {"positions": blob.add(numbers), "corners": blob.add(faces.astype("<u4" if wide else "<u2")), "material": material.name,
            "label": part.label, "density": material.density, "inside": part._get().inside, "colour": colour.tolist(),
            "shown": len(faces), "of": part.mesh._counts()[1], "vertices": len(frames[0]), "frames": len(frames), "wide": wide,
            "low": low.tolist(), "step": step.tolist(), "high": high.tolist()}


def _thin(vertices: NDArray[Any], faces: NDArray[Any], share: float) -> tuple[NDArray[Any], NDArray[Any]]:
    """Numbers of the vertices that are shown, and triangles of them: about this share, by joining what is in a cell of a grid."""
    if share < 1 and len(faces) > 100:
        edges = np.linalg.norm(vertices[faces[:, 0]] - vertices[faces[:, 1]], axis=1)
        cells = np.floor((vertices - vertices.min(axis=0)) / max(float(np.median(edges)) / np.sqrt(share), 1e-9)).astype(np.int64)
        keys = cells @ np.array([1, 1 << 20, 1 << 40])
    else:
        keys = np.arange(len(vertices))
    _, first, cell = np.unique(keys, return_index=True, return_inverse=True)
    joined = cell.reshape(-1)[faces]
    a, b, c = joined.T
    return first, joined[(a != b) & (b != c) & (c != a)]


def finite(value: Any) -> Any:
    """A value for JSON: numbers that JSON lacks become null."""
    if isinstance(value, float):
        return value if math.isfinite(value) else None
    if isinstance(value, dict):
        return {key: finite(item) for key, item in value.items()}
    if isinstance(value, (list, tuple)):
        return [finite(item) for item in value]
    return value.item() if isinstance(value, np.generic) else value
