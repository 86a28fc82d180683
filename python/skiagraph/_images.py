"""Images and path lengths of a scene, one or a batch. Private."""
from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from . import _arrays
from ._frames import Batch, Stale, Submit, run
from ._interface import ENUMS, ArgumentError, SceneError
from ._library import choice, ffi, integer, lib, struct
from ._progress import Progress
from ._state import State
from .view import View, as_views

#: The keV of a unit in which energies may be given.
_KEV = {"eV": 1e-3, "keV": 1.0, "MeV": 1e3}


def number_frames(state: State, count: int, index: int | None, options: Mapping[str, Any]) -> int:
    """The number of the first of these frames: that of the caller, or the next one of a scene with noise."""
    seed = options.get("noise_seed")
    if seed is not None:
        _arrays.whole(seed, "noise_seed", 0)
    if index is not None:
        return _arrays.whole(index, "index", 0)
    if seed is not None:
        return 0
    with state.calls():
        file = state.plans.of_file(state.options_setup)
    given = [options.get("noise"), options.get("electronic_kev")]
    noise, electronic = (own if value is None else value for own, value in zip((file.noise, file.electronic_kev), given))
    first = state.frames
    if noise or electronic:
        state.frames += count
        return first
    return 0


def batch_of(state: State, poses: Mapping[str, Any] | None, views: Sequence[View] | None) -> Batch:
    """The frames of these poses and views."""
    count: int | None = None
    source = ""
    stacks, parts = [], []
    for label, value in (poses or {}).items():
        what = f"poses[{label!r}]"
        stack = _arrays.matrices(value, what)
        if stack.ndim == 3:
            count, source = _agree(count, source, len(stack), what)
        parts.append(state.number(label))
        stacks.append(stack)
    seen = [] if views is None else as_views(views)
    if views is not None:
        count, source = _agree(count, source, len(seen), "views")
    if not count:
        raise ArgumentError("there is nothing to compute: give views, or poses as {label: [n, 4, 4]}")
    together = None
    if parts:
        together = np.empty((count, len(parts), 4, 4))
        for i, stack in enumerate(stacks):
            together[:, i] = stack
    return Batch(count, 0, parts, together, seen)


def channels_of(state: State, options: Mapping[str, Any]) -> int | None:
    """The channels of images: bands, or windows of a detector that counts. None: images have no axis of channels."""
    bands, counter = options.get("bands"), options.get("counter")
    if bands is not None:
        return len(_arrays.edges(bands)) - 1
    if counter is not None and not hasattr(counter, "_handle"):
        raise ArgumentError(f"counter is {counter!r}; give a Counter")
    with state.calls():
        handle = counter._handle if counter is not None else state.plans.of_file(state.options_setup).counter
        return None if handle == ffi.NULL else integer("skg_counter_thresholds_get", handle)


def render(state: State, batch: Batch, out: Any, progress: Progress, one: bool, unit: str | None,
           **options: Any) -> NDArray[Any]:
    """Images. one: of a single frame, without the axis of frames."""
    if unit is not None and (unit not in _KEV or options.get("quantity") not in (None, "energy")):
        raise ArgumentError(f"unit {unit!r} with quantity {options.get('quantity') or 'energy'!r}: a unit is one of "
                            f"{', '.join(map(repr, _KEV))}, and for energy alone")

    def submit(plan: Any) -> Any:
        return lambda count, frames, output, job: lib.skg_plan_submit(plan, count, frames, 1, output, job)

    banded = channels_of(state, options) is not None
    with state.calls():
        image = compute(state, submit, batch, out, progress, one, banded, options)
    if unit is not None and unit != "keV":
        image /= image.dtype.type(_KEV[unit])
    return image


def lengths(state: State, labels: Sequence[str], kind: str, poses: Mapping[str, Any] | None, views: Sequence[View] | None,
            out: Any, progress: Progress, options: dict[str, Any]) -> list[NDArray[Any]]:
    """Path lengths through each of the parts, of the scene as it stands without poses and views. out: of one part.

    A frame has all of them as outputs. Each is a raster by itself, whose scale is that of its part, so that a part has the same
    bits alone and among others.
    """
    one = poses is None and views is None
    batch = Batch(1) if one else batch_of(state, poses, views)
    parts, what = [state.number(label) for label in labels], choice("lengths", kind, "kind")
    if not parts:
        return []
    with state.calls():
        raster = state.shape(batch.views[0] if batch.views else None)
    shape = raster if one else (batch.count, *raster)
    dtype = np.float64 if options.get("precision") == "double" else np.float32
    targets = [np.empty(shape, dtype) if out is None else _arrays.output(out, shape) for _ in parts]

    def choose(output: Any, number: int) -> None:
        output.kind, output.part, output.lengths = ENUMS["output_kind"]["lengths"], parts[number], what

    submit = together(targets, choose)
    with state.calls():
        if state.plans.of_file(state.options_setup).scatter != ffi.NULL:
            options = {"scatter": False, **options}  # lengths have none, and it is not for every scene
        compute(state, submit, batch, targets[0], progress, one, False, options)
    return targets


def expected(state: State, batch: Batch, one: bool, progress: Progress, options: dict[str, Any]) -> dict[str, NDArray[Any]]:
    """The mean of images and the variance of their noise."""
    found, kinds = channels_of(state, options), ("mean", "variance")
    with state.calls():
        raster = state.shape(batch.views[0] if batch.views else None)
    channels = () if found is None else (found,)
    dtype = np.float64 if options.get("precision") == "double" else np.float32
    targets = [np.empty((*(() if one else (batch.count,)), *channels, *raster), dtype) for _ in kinds]

    def choose(output: Any, number: int) -> None:
        output.kind = ENUMS["output_kind"][kinds[number]]

    with state.calls():
        compute(state, together(targets, choose), batch, targets[0], progress, one, bool(channels), options)
    return dict(zip(kinds, targets))


def together(targets: Sequence[NDArray[Any]], choose: Callable[[Any, int], None]) -> Callable[[Any], Submit]:
    """Submits frames with one output for each of the targets, which are alike; choose: says what it is, by its number."""
    places = [int(target.__array_interface__["data"][0]) for target in targets]

    def submit(plan: Any) -> Submit:
        def start(count: int, frames: Any, output: Any, job: Any) -> int:
            outputs, offset = struct("skg_output", len(places)), int(ffi.cast("intptr_t", output.data)) - places[0]
            for i, place in enumerate(places):
                outputs[i] = output[0]
                outputs[i].data = ffi.cast("void *", place + offset)
                choose(outputs[i], i)
            return int(lib.skg_plan_submit(plan, count, frames, len(places), outputs, job))

        return start

    return submit


def compute(state: State, submit: Callable[[Any], Submit], batch: Batch, out: Any, progress: Progress, one: bool, banded: bool,
            options: dict[str, Any]) -> NDArray[Any]:
    """Computes a batch with the plan of these options; a stale plan is made anew once."""
    batch.complete = state.completer()
    view = batch.views[0] if batch.views else None
    for again in (False, True):
        plan = state.plan(options, view, again)
        channels = 1 if not banded else integer("skg_plan_channel_count", plan)
        rows, columns = (view or state.require_view()).shape
        shape = (batch.count, channels, rows, columns)
        given = _shape(shape, one, banded)
        if out is None:
            target = np.empty(given, np.float64 if options.get("precision") == "double" else np.float32)
        else:
            target = _arrays.output(out, given)
        frames = target.reshape(shape) if out is None else _four(target, one, banded)
        try:
            run(state.device, submit(plan), batch, frames, progress, state.plans.pace(plan), _scatters(state, options))
            break
        except Stale as stale:
            if again:
                raise SceneError(str(stale)) from None
    return target


def _scatters(state: State, options: Mapping[str, Any]) -> bool:
    """Whether frames may have scatter, which is computed as they are submitted."""
    given = options.get("scatter")
    return state.plans.of_file(state.options_setup).scatter != ffi.NULL if given is None else given is not False


def _agree(count: int | None, source: str, given: int, what: str) -> tuple[int, str]:
    if count is not None and count != given:
        raise ArgumentError(f"{what} has {given} frames and {source} {count}; give as many")
    return given, what


def _shape(shape: tuple[int, ...], one: bool, banded: bool) -> tuple[int, ...]:
    """The shape as the caller sees it."""
    return (() if one else shape[:1]) + (shape[1:2] if banded else ()) + shape[2:]


def _four(array: NDArray[Any], one: bool, banded: bool) -> NDArray[Any]:
    """The caller's array with the axes that it lacks, on the same memory."""
    if not banded:
        array = array[..., None, :, :]
    return array[None] if one else array
