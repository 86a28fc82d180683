"""The detector of a twin."""
from __future__ import annotations

from dataclasses import dataclass
from typing import Any

__all__ = ["TwinADU", "TwinDarkfield", "TwinDetector", "TwinDetectorGain", "TwinGain", "TwinNoGain", "TwinScintillator",
           "gain_from_config"]


@dataclass(kw_only=True)
class TwinScintillator:
    """A scintillator: material, thickness in um, and rows of energy and response in keV if they are known."""

    material: str
    thickness: float
    energy_response: list[list[float]] | None = None


@dataclass(kw_only=True)
class TwinGain:
    """Gains to choose from."""

    gains: list[float]

    def factors(self) -> list[float]:
        """The gains."""
        return self.gains


@dataclass(kw_only=True)
class TwinADU:
    """Gains of 1 / (k x adu) to choose from."""

    k: float
    adus: list[float]

    def factors(self) -> list[float]:
        """The gains."""
        return [1 / (self.k * adu) for adu in self.adus]


@dataclass(kw_only=True)
class TwinNoGain:
    """A gain of 1."""

    def factors(self) -> list[float]:
        """The gain."""
        return [1.0]


TwinDetectorGain = TwinADU | TwinGain | TwinNoGain


def gain_from_config(json: dict[str, Any]) -> TwinDetectorGain:
    """The gain of a description."""
    if "k" in json:
        return TwinADU(k=float(json["k"]), adus=list(map(float, json["adus"])))
    gains = list(json.get("gains", [1]))
    return TwinNoGain() if gains == [1] else TwinGain(gains=gains)


@dataclass(kw_only=True)
class TwinDarkfield:
    """Dark signal of each image, and its deviation from pixel to pixel."""

    bias: float
    sigma: float


@dataclass(kw_only=True)
class TwinDetector:
    """Exposures in s (any if there are none), resolutions in pixels, the pitch of the pixels in um, and the rest."""

    exposures: list[float]
    resolutions: list[list[int]]
    pixel_pitch: float
    lsf: list[float]
    scintillator: TwinScintillator
    gain: TwinDetectorGain
    darkfield: TwinDarkfield

    @staticmethod
    def from_json(json: dict[str, Any]) -> TwinDetector:
        """Of a description."""
        layer, dark = json["scintillator"], json["darkfield"]
        return TwinDetector(
            exposures=list(json["exposures"]), resolutions=[list(pair) for pair in json["resolutions"]],
            pixel_pitch=float(json["pixel_pitch"]), lsf=list(json["lsf"]), gain=gain_from_config(json["gain"]),
            scintillator=TwinScintillator(material=layer["material"], thickness=float(layer["thickness"]),
                                          energy_response=layer.get("energy_response") or None),
            darkfield=TwinDarkfield(bias=float(dark["bias"]), sigma=float(dark["sigma"])))
