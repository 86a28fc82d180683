"""Plans of a scene, kept by their options. Private."""
from __future__ import annotations

from collections import OrderedDict
from collections.abc import Mapping
from typing import Any

import numpy as np

from . import _arrays
from ._device import Device
from ._interface import ENUMS, OK, STALE, ArgumentError
from ._library import call, check, choice, ffi, fill, lib, make, struct
from .beam import Beam
from .view import View

# Plans that are kept: each has memory on the device.
_MAX = 4
# Views of a batch for which the bound of a tolerance is verified.
_VIEWS = 16


class Pace:
    """How long frames of a plan took."""

    #: Seconds of each of the last frames that were waited for; 0: there were none.
    seconds = 0.0


class Plans:
    def __init__(self, device: Device) -> None:
        self._device = device
        self._kept: OrderedDict[Any, Any] = OrderedDict()
        self._paces: dict[Any, Pace] = {}
        self._file: tuple[Any, Any] = (ffi.NULL, ffi.NULL)

    def clear(self) -> None:
        self._file = (ffi.NULL, ffi.NULL)
        while self._kept:
            self._drop(self._kept.popitem()[1])

    def _drop(self, plan: Any) -> None:
        self._paces.pop(plan, None)
        self._device.drop("skg_plan", plan)

    def pace(self, plan: Any) -> Pace:
        """The pace of a plan that is kept."""
        return self._paces.setdefault(plan, Pace())

    def of_file(self, setup: Any) -> Any:
        """The library's skg_plan_options as the file says them. They are not to be changed; a set-up never changes them either."""
        if self._file[0] != setup:
            self._file = (setup, self.options(setup, {}, []))
        return self._file[1]

    def get(self, setup: Any, scene: Any, view: View, beam: Beam, options: Mapping[str, Any], anew: bool) -> Any:
        """A plan of these options, with this view; anew: also if there is one."""
        given = {name: value for name, value in options.items() if value is not None}
        key = (view.shape, _key(given))
        plan = self._kept.pop(key, None)
        if plan is not None and not anew and check(lib.skg_plan_view_set(plan, view._write(struct("skg_view")))) == OK:
            self._kept[key] = plan
            return plan
        if plan is not None:
            self._drop(plan)
        plan = self._make(setup, scene, view, beam, given)
        self._kept[key] = plan
        while len(self._kept) > _MAX:
            self._drop(self._kept.popitem(last=False)[1])
        return plan

    def _make(self, setup: Any, scene: Any, view: View, beam: Beam, given: dict[str, Any]) -> Any:
        keep: list[Any] = []
        options = self.options(setup, given, keep, view)
        return self._device.interruptible("skg_plan", lambda: make(
            "skg_plan_create", "skg_plan", self._device.handle, scene, view._write(struct("skg_view")), beam._handle, options))

    @staticmethod
    def options(setup: Any, given: Mapping[str, Any], keep: list[Any], view: View | None = None) -> Any:
        """The library's skg_plan_options: what the file says, and what is given besides, for a view."""
        options = struct("skg_plan_options")
        call("skg_setup_options_get", setup, options)
        values = {name: value for name, value in given.items() if value is not None}
        bands, views, blur = values.pop("bands", None), values.pop("views", None), values.pop("blur", None)
        scatter = values.pop("scatter", None)
        if scatter is not None:
            options.scatter = _scatter(scatter, options.scatter, keep)
        if bands is not None:
            edges = _arrays.edges(bands)
            values.update(band_kev=edges, bands=len(edges) - 1)
        if isinstance(blur, Mapping):
            values["blur"] = _blur(blur, view)
        elif blur is False:  # not even that of the file
            options.blur = ffi.NULL
        elif blur is not None:
            values["blur"] = blur
        if values.get("depth_blur") is False:
            options.depth_blur = ffi.NULL
            del values["depth_blur"]
        if views:
            sample = views[::-(-len(views) // _VIEWS)]
            written = struct("skg_view", len(sample))
            for i, one in enumerate(sample):
                one._write(written + i)
            keep.append(written)
            options.views, options.view_count = written, len(sample)
        return fill(options, "skg_plan_options", values, keep, "option")


def _scatter(given: Any, of_file: Any, keep: list[Any]) -> Any:
    """A skg_scatter: True, a tolerance, or its fields by name, over what the file says; NULL for False."""
    if isinstance(given, (bool, np.bool_)):
        if not given or of_file != ffi.NULL:
            return of_file if given else ffi.NULL
        given = {}
    if not isinstance(given, Mapping):
        given = {"tolerance": _arrays.real(given, "scatter")}
    if given.get("tolerance") is not None and given.get("histories") is not None:
        raise ArgumentError("scatter: tolerance and histories exclude each other: with a tolerance, the number of "
                            "histories follows; give one of them")
    made = struct("skg_scatter")
    if of_file != ffi.NULL:
        made[0] = of_file[0]
    values = dict(given)
    if values.get("tolerance") is not None:
        made.histories = 0
    elif values.get("histories") is not None:
        made.tolerance = 0
        histories = _arrays.real(values["histories"], "scatter: histories")
        if not histories.is_integer():
            raise ArgumentError(f"scatter: histories is {histories!r}; give a whole number")
        values["histories"] = int(histories)
    keep.append(fill(made, "skg_scatter", values, keep, "scatter: the field"))
    return made


def _lines(rows: Any, view: View) -> dict[str, Any]:
    """The line spread functions of a modulation transfer function [[line pairs per mm, value], ...] in the pixels of a view."""
    table = _arrays.numbers(rows, "blur: mtf")
    if table.ndim != 2 or table.shape[1] != 2:
        raise ArgumentError("blur: mtf has rows of line pairs per mm and value, such as [[0, 1], [2.5, 0.4]]")
    per_mm, mtf = (np.ascontiguousarray(column) for column in table.T)
    pixel_mm = [float(np.linalg.norm(step)) for step in (view.column_step, view.row_step)]
    lines = []
    for mm in pixel_mm:
        line, samples = np.zeros(ENUMS["limit"]["line_samples_max"]), ffi.new("int64_t *")
        call("skg_line_spread_get", len(table), ffi.from_buffer("double[]", per_mm), ffi.from_buffer("double[]", mtf), mm,
             ffi.from_buffer("double[]", line), samples)
        lines.append(line[:samples[0]])
    return {"along_row": lines[0], "along_column": lines[1], "pixel_mm": pixel_mm}


def _blur(blur: Mapping[str, Any], view: View | None) -> dict[str, Any]:
    """along_row and along_column, point [rows][columns], or mtf, with their numbers of samples."""
    if "mtf" in blur and view is not None:
        if len(blur) > 1:
            raise ArgumentError("blur: give mtf alone")
        blur = _lines(blur["mtf"], view)
    found = {name: np.atleast_1d(_arrays.numbers(value, f"blur: {name}")).astype(float) for name, value in blur.items()}
    if "point" in found:
        rows, columns = np.atleast_2d(found["point"]).shape
    else:
        columns = len(found.get("along_row", ()))
        rows = len(found.get("along_column", ()))
    return {**found, "columns": columns, "rows": rows}


def _key(value: Any) -> Any:
    """Equal for equal options."""
    if isinstance(value, Mapping):
        return tuple(sorted((name, _key(item)) for name, item in value.items()))
    if isinstance(value, (list, tuple)):
        return tuple(_key(item) for item in value)
    if isinstance(value, np.ndarray):
        return value.shape, str(value.dtype), value.tobytes()
    return value
