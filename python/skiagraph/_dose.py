"""Doses of people and things by an exposure. Private."""
from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from . import _arrays
from ._breath import weighed
from ._interface import ArgumentError
from ._library import ffi, filled, listed, make, release, struct
from ._progress import Progress, Watch
from ._state import State
from .scan import Scan


def _known(value: float) -> float | None:
    return None if math.isnan(value) else value


def _report(state: State, handle: Any) -> dict[str, Any]:
    """Contents of `skiagraph dose --json`, and values that Python has besides."""
    report = filled("skg_dose_report", "skg_dose_report_get", handle)
    parts = [(part.label, filled("skg_dose_part", "skg_dose_part_get", handle, i)) for i, part in enumerate(state.parts())]
    found = {
        "kerma": [{"at": point["at"], "air_kerma_uGy": point["air_kerma_ugy"], "backscatter": _known(point["backscatter"])}
                  for point in listed("skg_dose_point", "skg_dose_point", handle)],
        "kap_uGy_cm2": report["kap_ugy_cm2"], "detector_air_kerma_uGy": report["detector_air_kerma_ugy"],
        "exposure_index": _known(report["exposure_index"]),
        "parts": [{"label": label, "dose_uGy": _known(part["dose_ugy"]), "sigma": _known(part["sigma_ugy"]),
                   "energy_keV": _known(part["energy_kev"])} for label, part in parts],
        "hvl1_mm_al": report["hvl1_mm_al"], "hvl2_mm_al": report["hvl2_mm_al"]}
    if report["has_darkest"]:
        found["darkest"] = {"row": report["darkest_row"], "column": report["darkest_column"],
                            "signal": report["darkest_signal"], "snr": report["darkest_snr"]}
    return found


def _sum(handle: Any, times: float) -> Any:
    """The dose of so many equal exposures; takes over the handle of one."""
    try:
        return make("skg_dose_sum", "skg_dose", 1, ffi.new("skg_dose *[1]", [handle]), ffi.new("double[1]", [times]))
    finally:
        release("skg_dose", handle)


def dose(state: State, at: ArrayLike | None, scan: Scan | None, times: float, histories: int | None, seed: int,
         progress: Progress, options: dict[str, Any]) -> dict[str, Any]:
    places = np.ascontiguousarray(() if at is None else _arrays.numbers(at, "at"), dtype=np.float64)
    if at is not None and (places.ndim not in (1, 2) or places.shape[-1] != 3):
        raise ArgumentError(f"at has the shape {places.shape}; give a place [x, y, z] in mm, or several [n, 3]")
    asked = struct("skg_dose_options")
    asked.point_count, asked.seed = places.size // 3, _arrays.whole(seed, "seed")
    times = _arrays.real(times, "times")
    if histories is not None:
        asked.histories = _arrays.whole(histories, "histories")
    if places.size:
        asked.points = ffi.cast("double *", ffi.from_buffer(places))
    with state.calls(), weighed(state):
        with Watch(progress, "rounds of photons" if scan is None else "projections") as asked.progress:
            if scan is None:
                handle = make("skg_dose_create", "skg_dose", state.plan(options), asked)
            else:
                handle = make("skg_scan_dose_create", "skg_dose", state.plan(options, scan[0]), scan._handle, asked)
        if times != 1:
            handle = _sum(handle, times)
        try:
            return _report(state, handle)
        finally:
            release("skg_dose", handle)
