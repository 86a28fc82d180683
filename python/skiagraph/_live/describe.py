"""What a page is told of the scene and of each image, as docs/live.md has it. Private."""
from __future__ import annotations

import copy
import math
from typing import Any

import numpy as np

from .._interface import ENUMS, Error
from .._library import call, ffi, filled, listed, struct
from .._state import State
from ..report import scatter_report
from ..view import View
from .subject import Subject


def scene(subject: Subject, plan: Any, facts: dict[str, Any]) -> dict[str, Any]:
    """The message about the scene. facts: what is known besides."""
    state, options, keep = subject.state, None, []  # type: State, Any, list[Any]
    options = state.plans.options(state.options_setup, {}, keep)
    channel = listed("skg_channel", "skg_plan_channel", plan)[0]
    scan = subject.scan
    return {"scene": {
        "document": subject.document, "path": state.source.path or "scene", "device": state.device.info["name"],
        "state": subject.wish.json(), "parts": state.count(), "projections": len(scan or ()),
        "period": subject.period if subject.breathes else None, "load_ms": subject.load_ms,
        "channel": channel["name"], "unit": channel["unit"], "plan": _plan(plan), "beam": beam(state, subject.view()),
        "dose": None,  # the page has no panel: scene.dose() is a call away
        "spot": _spot(state, options), "jaws": _jaws(options),
        "angles": [] if scan is None else scan.angles.tolist(), "fixed": None,
        "without": None,  # nor one for slices: scene.scan() and reconstruct()
        **facts}}


def _plan(plan: Any) -> dict[str, Any]:
    report = filled("skg_plan_report", "skg_plan_report_get", plan)
    found = {name: report[name] for name in ("precision", "triangles", "planes", "nodes", "bins", "samples", "bound")}
    effects = [{**effect, "on": bool(effect["on"])} for effect in listed("skg_effect", "skg_plan_effect", plan)]
    return {**found, "device_mib": report["device_bytes"] / 2 ** 20, "effects": effects}


def beam(state: State, view: View) -> dict[str, Any]:
    """The open beam at the detector; empty if it has no such figures."""
    try:
        quality = state.require_beam().resolved(view).quality
    except Error:
        return {}
    # the kerma counts the photons of a pixel as if they were per mm2
    area = float(np.linalg.norm(np.cross(view.column_step, view.row_step)))
    return {"mean_kev": quality["mean_kev"], "photons": quality["photons"], "air_kerma_ugy": quality["air_kerma_ugy"] / area}


def _spot(state: State, options: Any) -> dict[str, Any] | None:
    """In mm; None in a parallel beam, which has none."""
    if state.require_view().projection != "point":
        return None
    if options.spot == ffi.NULL:
        return {"shape": ENUMS["spot_shape"]["point"], "extent": None}
    return {"shape": int(options.spot.shape), "extent": [float(x) for x in list(options.spot.extent)[:2]]}


def _jaws(options: Any) -> dict[str, Any] | None:
    """In mm, as the scene file counts them; None if they are open."""
    jaws, kinds = options.collimation, ENUMS["collimation_kind"]
    if jaws == ffi.NULL or jaws.kind == kinds["open"]:
        return None
    if jaws.kind == kinds["detector"]:
        return {"margin": float(jaws.margin_mm)}
    return {"edges": [jaws.low[0], jaws.high[0], -jaws.high[1], -jaws.low[1]], "distance": jaws.distance_mm}


def view(subject: Subject, its: View) -> dict[str, Any]:
    """Source, beam and detector as the page draws them: columns of the detector, the corners of the field in turn, and where the beam to each
    starts."""
    state, keep = subject.state, []  # type: State, list[Any]
    jaws = state.plans.options(state.options_setup, {}, keep).collimation
    field, opening = (_corners(jaws, its, on_jaws) for on_jaws in (0, 1))
    source = _source(subject, its)
    starts = [source if its.projection == "point" else end + source - its.detector for end in field]
    has_jaws = jaws != ffi.NULL and jaws.kind == ENUMS["collimation_kind"]["rectangle"]
    return {"projection": "point" if its.projection == "point" else "parallel", "source": source.tolist(),
            "centre": its.detector.tolist(), "up": (-its.row_step).tolist(), "columns": its.pixels[0], "rows": its.pixels[1],
            "strips": _strips(its), "steps": [its.column_step.tolist(), its.row_step.tolist()],
            "field": field.tolist(), "starts": [start.tolist() for start in starts], "jaws": opening.tolist() if has_jaws else []}


def _strips(its: View) -> list[Any]:
    """The ends of columns side by side from edge to edge, as the page draws a curved detector: 23 flat strips, each between the edges of
    narrower detectors about the same middle. Of a flat one two columns."""
    count, strips = 23 if its.radius > 0 else 1, []
    for place in range(-count, count + 1, 2):
        part = copy.copy(its)
        part.column_step, part.pixels = abs(place) / count * its.pixels[0] * its.column_step, (1, its.pixels[1])
        low, high, high_down, low_down = _corners(ffi.NULL, part, 0).tolist()
        strips.append([low, low_down] if place < 0 else [high, high_down])
    return strips


def _corners(jaws: Any, its: View, on_jaws: int) -> Any:
    made = np.empty((4, 3))
    call("skg_collimation_corners_get", jaws, its._write(struct("skg_view")), on_jaws, ffi.cast("double *", ffi.from_buffer(made)))
    return made


def _source(subject: Subject, its: View) -> Any:
    """Where the beam starts on its axis; of a source at infinity a point in front of the parts."""
    if its.projection != "parallel_from_infinity":
        return its.source
    along = -its.source / np.linalg.norm(its.source)
    low, high = subject.box
    corners = np.array([[(low, high)[i >> k & 1][k] for k in range(3)] for i in range(8)])
    return its.detector + 1.1 * max(0.0, float(((corners - its.detector) @ along).max())) * along


def shot(subject: Subject, its: View, plan: Any, number: int, ms: float, is_draft: bool) -> dict[str, Any]:
    """The message about an image."""
    wish, scattered = subject.wish, None if is_draft else scatter_report(plan)
    if scattered:
        scattered = {name: scattered[name] for name in ("mean", "sigma", "histories", "seconds")}
    return {"shot": number, "wish": wish.wish, "ms": ms, "phase": wish.phase, "state": wish.json(),
            "stages": {stage["name"]: stage["ns"] * 1e-6 for stage in listed("skg_stage", "skg_plan_stage", plan)},
            "beam": beam(subject.state, its), "scatter": scattered, "view": view(subject, its)}


def finite(value: Any) -> Any:
    """The same without numbers that JSON lacks, which become null."""
    if isinstance(value, float):
        return value if math.isfinite(value) else None
    if isinstance(value, dict):
        return {key: finite(item) for key, item in value.items()}
    if isinstance(value, (list, tuple)):
        return [finite(item) for item in value]
    return value.item() if isinstance(value, np.generic) else value
