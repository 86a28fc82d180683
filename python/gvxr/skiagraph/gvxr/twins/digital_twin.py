"""A twin: the description of a scanner, the settings that a script chooses, and the calls that make them so."""
from __future__ import annotations

import math
import os
import pathlib
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

from .. import beam as rays
from .. import detector as panel
from .. import readout, response, tube
from .beam import SourceType, TwinBeam, TwinBeamFixedSpectrum, TwinBeamMonochromatic, TwinBeamTube, beam_from_json
from .detector import TwinDetector
from .json5 import loads
from .stage import TwinStage, XYZRange

__all__ = ["DigitalTwin", "DigitalTwinSpecification", "Positional", "TwinBeamSettings", "TwinDetectorSettings"]

_Place = tuple[float, float, float]
_Layers = list[tuple[str, float]]


@dataclass(kw_only=True)
class DigitalTwinSpecification:
    """Abilities of a scanner."""

    name: str
    description: str
    date: str
    beams: dict[str, TwinBeam]
    detector: TwinDetector
    stage: TwinStage

    @staticmethod
    def from_json(json: dict[str, Any]) -> DigitalTwinSpecification:
        """Of a description."""
        return DigitalTwinSpecification(
            name=json["name"], description=json["description"], date=json["date"],
            beams={str(name): beam_from_json(beam) for name, beam in json["beams"].items()},
            detector=TwinDetector.from_json(json["detector"]), stage=TwinStage.from_json(json["stage"]))

    @staticmethod
    def from_file(path: str | os.PathLike[str]) -> DigitalTwinSpecification:
        """Of a file in JSON5."""
        return DigitalTwinSpecification.from_json(loads(pathlib.Path(path).read_text(encoding="utf-8")))


class Positional:
    """Something that has a place: x, y and z in mm, or the distance y along the beam alone."""

    def __init__(self, position: _Place) -> None:
        self._position = position

    @property
    def position(self) -> _Place:
        """x, y and z in mm."""
        return self._position

    @position.setter
    def position(self, value: float | Sequence[float]) -> None:
        if isinstance(value, (int, float)):
            value = [value]
        if len(value) == 1:
            self._position = (0.0, abs(float(value[0])), 0.0)
        elif len(value) == 3:
            self._position = (float(value[0]), abs(float(value[1])), float(value[2]))
        else:
            raise ValueError("a position is a distance along the beam, or x, y and z")

    @property
    def distance(self) -> float:
        """From the origin."""
        return math.hypot(*self._position)

    @distance.setter
    def distance(self, value: float) -> None:
        x, _, z = self._position
        if value < math.hypot(x, z):
            raise ValueError(f"a distance of {value:g} mm is less than the {math.hypot(x, z):g} mm beside the beam")
        self._position = (x, math.sqrt(value * value - x * x - z * z), z)


def _layers(value: Sequence[Any]) -> _Layers:
    """Filters, written ["Cu", 0.1] or [["Cu", 0.1], ["Al", 1]]."""
    if len(value) == 2 and isinstance(value[0], str):
        value = [value]
    for layer in value:
        if isinstance(layer, str) or len(layer) != 2 or not isinstance(layer[0], str):
            raise ValueError("a filter is [material, mm], or a list of such")
    return [(layer[0], float(layer[1])) for layer in value]


class TwinBeamSettings(Positional):
    """Energy in keV or voltage in kV, current in uA and filters of the beam."""

    def __init__(self, keV: float, uA: float, position: _Place) -> None:
        super().__init__(position)
        self.keV, self.uA = keV, uA
        self._filter: _Layers = []

    @property
    def kV(self) -> float:
        """The voltage: one number with keV."""
        return self.keV

    @kV.setter
    def kV(self, value: float) -> None:
        self.keV = value

    @property
    def filter(self) -> _Layers:
        """Materials and mm."""
        return self._filter

    @filter.setter
    def filter(self, value: Sequence[Any]) -> None:
        self._filter = _layers(value)

    def validate(self, beam: TwinBeam, stage: XYZRange) -> tuple[bool, list[str]]:
        """Whether something is wrong, and what."""
        found = list(self._errors(beam))
        found += stage.errors("Beam", self.position)
        return bool(found), found

    def _errors(self, beam: TwinBeam) -> Iterator[str]:
        if isinstance(beam, (TwinBeamMonochromatic, TwinBeamTube)) and not beam.keV[0] <= self.keV <= beam.keV[1]:
            unit = "kV" if isinstance(beam, TwinBeamTube) else "keV"
            yield f"{unit} of {self.keV:g} must be between {beam.keV[0]:g} {unit} and {beam.keV[1]:g} {unit}"
        if isinstance(beam, TwinBeamTube) and not beam.uA[0] <= self.uA <= beam.uA[1]:
            yield f"uA of {self.uA:g} must be between {beam.uA[0]:g} uA and {beam.uA[1]:g} uA"

    def __str__(self) -> str:
        return f"Beam Settings: keV: {self.keV}, uA: {self.uA}, filters: {self.filter}, position: {self.position} mm"


class TwinDetectorSettings(Positional):
    """Exposure in s, and which of the detector's resolutions and gains."""

    def __init__(self, exposure: float, position: _Place) -> None:
        super().__init__(position)
        self.exposure, self.fov, self.gain = exposure, 0, 0

    def resolution(self, detector: TwinDetector) -> list[int]:
        """The chosen one."""
        return detector.resolutions[self.fov]

    def validate(self, detector: TwinDetector, stage: XYZRange) -> tuple[bool, list[str]]:
        """Whether something is wrong, and what."""
        found = list(stage.errors("Detector", self.position))
        for name, chosen, choices in (("fov", self.fov, detector.resolutions), ("gain", self.gain, detector.gain.factors())):
            if not 0 <= chosen < len(choices):
                found.append(f"{name} of {chosen} must be 0" + (f" to {len(choices) - 1}" if len(choices) > 1 else ""))
        if detector.exposures and self.exposure not in detector.exposures:
            found.append(f"exposure of {self.exposure:g} s must be one of {detector.exposures}")
        elif self.exposure <= 0:
            found.append(f"exposure of {self.exposure:g} s must be a positive number")
        return bool(found), found

    def __str__(self) -> str:
        return f"Detector Settings: exposure: {self.exposure}, fov: {self.fov}, gain: {self.gain}, position: {self.position} mm"


class DigitalTwin:
    """A scanner with its settings. Nothing is simulated so before apply()."""

    def __init__(self, specification: DigitalTwinSpecification) -> None:
        self.specification = specification
        exposures = specification.detector.exposures
        self._detector = TwinDetectorSettings(exposures[0] if exposures else 0.5,
                                              specification.stage.detector.get_default_position())
        self.set_beam(next(iter(specification.beams)))

    @staticmethod
    def from_file(path: str | os.PathLike[str]) -> DigitalTwin:
        """Of a file in JSON5."""
        return DigitalTwin(DigitalTwinSpecification.from_file(path))

    @staticmethod
    def from_json(json: dict[str, Any]) -> DigitalTwin:
        """Of a description."""
        return DigitalTwin(DigitalTwinSpecification.from_json(json))

    @property
    def selected_beam(self) -> str:
        """The name of the beam."""
        return self._selected

    @property
    def beam(self) -> TwinBeamSettings:
        """The settings of the beam, its source among them."""
        return self._beam

    source = beam

    @property
    def detector(self) -> TwinDetectorSettings:
        """The settings of the detector."""
        return self._detector

    def get_beams(self) -> list[str]:
        """The names of the beams."""
        return list(self.specification.beams)

    def set_beam(self, beam_name: str) -> bool:
        """Takes another beam, in the middle of its ranges; false if there is none of that name."""
        made = self.specification.beams.get(beam_name)
        if made is None:
            return False
        energy = sum(made.keV) / 2 if isinstance(made, (TwinBeamMonochromatic, TwinBeamTube)) else 0.0
        current = sum(made.uA) / 2 if isinstance(made, TwinBeamTube) else 0.0
        self._selected = beam_name
        self._beam = TwinBeamSettings(energy, current, self.specification.stage.source.get_default_position())
        return True

    @property
    def sod(self) -> float:
        """From the source to the origin, in mm."""
        return self.beam.distance

    @sod.setter
    def sod(self, value: float) -> None:
        self.beam.distance = value

    @property
    def odd(self) -> float:
        """From the origin to the detector, in mm."""
        return self.detector.distance

    @odd.setter
    def odd(self, value: float) -> None:
        self.detector.distance = value

    @property
    def sdd(self) -> float:
        """From the source to the detector, in mm."""
        (x, y, z), (u, v, w) = self.beam.position, self.detector.position
        return math.hypot(u - x, v + y, w - z)

    def validate(self) -> tuple[bool, list[str]]:
        """Whether something is wrong with the settings, and what."""
        said = self.specification
        found = self.beam.validate(said.beams[self._selected], said.stage.source)[1]
        found += self.detector.validate(said.detector, said.stage.detector)[1]
        return bool(found), found

    def apply(self, *, disable_validation: bool = False) -> None:
        """Sets source, beam and detector so."""
        if disable_validation:
            print("The settings of the twin are not checked: the scanner may be unable to take them.")
        else:
            wrong, found = self.validate()
            if wrong:
                raise ValueError("\n".join(["Incorrect Twin Settings:", *found]))
        self._apply_detector(self.specification.detector)
        self._apply_beam(self.specification.beams[self._selected])

    def _apply_detector(self, made: TwinDetector) -> None:
        panel.setDetectorPixelSize(made.pixel_pitch, made.pixel_pitch, "um")
        panel.setDetectorNumberOfPixels(*self.detector.resolution(made))
        panel.setDetectorUpVector(0, 0, 1)
        panel.setDetectorPosition(*self.detector.position, "mm")
        layer = made.scintillator
        if layer.energy_response:
            response.setDetectorEnergyResponse(layer.energy_response, "keV")
        elif layer.material:
            response.setScintillator(layer.material, layer.thickness, "um")
        else:
            response.clearDetectorEnergyResponse()
        if made.lsf:
            response.setLSF(made.lsf)
        else:
            response.clearLSF()
        readout.setDetectorGain(made.gain.factors()[self.detector.gain])
        readout.setDetectorBias(made.darkfield.bias)
        readout.setDetectorStdDevBias(made.darkfield.sigma)

    def _apply_beam(self, made: TwinBeam) -> None:
        x, y, z = self.beam.position
        rays.setSourcePosition(x, -y, z, "mm")
        (rays.useParallelBeam if made.shape == SourceType.PARALLEL else rays.usePointSource)()
        rays.resetBeamSpectrum()
        tube.clearFiltration()
        tube.clearInherentFiltration()
        exposure = self.detector.exposure
        if isinstance(made, TwinBeamFixedSpectrum):
            for energy, photons in made.spectrum:
                rays.addEnergyBinToSpectrumPerCm2At1m(energy, "keV", photons * exposure)
        elif isinstance(made, TwinBeamMonochromatic):
            photons = made.flux.at(self.beam.keV) * exposure if made.flux.is_calibrated else 1e8
            rays.setMonoChromaticPerCm2At1m(self.beam.keV, "keV", photons)
        elif isinstance(made, TwinBeamTube):
            mAs = made.get_target_amperage(self.beam.kV, self.beam.uA) * 0.001 * exposure
            tube.setVoltage(self.beam.kV, "kV")
            tube.setmAs(mAs)
            for material, thickness in made.internal_filters:
                tube.addInherentFilter(material, thickness, "mm")
            if made.flux.is_calibrated:
                tube.setNumberOfPhotonsPerCm2At1m(made.flux.at(self.beam.kV) * mAs, True)
        for material, thickness in self.beam.filter:
            tube.addFilter(material, thickness, "mm")

    def __eq__(self, other: object) -> bool:
        return isinstance(other, DigitalTwin) and (self.specification, str(self)) == (other.specification, str(other))

    __hash__ = None  # type: ignore[assignment]

    def __str__(self) -> str:
        return (f"Selected Beam: {self._selected}\n{self.beam}\n\nDetector:\n{self.detector}\n\n"
                f"Stage:\nSOD: {self.sod}\nSDD: {self.sdd}\nODD: {self.odd}\n")
