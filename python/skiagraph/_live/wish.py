"""What a page asks for: the messages of docs/live.md, as they are read here. Private."""
from __future__ import annotations

import math
import re
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .._interface import ENUMS

_SETTINGS_MAX, _KEY_MAX, _LARGEST = 1000, 400, 1e9
_BANDS_MAX = ENUMS["limit"]["channels_max"]
KINDS = ("wish", "ack", "probe", "take", "measure", "look")
FORMATS = ("png", "tif", "mha")


class Refusal(Exception):
    """A message that is no message. The text says why."""


@dataclass
class Wish:
    """How the scene shall be."""

    wish: int = 0
    #: KEY -> value, on top of what source, detector and options are.
    settings: dict[str, Any] = field(default_factory=dict)
    #: Number of a part -> what moves it in the world, on top of its pose, [16] row by row.
    poses: dict[str, list[float]] = field(default_factory=dict)
    #: Of the breath; None: as it was.
    phase: float | None = None
    #: Of the scan; None: the scene's own view.
    projection: int | None = None
    quantity: str = "attenuation"
    #: Edges of photon-counting bands in keV; none: one image of all energies.
    bands: list[float] = field(default_factory=list)
    #: Number of the band that is shown.
    channel: int = 0
    play: bool = False

    def moves(self) -> dict[int, NDArray[np.float64]]:
        return {int(part): np.array(rows, dtype=np.float64).reshape(4, 4) for part, rows in self.poses.items()}

    def json(self) -> dict[str, Any]:
        return dict(vars(self))


def kind_of(message: Any) -> str:
    """The kind of a message."""
    found = next((kind for kind in KINDS if isinstance(message, dict) and kind in message), None)
    if found is None:
        raise Refusal(f"a message is an object with one of the keys {', '.join(KINDS)}")
    return found


def read_wish(message: dict[str, Any]) -> tuple[Wish, bool]:
    """The wish, and whether something is being dragged."""
    values = dict(message)
    drag = values.pop("drag", False)
    for key, value in values.items():
        if key not in _READERS:
            raise Refusal(f'a wish has no key "{key[:40]}"')
        _READERS[key](value)
    _boolean("drag")(drag)
    return Wish(**values), drag


def read_probe(value: Any) -> tuple[float, float]:
    if not isinstance(value, list) or len(value) != 2 or not all(is_number(x) and abs(x) <= 1e6 for x in value):
        raise Refusal('"probe" is not [column, row]')
    return float(value[0]), float(value[1])


def read_ack(value: Any) -> int:
    if not _is_whole(value):
        raise Refusal('"ack" is no number of a frame')
    return int(value)


def read_take(value: Any) -> str:
    if value not in FORMATS:
        raise Refusal('"take" is not png, tif or mha')
    return str(value)


def is_number(value: Any) -> bool:
    return isinstance(value, (int, float)) and not isinstance(value, bool) and math.isfinite(value)


def _is_whole(value: Any) -> bool:
    return isinstance(value, int) and not isinstance(value, bool)


def _boolean(key: str) -> Callable[[Any], None]:
    def read(value: Any) -> None:
        if not isinstance(value, bool):
            raise Refusal(f'"{key}" is neither true nor false')

    return read


def _settings(value: Any) -> None:
    if not isinstance(value, dict):
        raise Refusal('"settings" is no object {"KEY": VALUE}')
    if len(value) > _SETTINGS_MAX:
        raise Refusal(f'"settings" has more than {_SETTINGS_MAX} keys')
    for key in value:
        if not key or len(key) > _KEY_MAX or "=" in key:
            raise Refusal(f'"settings": {key[:40]} is no key of a scene file')


def _poses(value: Any) -> None:
    if not isinstance(value, dict):
        raise Refusal('"poses" is no object {"PART": [16 numbers]}')
    for key, rows in value.items():
        if not re.fullmatch("[0-9]{1,9}", key, re.ASCII):
            raise Refusal(f'"poses": "{key[:40]}" is no number of a part')
        is_matrix = isinstance(rows, list) and len(rows) == 16 and all(is_number(x) and abs(x) <= _LARGEST for x in rows)
        if not is_matrix or rows[12:] != [0, 0, 0, 1]:
            raise Refusal(f'"poses": part {key} needs 16 numbers, row by row, the last row 0, 0, 0, 1')


def _number(value: Any) -> None:
    if not _is_whole(value) or not 0 <= value < 2 ** 32:
        raise Refusal('"wish" is no number of a wish')


def _phase(value: Any) -> None:
    if value is not None and not (is_number(value) and 0 <= value < 1):
        raise Refusal('"phase" is not from 0 to below 1')


def _projection(value: Any) -> None:
    if value is not None and not (_is_whole(value) and 0 <= value <= _LARGEST):
        raise Refusal('"projection" is no whole number from 0 on')


def _quantity(value: Any) -> None:
    if not isinstance(value, str) or value not in ENUMS["quantity"]:
        raise Refusal(f'"quantity" is not one of {", ".join(ENUMS["quantity"])}')


def _bands(value: Any) -> None:
    if not isinstance(value, list) or len(value) == 1 or len(value) > _BANDS_MAX + 1:
        raise Refusal(f'"bands" is no list of 2 to {_BANDS_MAX + 1} edges in keV')
    for number, edge in enumerate(value):
        if not (is_number(edge) and edge >= 0 and (number == 0 or edge > value[number - 1])):
            raise Refusal(f'"bands": edge {number + 1} is not an energy in keV above the one before it')


def _channel(value: Any) -> None:
    if not (_is_whole(value) and 0 <= value < _BANDS_MAX):
        raise Refusal('"channel" is no number of a band')


_READERS: dict[str, Callable[[Any], None]] = {
    "wish": _number, "settings": _settings, "poses": _poses, "phase": _phase, "projection": _projection, "quantity": _quantity,
    "bands": _bands, "channel": _channel, "play": _boolean("play")}
