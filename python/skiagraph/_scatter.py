"""Scattered photons: the option, the planes of an image and what is reported of them. Private."""
from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from . import _arrays
from ._breath import weighed
from ._frames import Batch
from ._images import compute, number_frames, together
from ._interface import ENUMS, ArgumentError
from ._library import filled
from ._state import State
from .report import scatter_report

#: What the planes of an image are.
_KINDS = {"total": "image", "image": "scatter", "sigma": "scatter_sigma"}


def accuracy(tolerance: float | None, histories: float | None) -> Any:
    """The option scatter of an image, from the arguments of scene.scatter()."""
    if tolerance is not None and histories is not None:
        raise ArgumentError("tolerance and histories exclude each other: with a tolerance, the number of histories "
                            "follows; give one of them")
    if histories is not None:
        return {"histories": histories}
    return True if tolerance is None else tolerance


#: Kinds of scatter, each in the orders one, two, and three or more.
_SCATTERED_BY = ("rayleigh", "compton")


def _outputs(components: bool) -> list[tuple[str, int]]:
    """The kinds of outputs and their components."""
    found = [(kind, 0) for kind in _KINDS.values()]
    if components:
        found += [("scatter_component", number) for number in sorted(ENUMS["scatter_component"].values())]
    return found


def prediction(state: State, options: dict[str, Any]) -> dict[str, Any]:
    """The prediction of skg_plan_scatter_predict as a dictionary."""
    with state.calls(), weighed(state):
        found = filled("skg_scatter_prediction", "skg_plan_scatter_predict", state.plan(options))
    return {"ratio": found["ratio"], "called_for": bool(found["called_for"]), "rms": found["rms"], "max": found["max"],
            "grid": {name: found[f"grid_{name}"] for name in ("primary", "scatter", "total")},
            "seconds": found["seconds"]}


def planes(state: State, quantity: str | None, components: bool, options: dict[str, Any]) -> dict[str, Any]:
    """The scattered part of an image, its standard error, the image, and what is reported of the scatter."""
    bands = options.get("bands")
    channels = () if bands is None else (len(_arrays.edges(bands)) - 1,)
    batch = Batch(1, index=number_frames(state, 1, None, options))
    dtype = np.float64 if options.get("precision") == "double" else np.float32
    wanted = _outputs(components)
    found = np.empty((len(wanted), *channels, *state.shape()), dtype)
    used: list[Any] = []

    def choose(output: Any, number: int) -> None:
        output.kind, output.component = ENUMS["output_kind"][wanted[number][0]], wanted[number][1]

    def submit(plan: Any) -> Any:
        used.append(plan)
        return together(list(found), choose)(plan)

    with state.calls():
        compute(state, submit, batch, found[0], False, True, bool(channels), {"quantity": quantity, **options})
        report = scatter_report(used[-1])
    assert report is not None  # a frame was rendered
    parts = found[len(_KINDS):]
    shown = {"components": dict(zip(_SCATTERED_BY, parts.reshape(2, 3, *parts.shape[1:])))} if components else {}
    return {**dict(zip(_KINDS, found)), **shown, **_summary(report, found[0], quantity)}


def _summary(report: Mapping[str, Any], total: Any, quantity: str | None) -> dict[str, Any]:
    """The numbers, with those that follow from the image."""
    image = np.exp(-total.astype(float)) if quantity == "attenuation" else total
    mean = report["mean"]
    primary = float(np.mean(image, dtype=float)) - mean
    return {"mean": mean, "error": report["sigma"] / mean if mean > 0 else 0.0,
            "ratio": mean / primary if primary > 0 else float("inf") if mean > 0 else 0.0,
            "errors": {name: share / mean if mean > 0 else 0.0 for name, share in zip(("histories", "cells", "smoothing"), report["errors"])},
            "orders": report["orders"],
            "kinds": {"rayleigh": report["rayleigh"], "compton": 1 - report["rayleigh"] if mean > 0 else 0.0},
            **{name: report[name] for name in ("histories", "seconds", "cosines", "cells", "mixture_error", "cells_error")}}
