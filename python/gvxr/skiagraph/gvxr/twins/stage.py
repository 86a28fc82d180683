"""Where source and detector of a twin may stand, in mm. y is the distance from the origin along the beam."""
from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

__all__ = ["TwinStage", "XYZRange"]

_Range = tuple[float, float, float | None] | None


def _range(values: list[float], positive: bool) -> _Range:
    """The least, the greatest, and the usual place if there is one; None for no limits."""
    if not values:
        return None
    low, high = (abs(v) if positive else v for v in values[:2])
    return low, high, values[2] if len(values) > 2 else None


@dataclass(kw_only=True)
class XYZRange:
    """A range of each axis."""

    x: _Range
    y: _Range
    z: _Range

    @staticmethod
    def from_json(json: dict[str, Any]) -> XYZRange:
        """Of a description."""
        return XYZRange(x=_range(list(json["x"]), False), y=_range(list(json["y"]), False), z=_range(list(json["z"]), True))

    def get_default_position(self) -> tuple[float, float, float]:
        """The usual place, or the middle; 500 mm along the beam where there are no limits."""
        def usual(limits: _Range, free: float) -> float:
            if limits is None:
                return free
            return limits[2] if limits[2] is not None else (limits[0] + limits[1]) / 2
        return usual(self.x, 0.0), abs(usual(self.y, 500.0)), usual(self.z, 0.0)

    def errors(self, name: str, position: tuple[float, float, float]) -> Iterator[str]:
        """Errors of a position, a sentence each."""
        for axis, limits, value in zip("xyz", (self.x, self.y, self.z), position):
            if limits is None or limits[0] <= value <= limits[1]:
                continue
            if limits[0] == limits[1]:
                yield f"{name} does not support {axis} movement: {axis} must be {limits[0]:g} mm, not {value:g} mm"
            else:
                yield f"{name} {axis} position {value:g} mm must be between {limits[0]:g} mm and {limits[1]:g} mm"


@dataclass(kw_only=True)
class TwinStage:
    """The ranges of source and detector."""

    source: XYZRange
    detector: XYZRange
    static_sdd: bool

    @staticmethod
    def from_json(json: dict[str, Any]) -> TwinStage:
        """Of a description."""
        return TwinStage(source=XYZRange.from_json(json["source"]), detector=XYZRange.from_json(json["detector"]),
                         static_sdd=bool(json["static_sdd"]))
