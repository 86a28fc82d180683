"""Beams, and what a detector records of them."""
from __future__ import annotations

import os
from collections.abc import Mapping
from typing import Any, Union

import numpy as np
from numpy.typing import NDArray

from . import _arrays
from ._device import Log
from ._interface import ArgumentError
from ._library import call, choice, doubles, encode, ffi, fill, filled, integer, make, owned, retained, struct
from .material import Material, as_material
from .view import View

#: mm of each material, by its name or the material.
Layers = Union[Mapping[str, float], Mapping[Material, float]]


class Beam:
    """Photons by energy: how many would reach a pixel if nothing were in the way.

    The photons of an absolute beam, such as that of a tube with a load in mAs, are those per mm2 at a distance of 1 m. A
    scene finds out from its view how many of them a pixel receives, and lets them fall off with the distance.

    >>> Beam.mono(60, 1000)
    <Beam: 1 energy, 60 keV on average, 1000 photons>
    >>> beam = Beam.tube(100, filters={"Al": 2.5})
    >>> 3 < beam.quality["hvl1_mm_al"] < 4
    True
    >>> Beam.tube(100, filters={"Al": 2.5}, mas=2).absolute
    True
    """

    def __init__(self, kev: Any, photons: Any, absolute: bool = False) -> None:
        """energies in keV and photons per pixel, two lists alike. absolute: photons are per mm2 at 1 m."""
        energies, counts = np.atleast_1d(kev), np.atleast_1d(photons)
        if energies.shape != counts.shape or energies.ndim != 1:
            raise ArgumentError(f"kev has the shape {energies.shape} and photons {counts.shape}; give two lists alike")
        keep: list[Any] = []
        self._handle = owned("skg_spectrum", make(
            "skg_spectrum_create_bins", "skg_spectrum", len(energies), doubles(energies, "kev", keep),
            doubles(counts, "photons", keep)))
        if absolute:
            self._handle = owned("skg_spectrum", make("skg_spectrum_create_absolute", "skg_spectrum", self._handle))

    @classmethod
    def _of(cls, handle: Any) -> Beam:
        made = cls.__new__(cls)
        made._handle = handle
        return made

    @classmethod
    def _made(cls, name: str, *arguments: Any) -> Beam:
        return cls._of(owned("skg_spectrum", make(name, "skg_spectrum", *arguments)))

    @classmethod
    def _borrowed(cls, handle: Any) -> Beam:
        return cls._of(retained("skg_spectrum", handle))

    @classmethod
    def mono(cls, kev: float, photons: float) -> Beam:
        """One energy in keV, photons per pixel."""
        return cls._made("skg_spectrum_create_mono", *_arrays.reals(kev=kev, photons=photons))

    @classmethod
    def load(cls, path: str | os.PathLike[str], unit: str = "keV") -> Beam:
        """A text file of energies and photons per pixel, or a GATE macro."""
        return cls._made("skg_spectrum_load", encode(path, "path"), encode(unit, "unit"))

    @classmethod
    def tube(cls, kvp: float, filters: Layers | None = None, *,
             target_angle: float | None = None, mas: float | None = None, **fields: Any) -> Beam:
        """The spectrum of an X-ray tube.

        kvp: kV. filters: mm of each material, all that are in the beam. target_angle: degrees. mas: the load in mA s,
        with which the beam is absolute; without it, the photons of 1 mA s per mm2 at 1 m count as those of a pixel.
        fields: others of the library's skg_tube, such as anode, model and output_ugy_mas.
        """
        keep: list[Any] = []
        tube, log = struct("skg_tube"), Log()
        layers = filters or {}
        if mas is not None and not float(mas) > 0:
            raise ArgumentError(f"mas is {mas!r}; give a load above 0 mA s, or leave it out")
        given = {**fields, "kvp": kvp, "angle_deg": target_angle, "mas": mas}
        fill(tube, "skg_tube", given, keep, "the field of a tube")
        if layers:
            tube.filters, tube.filter_count = _filters(layers, keep), len(layers)
        tube.log = log.function
        made = cls._made("skg_spectrum_create_tube", tube)
        log.deliver()
        return made

    def filtered(self, filters: Layers) -> Beam:
        """The beam behind mm of each material."""
        keep: list[Any] = []
        return Beam._made("skg_spectrum_create_filtered", self._handle, len(filters), _filters(filters, keep))

    def scaled(self, factor: float) -> Beam:
        """All photon numbers multiplied by a factor."""
        return Beam._made("skg_spectrum_create_scaled", self._handle, _arrays.real(factor, "factor"))

    def _bins(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        count = integer("skg_spectrum_bin_count", self._handle)
        kev, photons = ffi.new("double[]", count), ffi.new("double[]", count)
        for i in range(count):
            call("skg_spectrum_bin_get", self._handle, i, kev + i, photons + i)
        return _arrays.fixed(np.array(list(kev))), _arrays.fixed(np.array(list(photons)))

    @property
    def energies(self) -> NDArray[np.float64]:
        """keV, rising; read-only, as photons."""
        return self._bins()[0]

    @property
    def photons(self) -> NDArray[np.float64]:
        """Photons at each energy: per pixel, or per mm2 at 1 m if the beam is absolute."""
        return self._bins()[1]

    @property
    def absolute(self) -> bool:
        """Whether photons are counted per mm2 at 1 m, not per pixel."""
        found = ffi.new("int32_t *")
        call("skg_spectrum_absolute_get", self._handle, found)
        return bool(found[0])

    def resolved(self, view: View) -> Beam:
        """The beam in photons per pixel of a view: at the foot of the perpendicular from the source to the detector."""
        return Beam._made("skg_spectrum_create_resolved", self._handle, view._write(struct("skg_view")))

    @property
    def quality(self) -> dict[str, float]:
        """Mean energy, half-value layers, air kerma and more."""
        return filled("skg_quality", "skg_spectrum_quality_get", self._handle)

    def plot(self, axes: Any = None) -> Any:
        """Draws the spectrum with Matplotlib, and returns the axes."""
        if axes is None:
            try:
                from matplotlib import pyplot
            except ImportError:
                raise ArgumentError("plot() needs Matplotlib, which is not installed; use energies and photons") \
                    from None
            axes = pyplot.subplots()[1]
        kev, photons = self._bins()
        if len(kev) == 1:
            axes.vlines(kev, 0, photons)
        else:
            axes.step(kev, photons, where="mid")
        axes.set(xlabel="energy / keV", ylabel="photons", xlim=(0, None), ylim=(0, None))
        return axes

    def __repr__(self) -> str:
        kev, photons = self._bins()
        plural = "energy" if len(kev) == 1 else "energies"
        return (f"<Beam: {len(kev)} {plural}, {np.average(kev, weights=photons):g} keV on average, "
                f"{photons.sum():g} photons{' per mm2 at 1 m' if self.absolute else ''}>")

    def __reduce__(self) -> tuple[Any, ...]:
        return Beam, (*self._bins(), self.absolute)


def _filters(layers: Layers, keep: list[Any]) -> Any:
    if not isinstance(layers, Mapping):
        raise ArgumentError(f"filters is {type(layers).__name__}; give the mm of each material, {{'Al': 2.5}}")
    made = struct("skg_filter", len(layers))
    for i, (material, thickness) in enumerate(layers.items()):
        keep.append(as_material(material))
        made[i].material = keep[-1]._handle
        made[i].thickness_mm = _arrays.real(thickness, "thickness of a filter")
    keep.append(made)
    return made


class Response:
    """Response of a detector to a photon: mean recorded energy in keV, and the fraction that is recorded.

    >>> round(Response.scintillator("CsI", 0.6).at(60)[0])
    52
    """

    def __init__(self, kev: Any, recorded_kev: Any, efficiency: Any = None, swank: Any = None, meaning: str = "signal") -> None:
        """A table at rising energies. efficiency: the share of the photons that are recorded; without it, each is, or with
        the meaning "absorbed" recorded_kev / kev. swank: Swank factors of the signals, by default 1.

        >>> Response([10, 100], [5, 50]).at(40)
        (20.0, 1.0)
        >>> Response([10, 100], [5, 50], meaning="absorbed").at(40)
        (20.0, 0.5)
        """
        given = {"energies_kev": kev, "recorded_kev": recorded_kev, "efficiency": efficiency, "swank": swank}
        lists = {name: np.atleast_1d(values) for name, values in given.items() if values is not None}
        if len({a.shape for a in lists.values()}) > 1 or lists["energies_kev"].ndim != 1:
            raise ArgumentError(f"the lists have the shapes {[a.shape for a in lists.values()]}; give lists alike")
        keep: list[Any] = []
        table = fill(struct("skg_response_table"), "skg_response_table",
                     {**lists, "count": len(lists["energies_kev"]), "meaning": choice("response_meaning", meaning, "meaning")}, keep, "the field of a response")
        self._make("skg_response_create_table", table)

    def _make(self, name: str, *arguments: Any) -> None:
        self._handle = owned("skg_response", make(name, "skg_response", *arguments))

    @classmethod
    def _made(cls, name: str, *arguments: Any) -> Response:
        made = cls.__new__(cls)
        made._make(name, *arguments)
        return made

    @classmethod
    def scintillator(cls, material: Material | str, thickness_mm: float, packing: float = 1, *,
                     deposition: str = "transport", escape: bool = False) -> Response:
        """A scintillator of this thickness, of which the share `packing` is filled. deposition: "transport" follows photons
        that it scatters until they leave it; "all": every interaction leaves all its energy. escape: K fluorescence
        leaves it.

        >>> round(Response.scintillator("CsI", 0.6, deposition="all").at(60)[0])
        53
        """
        return cls._made("skg_response_create_scintillator", as_material(material)._handle,
                         *_arrays.reals(thickness_mm=thickness_mm, packing=packing))._refined(deposition, escape)

    @classmethod
    def screen(cls, material: Material | str, mg_cm2: float, *, deposition: str = "transport",
               escape: bool = False) -> Response:
        """A scintillator of this mass per area; the rest as of scintillator."""
        return cls._made("skg_response_create_screen", as_material(material)._handle,
                         _arrays.real(mg_cm2, "mg_cm2"))._refined(deposition, escape)

    def _refined(self, deposition: str, escape: bool) -> Response:
        if deposition not in ("transport", "all"):
            raise ArgumentError(f"deposition {deposition!r} is unknown; give 'transport' or 'all'")
        made = self._made("skg_response_create_escaping", self._handle) if escape else self
        return made if deposition == "all" else self._made("skg_response_create_transporting", made._handle)

    @classmethod
    def load(cls, path: str | os.PathLike[str], unit: str = "keV") -> Response:
        """A text file of photon energies and mean recorded energies."""
        return cls._made("skg_response_load", encode(path, "path"), encode(unit, "unit"))

    def at(self, kev: float, oblique: float = 1) -> tuple[float, float]:
        """Recorded energy in keV and efficiency of photons of this energy."""
        recorded, efficiency = ffi.new("double *"), ffi.new("double *")
        call("skg_response_get", self._handle, *_arrays.reals(kev=kev, oblique=oblique), recorded, efficiency)
        return float(recorded[0]), float(efficiency[0])
