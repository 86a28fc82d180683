"""Messages of a page (docs/live.md), which the library reads. Private."""
from __future__ import annotations

import json
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .._library import filled, make, owned, string


class Message:
    """A message. One that is none is an ArgumentError, whose text is for the page."""

    def __init__(self, content: Any) -> None:
        text = json.dumps(content).encode()
        self.handle = owned("skg_live_message", make("skg_live_message_create", "skg_live_message", text, len(text)))
        #: The fields of the library's skg_live_asked.
        self.says = filled("skg_live_asked", "skg_live_message_get", self.handle)
        self.kind: str = self.says["kind"]


class Wish(Message):
    """How the scene shall be: all keys of a wish but "drag", as attributes."""

    wish: int
    #: KEY -> value, on top of what source, detector and options are.
    settings: dict[str, Any]
    #: Number of a part -> what moves it in the world, on top of its pose, [16] row by row.
    poses: dict[str, list[float]]
    #: Of the breath; None: as it was.
    phase: float | None
    #: Of the scan; None: the scene's own view.
    projection: int | None
    quantity: str
    bands: list[float]
    channel: int
    play: bool

    def __init__(self, content: Any) -> None:
        super().__init__(content)
        vars(self).update(self.json())

    def moves(self) -> dict[int, NDArray[np.float64]]:
        return {int(part): np.array(rows, dtype=np.float64).reshape(4, 4) for part, rows in self.poses.items()}

    def json(self) -> dict[str, Any]:
        state: dict[str, Any] = json.loads(string("skg_live_message_text_get", self.handle))
        return state

    def but(self, **changes: Any) -> Wish:
        """A wish with other values of some keys, and nothing being dragged."""
        return Wish({**self.json(), **changes})


def read(content: Any) -> Message:
    return Wish(content) if isinstance(content, dict) and "wish" in content else Message(content)
