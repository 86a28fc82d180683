"""The 3D view as the kernel draws it, for pages whose browser draws slowly: docs/live.md has the message and its answer. Private."""
from __future__ import annotations

import math
import re
import struct as structs
import time
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .._interface import Error
from .._library import call, ffi, struct
from .frame import Frame
from .subject import Subject
from .wish import Refusal, is_number

_SIDE_MAX, _PIXELS_MAX = 4096, 1 << 23
#: Number of the look, columns and rows (0: it could not be drawn), ms.
_HEADER = structs.Struct("<4sIHHf")
#: KEY: how many numbers, the least and the greatest.
_NUMBERS = {"size": (2, 1, _SIDE_MAX), "target": (3, -1e9, 1e9), "distance": (1, 1e-9, 1e9), "from": (3, -1e9, 1e9),
            "up": (3, -1e9, 1e9), "grey": (2, -1e30, 1e30), "cut": (4, -1e9, 1e9), "background": (3, 0, 255)}
_NEEDED = ("size", "target", "distance", "from", "up")


@dataclass
class Look:
    """How a page looks at the scene: the eye, and what differs from Scene.picture."""

    number: int = 0
    #: KEY -> numbers, of the keys above.
    numbers: dict[str, list[float]] = field(default_factory=dict)
    is_parallel: bool = False
    #: Number of a part -> red, green, blue and opacity, 0 to 255.
    colours: dict[int, list[float]] = field(default_factory=dict)

    @property
    def size(self) -> tuple[int, int]:
        """Columns and rows."""
        columns, rows = self.numbers["size"]
        return int(columns), int(rows)


def read_look(value: Any) -> Look:
    keys = value if isinstance(value, dict) else {}
    look = Look()
    for key in [*(key for key in _NEEDED if key not in keys), *keys]:
        if key not in keys or not _read(look, key, keys[key]):
            raise Refusal(f'"look": "{key[:40]}" is missing, unknown or out of range')
    return look


def _read(look: Look, key: str, value: Any) -> bool:
    """Takes the value of a key over. Returns whether it is one."""
    if key == "number":
        look.number = value
        return isinstance(value, int) and not isinstance(value, bool) and 0 <= value < 2 ** 32
    if key == "parallel":
        look.is_parallel = value
        return isinstance(value, bool)
    if key == "parts":
        if not isinstance(value, dict):
            return False
        are_right = all(re.fullmatch("[0-9]{1,9}", part, re.ASCII) and _is_list(colour, 4, 0, 255) for part, colour in value.items())
        look.colours = {int(part): colour for part, colour in value.items()} if are_right else {}
        return are_right
    if key not in _NUMBERS:
        return False
    count, low, high = _NUMBERS[key]
    given = [value] if count == 1 else value
    look.numbers[key] = given
    return _is_list(given, count, low, high) and (key != "size" or math.prod(look.size) <= _PIXELS_MAX)


def _is_list(value: Any, count: int, low: float, high: float) -> bool:
    return isinstance(value, list) and len(value) == count and all(is_number(x) and low <= x <= high for x in value)


def draw(subject: Subject, frame: Frame | None, look: Look) -> tuple[bytes, Error | None]:
    """The answer to a look; with an error, it says that there is no picture. frame: the last one, which the detector shows."""
    start, size, pixels, failure = time.perf_counter(), look.size, b"", None
    try:
        with subject.state.calls():
            pixels = _pixels(subject, frame, look).tobytes()
    except Error as error:
        size, failure = (0, 0), error
    ms = 1000 * (time.perf_counter() - start)
    return _HEADER.pack(b"SKLP", look.number, *size, ms) + pixels, failure


def _pixels(subject: Subject, frame: Frame | None, asked: Look) -> NDArray[np.uint8]:
    state, numbers, keep = subject.state, asked.numbers, []  # type: Any, dict[str, list[float]], list[Any]
    view = subject.view() if frame is None else frame.view
    look = struct("skg_look")
    look.columns, look.rows = asked.size
    look.orthographic, look.distance = asked.is_parallel, numbers["distance"][0]
    for name in ("from", "up"):
        for k, value in enumerate(numbers[name]):
            getattr(look, name)[k] = value

    def held(ctype: str, array: Any, kind: Any) -> Any:
        keep.append(np.ascontiguousarray(array, dtype=kind))
        return ffi.cast(ctype, ffi.from_buffer(keep[-1]))

    look.target = held("double *", numbers["target"], np.float64)
    if "cut" in numbers:
        look.cut = held("double *", numbers["cut"], np.float64)
    look.bounds = held("double *", subject.bounds(), np.float64)
    look.background = held("uint8_t *", _rounded(numbers.get("background", [244, 245, 247])), np.uint8)
    look.colours = held("uint8_t *", _colours(state, asked), np.uint8)
    look.poses = held("double *", subject.poses(), np.float64)
    if frame is not None:
        look.image = held("uint8_t *", _grey(frame, numbers.get("grey", [0, 0])), np.uint8)
    look.collimation = state.plans.options(state.options_setup, {}, keep).collimation
    made = np.empty((look.rows, look.columns, 4), np.uint8)
    call("skg_scene_picture", state.device.handle, state.handle, view._write(struct("skg_view")), look,
         ffi.cast("uint8_t *", ffi.from_buffer(made)))
    return made


def _rounded(values: Any) -> Any:
    return np.floor(np.asarray(values, dtype=float) + 0.5)


def _colours(state: Any, asked: Look) -> NDArray[np.uint8]:
    """The colours of the library, and those of the look."""
    made = np.empty((state.count(), 4), np.uint8)
    call("skg_look_colours_get", state.handle, ffi.cast("uint8_t *", ffi.from_buffer(made)))
    for part, colour in asked.colours.items():
        if part < len(made):
            made[part] = _rounded(colour)
    return made


def _grey(frame: Frame, grey: list[float]) -> Any:
    """The frame in the greys of the page, which are values of -ln(I/I0)."""
    black, white = grey
    with np.errstate(all="ignore"):
        values = frame.image.astype(np.float64)
        shown = -np.log(values / frame.flat) if frame.flat > 0 else values
        scaled = (shown - black) * (255 / (white - black) if white != black else 0)
        # what is not a number is black
        return np.where(scaled > 0, np.minimum(np.floor(scaled + 0.5), 255), 0)
