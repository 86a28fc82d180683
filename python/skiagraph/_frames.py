"""Batches of frames: submitted a few at a time, so that an interrupt is answered at once. Private."""
from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ._device import Device, RangeWarning, warn
from ._interface import ENUMS, OK, RANGE, STALE
from ._library import call, check, ffi, lib, struct, text
from ._plans import Pace
from ._progress import Meter, Progress, Watch
from .view import View

# A chunk of frames takes about this long, s: two of them are under way when an interrupt comes.
_CHUNK = 0.05
# Longest sleep between two looks at a job, s.
_NAP = 0.005


@dataclass
class Batch:
    """Frames to compute. poses: [n, parts, 16] of the parts with these numbers."""

    count: int
    index: int = 0
    parts: Sequence[int] = ()
    poses: NDArray[np.float64] | None = None
    views: list[View] = field(default_factory=list)
    #: Completes a frame: what the breath changes.
    complete: Callable[[Any], None] | None = None

    def frames(self, first: int, count: int, keep: list[Any]) -> Any:
        """The C frames first to first + count."""
        frames = struct("skg_frame", count)
        parts = ffi.new("int64_t[]", list(self.parts)) if self.parts else ffi.NULL
        keep += [frames, parts]
        poses, posed = ffi.NULL, len(self.parts)
        if self.poses is not None:
            poses = ffi.cast("double *", self.poses.__array_interface__["data"][0])
        for i in range(count):
            frame = frames[i]
            frame.index = self.index + first + i
            if self.poses is not None:
                frame.pose_count, frame.pose_parts = posed, parts
                frame.poses = poses + 16 * posed * (first + i)
            if self.views:
                keep.append(self.views[(first + i) % len(self.views)]._write(struct("skg_view")))
                frame.view = keep[-1]
            if self.complete:
                self.complete(frames + i)
        return frames


class Stale(Exception):
    """The plan cannot absorb what changed."""


#: Starts frames: (count, frames, output, job) -> status.
Submit = Callable[[int, Any, Any, Any], int]


def run(device: Device, submit: Submit, batch: Batch, out: NDArray[Any], progress: Progress, pace: Pace,
        scatters: bool) -> None:
    """Computes a batch into out, [frame][channel][row][column]. The device's calls are this thread's.

    pace: that of the plan. scatters: frames may have scatter, whose computation answers an interrupt.
    """
    meter = Meter(progress, batch.count)
    started: list[tuple[Any, int, float]] = []
    size, sent, done, ranged = 1, 0, 0, ""
    if pace.seconds and not progress:  # progress is told of the first frames soon
        size = max(1, int(_CHUNK / pace.seconds))
    try:
        while done < batch.count:
            while sent < batch.count and len(started) < 2:
                count = min(size, batch.count - sent)
                begun = time.monotonic()  # frames with scatter are computed as they are submitted
                keep: list[Any] = []
                job = device.begin((keep, out))
                started.append((job, count, begun))
                _start(submit, batch, sent, count, out, job, keep, scatters)
                sent += count
            job, count, begun = started[0]
            if not 0 < pace.seconds * count < _NAP:  # sooner than a sleep would end
                wait(job)
            if check(device.end(job)) == RANGE:
                ranged = text(lib.skg_last_error())
            started.pop(0)
            seconds = max((time.monotonic() - begun) / (1 + len(started)), 1e-6)
            pace.seconds = seconds / count
            size = max(1, min(2 * size, int(_CHUNK * count / seconds)))
            done += count
            meter.update(done)
    finally:
        for job, _, _ in started:
            cancel(job)
    if ranged:
        warn(ranged, RangeWarning)


def _start(submit: Submit, batch: Batch, first: int, count: int, out: NDArray[Any], job: Any, keep: list[Any],
           scatters: bool) -> None:
    output = struct("skg_output")
    part = out[first:first + count]
    size = part.itemsize
    output.type = ENUMS["type"][str(part.dtype)]
    output.data = ffi.cast("void *", part.__array_interface__["data"][0])
    output.frame_stride, output.channel_stride, output.row_stride = (
        stride // size if extent > 1 else 0 for stride, extent in zip(part.strides[:3], part.shape[:3]))
    frames = batch.frames(first, count, keep)
    if scatters:
        with Watch(False, "histories") as watch:  # scatter is computed in here
            for i in range(count):
                frames[i].progress = watch
            status = check(submit(count, frames, output, job))
    else:
        status = check(submit(count, frames, output, job))
    if status == STALE:
        raise Stale(text(lib.skg_last_error()))
    assert status in (OK, RANGE)


def cancel(job: Any) -> None:
    """Cancels a job that the device has begun, if there is one."""
    if job[0] != ffi.NULL:
        lib.skg_job_cancel(job[0])


def wait(job: Any) -> None:
    """Waits for a job with its eyes open: a signal is answered within a nap."""
    done = ffi.new("int32_t *")
    begun = time.monotonic()
    while True:
        call("skg_job_test", job[0], done)
        if done[0]:
            return
        time.sleep(min(_NAP, max(2e-5, (time.monotonic() - begun) / 16)))
