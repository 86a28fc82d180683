"""Images for a page: computed by the plans of the scene, and packed as docs/live.md has them. Private."""
from __future__ import annotations

import struct
import time
import warnings
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .. import _images
from .._device import RangeWarning
from .._frames import Batch
from .._interface import ENUMS, ArgumentError
from .._library import listed
from .._picture import encode_picture
from ..view import View
from .subject import Subject
from .wish import Wish

#: ms that an image may take while something is dragged, and the fewest pixels that it then has.
_FLUENT, _FEWEST = 40, 4096
#: number, wish, columns, rows, low, step, flat field, ms, factor, quantity, notes
_HEADER = struct.Struct("<4sIIHHdddfHBB")
_DRAFT, _INFINITE, _RANGE = 1, 2, 4
#: Of a PNG, the share of the pixels that is black and that is white.
_OUTSIDE = 0.005


@dataclass
class Frame:
    image: NDArray[Any]
    plan: Any
    view: View
    ms: float
    factor: int
    is_draft: bool
    is_outside: bool
    #: Flat field of the band that is shown; 0 for attenuations.
    flat: float


class Camera:
    """Makes the frames of a subject. While something is dragged they may have fewer pixels, and they have no scatter."""

    def __init__(self, subject: Subject) -> None:
        self.subject = subject
        self.anew()

    def anew(self) -> None:
        """Other plans follow."""
        #: ms of the last whole image but the first, for which kernels are made; 0: there is none yet.
        self.ms = 0.0
        self._whole = 0

    def make(self, drag: bool) -> Frame:
        subject = self.subject
        state, view = subject.state, subject.view()
        options: dict[str, Any] = {"quantity": subject.wish.quantity, "profile": True}
        if subject.wish.bands:
            options["bands"] = subject.wish.bands
        of_file = state.plans.options(state.options_setup, {}, [])
        has_scatter = bool(of_file.scatter)
        # what counts has pixels of its own
        factor = self._factor(view) if drag and not has_scatter and not of_file.counter else 1
        is_draft = drag and (factor > 1 or has_scatter)
        if is_draft:
            view, options["scatter"] = _coarse(view, factor), False
            if factor > 1:  # it is less than a pixel of these, as a rule
                options["blur"] = options["depth_blur"] = False
        start = time.perf_counter()
        with warnings.catch_warnings(record=True) as said:
            warnings.simplefilter("always")
            image = _images.render(state, subject.batch(view), None, False, True, None, **options)
        if image.ndim > 2:  # bands, or windows of a detector that counts
            image = image[subject.wish.channel]
        ms = 1000 * (time.perf_counter() - start)
        if not is_draft:
            self._whole += 1
            self.ms = ms if self._whole > 1 else 0.0
        is_outside = any(issubclass(warning.category, RangeWarning) for warning in said)
        with state.calls():
            plan = state.plan(options, view)
            flat = listed("skg_channel", "skg_plan_channel", plan)[subject.wish.channel]["flat_field"]
        return Frame(image, plan, view, ms, factor, is_draft, is_outside, flat)

    def _factor(self, view: View) -> int:
        """Pixels of the detector for each of a draft, along a side: the time goes about with the pixels."""
        factor, pixels = 1, view.pixels[0] * view.pixels[1]
        while self.ms / factor ** 2 > _FLUENT and pixels / factor ** 2 > _FEWEST:
            factor += 1
        return factor


def _coarse(view: View, factor: int) -> View:
    """The same detector with larger pixels."""
    columns, rows = (max(1, count // factor) for count in view.pixels)
    return View(source=view.source, detector=view.detector, column_step=view.column_step * (view.pixels[0] / columns),
                row_step=view.row_step * (view.pixels[1] / rows), pixels=(columns, rows), projection=view.projection,
                radius=view.radius)


def pack(frame: Frame, number: int, wish: Wish) -> bytes:
    """The header, and rows of 16-bit numbers between the least and the largest value."""
    image = frame.image.astype(np.float32, copy=False)
    is_finite = np.isfinite(image)
    low, high = (float(image[is_finite].min()), float(image[is_finite].max())) if is_finite.any() else (0.0, 0.0)
    step = (high - low) / 65535
    with np.errstate(all="ignore"):
        numbers = (image - np.float32(low)) * np.float32(1 / step if step > 0 else 0) + np.float32(0.5)
    # what is no number is shown as the largest, too
    packed = np.clip(np.nan_to_num(numbers, nan=65535, posinf=65535, neginf=0), 0, 65535).astype("<u2")
    notes = _DRAFT * frame.is_draft | _INFINITE * (not is_finite.all()) | _RANGE * frame.is_outside
    rows, columns = image.shape
    header = _HEADER.pack(b"SKLF", number, wish.wish, columns, rows, low, step, frame.flat, frame.ms, frame.factor,
                          ENUMS["quantity"][wish.quantity], notes)
    rows16: bytes = packed.tobytes()
    return header + rows16


def probe(subject: Subject, at: tuple[float, float]) -> list[list[Any]]:
    """[label, mm] of the parts on the ray of a pixel."""
    state, view = subject.state, subject.view()
    if not (0 <= at[0] < view.pixels[0] and 0 <= at[1] < view.pixels[1]):
        raise ArgumentError('"probe": the detector has no such pixel')
    column, row = (int(x) + 0.5 - 0.5 * count for x, count in zip(at, view.pixels))
    place, step = view.pixel(column, row)
    pixel = View(source=view.source, detector=place, column_step=step, row_step=view.row_step, pixels=(1, 1),
                 projection=view.projection)
    labels = [part.label for part in state.parts()]
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        found = _images.lengths(state, labels, "net", None, [pixel], None, False, {"overlaps": 0})
    # a tenth of a micrometre is what rounding leaves of a part that the ray misses
    return [[label, float(mm.ravel()[0])] for label, mm in zip(labels, found) if abs(float(mm.ravel()[0])) > 1e-4]


def take(subject: Subject, ending: str) -> bytes:
    """A file of the image as scene.image() has it: SKLB, the length of its name, the name, its bytes."""
    state, view = subject.state, subject.view()
    image = _images.render(state, subject.batch(view), None, False, True, None)
    with state.calls():
        channel = listed("skg_channel", "skg_plan_channel", state.plan({}, view))[0]
    name = f"image.{ending}"
    low, high = np.quantile(image, (_OUTSIDE, 1 - _OUTSIDE))
    data = encode_picture(name, image, names=[channel["name"]], unit=channel["unit"], view=view,
                          flat_field=channel["flat_field"], range=(float(low), float(high)))
    return b"SKLB" + struct.pack("<I", len(name)) + name.encode() + data
