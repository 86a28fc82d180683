"""The beams of a twin."""
from __future__ import annotations

import inspect
from collections.abc import Sequence
from dataclasses import dataclass, field
from enum import Enum
from typing import Any

import numpy as np

from ..._interface import UnsupportedError

__all__ = ["SourceType", "TwinBeam", "TwinBeamFixedSpectrum", "TwinBeamMonochromatic", "TwinBeamTube", "TwinFlux",
           "beam_from_json"]


class SourceType(str, Enum):
    """Where the rays come from."""

    POINT = "point"
    PARALLEL = "parallel"


@dataclass(kw_only=True)
class TwinFlux:
    """Photons per cm2 at 1 m and second by keV, or by kV and mAs: a polynomial, or points and how to join them."""

    curve: list[float] = field(default_factory=list)
    x: list[float] = field(default_factory=list)
    y: list[float] = field(default_factory=list)
    interpolator: str = ""

    @property
    def is_calibrated(self) -> bool:
        """Whether there is a polynomial, or points."""
        return bool(self.curve) or bool(self.x and self.y and self.interpolator)

    def at(self, energy: float) -> float:
        """The flux at an energy in keV, or at a voltage in kV."""
        if self.curve:
            return float(np.polyval(self.curve, energy))
        try:
            import scipy.interpolate as joined  # type: ignore[import-untyped, import-not-found, unused-ignore]
        except ImportError:
            raise UnsupportedError("the flux of this twin is joined by SciPy, which is not installed (pip install scipy)") from None
        name, keys = self.interpolator, {}
        if name in ("Akima1DInterpolator", "Makima1DInterpolator"):
            name, keys = "Akima1DInterpolator", {} if name[0] == "A" else {"method": "makima"}
        made = getattr(joined, "make_smoothing_spline" if name == "SmoothingSpline" else name, None)
        if made is None:
            raise ValueError(f"flux: {self.interpolator!r} is no interpolator of SciPy")
        if keys and "method" not in inspect.signature(made.__init__).parameters:
            raise UnsupportedError("the flux of this twin is joined by modified Akima splines, which need SciPy 1.13")
        return float(made(self.x, self.y, **keys)(energy))

    @staticmethod
    def from_json(json: dict[str, Any]) -> TwinFlux:
        """Of a description."""
        return TwinFlux(curve=list(json.get("curve", [])), x=list(json.get("x", [])), y=list(json.get("y", [])),
                        interpolator=str(json.get("interpolator", "")))


@dataclass(kw_only=True)
class TwinBeam:
    """Properties that all beams have."""

    beam_type: str = ""
    shape: SourceType = SourceType.POINT
    filters: list[list[Any]] = field(default_factory=list)
    internal_filters: list[list[Any]] = field(default_factory=list)


@dataclass(kw_only=True)
class TwinBeamMonochromatic(TwinBeam):
    """One energy, of a range in keV."""

    keV: tuple[float, float]
    flux: TwinFlux


@dataclass(kw_only=True)
class TwinBeamTube(TwinBeam):
    """An X-ray tube: ranges of its voltage in kV and of its current in uA."""

    kV: tuple[float, float]
    uA: tuple[float, float]
    flux: TwinFlux
    #: Rows of voltage, current of the tube and current of the target.
    target_amperage_table: list[tuple[float, float, float]] = field(default_factory=list)

    @property
    def keV(self) -> tuple[float, float]:
        """The range of the voltage."""
        return self.kV

    @property
    def amperage_calibrated(self) -> bool:
        """Whether the current of the target is known."""
        return bool(self.target_amperage_table)

    def get_target_amperage(self, voltage: float, tube_amperage: float) -> float:
        """The current of the target in uA: that of the tube, or bilinear between the rows of the table."""
        if not self.amperage_calibrated:
            return tube_amperage
        known = {(row[0], row[1]): row[2] for row in self.target_amperage_table}
        (x0, x1, u), (y0, y1, v) = (_between(sorted({key[axis] for key in known}), value)
                                    for axis, value in enumerate((voltage, tube_amperage)))
        return ((1 - v) * ((1 - u) * known[x0, y0] + u * known[x1, y0]) + v * ((1 - u) * known[x0, y1] + u * known[x1, y1]))


@dataclass(kw_only=True)
class TwinBeamFixedSpectrum(TwinBeam):
    """Rows of keV and photons per cm2 at 1 m and second."""

    spectrum: list[tuple[float, float]]


def _between(steps: Sequence[float], value: float) -> tuple[float, float, float]:
    """The two steps about a value, and where it lies between them; beyond the ends, on their line."""
    if len(steps) == 1:
        return steps[0], steps[0], 0.0
    at = min(max(int(np.searchsorted(steps, value, side="right")) - 1, 0), len(steps) - 2)
    return steps[at], steps[at + 1], (value - steps[at]) / (steps[at + 1] - steps[at])


def beam_from_json(json: dict[str, Any]) -> TwinBeam:
    """The beam of a description."""
    kind = json.get("beam_type")
    common = {"beam_type": str(kind), "shape": SourceType(json["shape"])}
    if kind == "monochromatic":
        low, high = map(float, json["keV"])
        return TwinBeamMonochromatic(keV=(low, high), flux=TwinFlux.from_json(json["flux"]), **common)  # type: ignore[arg-type]
    common |= {"filters": list(json["filters"]), "internal_filters": list(json.get("inherent_filteration", []))}  # type: ignore[dict-item]
    if kind == "tube":
        volts, currents = map(float, json["kV"]), map(float, json["uA"])
        table = [tuple(map(float, row)) for row in json.get("target_amperage_table", []) if row]
        return TwinBeamTube(kV=tuple(volts), uA=tuple(currents), flux=TwinFlux.from_json(json["flux"]),  # type: ignore[arg-type]
                            target_amperage_table=table, **common)  # type: ignore[arg-type]
    if kind == "fixed-spectrum":
        return TwinBeamFixedSpectrum(spectrum=[(float(row[0]), float(row[1])) for row in json["spectrum"]],
                                     **common)  # type: ignore[arg-type]
    raise KeyError(f"beam_type {kind!r} is none of 'monochromatic', 'tube' and 'fixed-spectrum'")
