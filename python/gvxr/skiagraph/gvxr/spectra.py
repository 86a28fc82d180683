"""Spectra of tubes and of text files, for skiagraph.gvxr.utils. Private: the names are those of gVXR's module utils."""
from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .._interface import FormatError
from ..beam import Beam
from ..material import Material
from . import beam as source
from . import detector, tube
from .state import material_of, millimetres

Spectrum = tuple[NDArray[np.float64], NDArray[np.float64], str]
Loaded = tuple[dict[float, float], Any, Any, str]


def _thickness(layer: Sequence[Any]) -> float:
    """mm, of [material, thickness] or [material, thickness, unit]."""
    return float(layer[1]) * (millimetres(layer[2]) if len(layer) > 2 else 1)


def getSpectrumSpekpy(kvp_in_kV: float, filters: Any = None, th_in_deg: float = 12,
                      max_number_of_energy_bins: int | None = None, mAs: float | None = None, z: float | None = None,
                      inherent_filtration_thickness_in_mm: float | None = 0.5,
                      inherent_filtration_material: str | None = "Al") -> Spectrum:
    """keV, photons and "keV" of a tube, by Skiagraph's own model, which is calibrated with SpekPy.

    With mAs and z (cm), photons per pixel at this distance; without them, their density over keV sums to 1.
    """
    layers: dict[Material, float] = {}
    if inherent_filtration_material and inherent_filtration_thickness_in_mm and inherent_filtration_thickness_in_mm > 0:
        layers[material_of(inherent_filtration_material)] = float(inherent_filtration_thickness_in_mm)
    for layer in filters or ():
        if layer[0] not in (None, "None"):
            layers[material_of(layer[0])] = _thickness(layer)
    absolute = bool(mAs and z and mAs > 0 and z > 0)
    beam = Beam.tube(kvp_in_kV, layers, target_angle=th_in_deg)  # photons of 1 mAs per mm2 at 1 m
    kev, photons = removeEmptyEnergyBins(beam.energies, beam.photons)
    if absolute:
        photons = photons * (float(mAs or 0) * 100 * (100 / float(z or 100)) ** 2 * detector.getDetectorPixelArea("cm"))
    else:
        photons = photons / photons.sum()
    return (*reduceNumberOfBins(kev, photons, max_number_of_energy_bins), "keV")


getSpekpySpectrum = getSpectrumSpekpy


def getSpectrumXpecgen(kvp_in_kV: float, filters: Any = None, th_in_deg: float = 12,
                       max_number_of_energy_bins: int | None = None,
                       inherent_filtration_thickness_in_mm: float | None = 0.5,
                       inherent_filtration_material: str | None = "Al") -> Spectrum:
    """Energies, photons and unit of a tube without an exposure, by Skiagraph's own model."""
    return getSpectrumSpekpy(kvp_in_kV, filters, th_in_deg, max_number_of_energy_bins, None, None,
                             inherent_filtration_thickness_in_mm, inherent_filtration_material)


getXpecgenSpectrum = getSpectrumXpecgen


def removeEmptyEnergyBins(energy_bins: Any, photon_counts: Any) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Without the energies of which the photons carry 1 eV at most; in keV."""
    kev, photons = np.asarray(energy_bins, dtype=float), np.asarray(photon_counts, dtype=float)
    kept = kev * photons > 1e-3
    return kev[kept], photons[kept]


def reduceNumberOfBins(energy_bins: Any, photon_counts: Any,
                       max_number_of_energy_bins: int | None) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Neighbouring bins together until there are no more than this; the energies are means by photons."""
    kev, photons = np.asarray(energy_bins, dtype=float), np.asarray(photon_counts, dtype=float)
    if not max_number_of_energy_bins or len(kev) <= max_number_of_energy_bins:
        return kev, photons
    groups = np.array_split(np.arange(len(kev)), int(max_number_of_energy_bins))
    sums = np.array([photons[group].sum() for group in groups])
    means = np.array([np.average(kev[group], weights=photons[group] if photons[group].sum() > 0 else None)
                      for group in groups])
    return means, sums


def getSpectrumTextFile(fname: str, units: str, verbose: int = 0, max_number_of_energy_bins: int | None = None) -> Spectrum:
    """The last two columns of a text file of two or three: energy and photons. Lines with # are comments."""
    rows = []
    with open(fname, encoding="utf-8") as file:
        for number, line in enumerate(file, 1):
            words = line.split("#")[0].split()
            if not words:
                continue
            try:
                energy, count = (float(word) for word in words[-2:])
            except ValueError:
                energy = count = float("nan")
            if len(words) not in (2, 3) or not np.isfinite([energy, count]).all():
                raise FormatError(f"{fname}: line {number}: {line.strip()!r} is no row of energy and photons; give 2 or 3 columns "
                                  "of numbers")
            rows.append((energy, count))
            if verbose > 0:
                print(f"{count:g} photons of {energy:g} {units}")
    energies, counts = np.array(rows, dtype=float).reshape(-1, 2).T
    return (*reduceNumberOfBins(energies, counts, max_number_of_energy_bins), units)


getTextFileSpectrum = getSpectrumTextFile


def loadSpectrum(energy_bins: Any, photon_counts: Any, unit: str, reset_tube_parameters: bool = True) -> dict[float, float]:
    """Makes it the spectrum of the beam, photons per pixel."""
    source.resetBeamSpectrum(reset_tube_parameters)
    spectrum: dict[float, float] = {}
    for energy, count in zip(energy_bins, photon_counts):
        if count > 1e-6:
            spectrum[energy] = spectrum.get(energy, 0) + count
            source.addEnergyBinToSpectrum(energy, unit, count)
    return spectrum


def applyFiltration(filters: Any) -> None:
    """The filters of the beam: rows of material, thickness and unit, mm by default."""
    tube.clearFiltration()
    for layer in filters or ():
        tube.addFilter(layer[0], _thickness(layer), "mm")


def _load(found: Spectrum, kvp: float, angle: float, mAs: float | None, filters: Any) -> Loaded:
    tube.setVoltage(kvp, "kV")
    tube.setTubeAngle(angle)
    tube.setmAs(mAs if mAs else -1)
    tube.clearFiltration()
    spectrum = loadSpectrum(*found, False)
    applyFiltration(filters)
    # Before there is a detector, the distance is not known at which the photons would be counted.
    counts = tube.getPhotonCountsPerCm2At1m() if detector.getDetectorVertices() else tube.getPhotonCountEnergyBins()
    return spectrum, tube.getEnergyBins(found[2]), counts, found[2]


def loadSpectrumSpekpy(kvp_in_kV: float, filters: Any = None, th_in_deg: float = 12,
                       max_number_of_energy_bins: int | None = None, mAs: float | None = None, z: float | None = None,
                       inherent_filtration_thickness_in_mm: float | None = 0.5,
                       inherent_filtration_material: str | None = "Al") -> Loaded:
    """Makes the spectrum of a tube the beam's. Returns it, its energies, photons per cm2 at 1 m behind the filters, and
    the unit."""
    found = getSpectrumSpekpy(kvp_in_kV, None, th_in_deg, max_number_of_energy_bins, mAs, z,
                              inherent_filtration_thickness_in_mm, inherent_filtration_material)
    return _load(found, kvp_in_kV, th_in_deg, mAs, filters)


loadSpekpySpectrum = loadSpectrumSpekpy


def loadSpectrumXpecgen(kvp_in_kV: float, filters: Any = None, th_in_deg: float = 12,
                        max_number_of_energy_bins: int | None = None,
                        inherent_filtration_thickness_in_mm: float | None = 0.5,
                        inherent_filtration_material: str | None = "Al") -> Loaded:
    """Sets the beam of a tube without an exposure, by Skiagraph's own model."""
    return loadSpectrumSpekpy(kvp_in_kV, filters, th_in_deg, max_number_of_energy_bins, None, None,
                              inherent_filtration_thickness_in_mm, inherent_filtration_material)


loadXpecgenSpectrum = loadSpectrumXpecgen


def loadSpectrumTextFile(fname: str, units: str, max_number_of_energy_bins: int | None = None) -> Loaded:
    """Makes the spectrum of a text file the beam's."""
    energies, counts, unit = getSpectrumTextFile(fname, units, 0, max_number_of_energy_bins)
    return loadSpectrum(energies, counts, unit), energies, counts, unit


loadTextFileSpectrum = loadSpectrumTextFile
