"""Computing the projections of a scan. Private.

A run is computed by a thread of its own, so that the caller's thread answers an interrupt at once. The caller's thread
holds the lock of the device meanwhile.
"""
from __future__ import annotations

import functools
import os
import queue
import threading
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Union

import numpy as np
from numpy.typing import NDArray

from . import _arrays
from ._device import Device, RangeWarning, warn
from ._digest import digest
from ._frames import Stale
from ._images import channels_of
from ._interface import ENUMS, RANGE, STALE, ArgumentError, SceneError
from ._library import call, check, encode, ffi, filled, integer, lib, make, owned, release, struct, text
from ._progress import Meter, Progress
from .scan import Scan

if TYPE_CHECKING:
    from ._state import State

# Bytes and projections of a batch. An interrupted run ends with the batches that are under way.
_BATCH, _MAX = 1 << 20, 32


@dataclass
class Wanted:
    """Projections of a scan that are wanted, and options of their computation."""

    only: Sequence[int] | None
    breathing: bool
    subframes: int
    options: dict[str, Any]
    progress: Progress


class _Job:
    """A run with its plan. What its thread does with batches is up to a subclass."""

    def __init__(self, state: State, scan: Scan, wanted: Wanted, samples: int, anew: bool) -> None:
        self.state, self.scan, self.wanted = state, scan, wanted
        self.keep: list[Any] = []
        self.options = state.plans.options(state.options_setup, wanted.options, self.keep)
        given = dict(wanted.options)
        if state.trajectory is not None and given.get("tolerance"):
            given.setdefault("views", list(scan))
        if samples and self.options.spot != ffi.NULL:
            self._continue_samples(given, samples)
        self.view = scan[0]
        self.dtype = np.dtype(np.float64 if self.options.precision == ENUMS["precision"]["double"] else np.float32)
        self.motion = state.linked() if wanted.breathing else ffi.NULL
        self.plan = state.plans.get(state.options_setup, state.handle, self.view, state.require_beam(), given, anew)
        self.channels = integer("skg_plan_channel_count", self.plan)
        self.run = self._run_options()

    def _continue_samples(self, given: dict[str, Any], samples: int) -> None:
        """A scan that is continued has the number of source samples with which it was begun."""
        spot = ffi.new("skg_spot *", self.options.spot[0])
        if spot.samples == 0 and spot.grid == 0:
            spot.samples = samples // int(self.options.supersampling) ** 2
            given["spot"] = spot

    def _run_options(self) -> Any:
        run, wanted = struct("skg_scan_run_options"), self.wanted
        image = self.channels * self.view.pixels[0] * self.view.pixels[1] * self.dtype.itemsize
        run.subframes, run.motion, run.type = wanted.subframes, self.motion, ENUMS["type"][self.dtype.name]
        waits = wanted.breathing or self.options.scatter != ffi.NULL
        run.batch = 1 if waits else max(1, min(_MAX, _BATCH // (image * max(1, wanted.subframes))))
        if wanted.only is not None:
            numbers = _arrays.numbers(wanted.only, "only")
            if numbers.ndim != 1 or not numbers.size or numbers.dtype.kind not in "iu":
                raise ArgumentError(f"only has {_arrays.describe(numbers)}; give numbers of projections, rising")
            self.keep.append(ffi.new("int64_t[]", numbers.tolist()))
            run.only, run.only_count = self.keep[-1], numbers.size
        return run

    def start(self) -> Any:
        """The run, in its thread."""
        run = ffi.new("skg_scan_run **")
        if check(lib.skg_scan_run_create(self.plan, self.scan._handle, self.run, run)) == STALE:
            raise Stale(text(lib.skg_last_error()))
        return run[0]

    def receive(self, batch: Any, done: int) -> None:
        """Takes a batch; done: projections before it."""
        raise NotImplementedError

    def finish(self) -> None:
        """The last batch was taken."""

    def end(self) -> None:
        """The run is over, whether it was finished, failed or was stopped."""


class _ToArray(_Job):
    def __init__(self, state: State, scan: Scan, wanted: Wanted, out: Any, anew: bool) -> None:
        super().__init__(state, scan, wanted, 0, anew)
        count = len(scan) if wanted.only is None else int(self.run.only_count)
        banded = channels_of(state, wanted.options) is not None
        shape = (count, *((self.channels,) if banded else ()), *self.view.shape)
        self.target = np.empty(shape, self.dtype) if out is None else _arrays.output(out, shape)
        self.run.type = ENUMS["type"][self.target.dtype.name]

    def receive(self, batch: Any, done: int) -> None:
        part = self.target[done:done + batch.count]
        images = np.frombuffer(ffi.buffer(batch.images, part.size * part.itemsize), part.dtype)
        part[...] = images.reshape(part.shape)


class _ToFile(_Job):
    def __init__(self, state: State, scan: Scan, wanted: Wanted, path: bytes, fields: tuple[int | None, int | None], overwrite: bool,
                 anew: bool) -> None:
        self.file = ffi.NULL
        inside, asked = path.lower().endswith((b".h5", b".hdf5", b".nxs")), fields != (None, None)
        self.fields = [1 if count is None else _arrays.whole(count, what) for what, count in zip(("flats", "darks"), fields)]
        self.hash = _hash(state, scan, wanted)
        samples = ffi.new("int64_t *")
        call("skg_scan_file_samples_get", path, self.hash.encode(), samples)
        super().__init__(state, scan, wanted, int(samples[0]), anew)
        self._open(path, overwrite)
        self.run.file = self.file
        self.found = integer("skg_scan_file_done_count", self.file)
        self.has_fields = asked or self.varies if not inside else self.found < len(scan)

    def _open(self, path: bytes, overwrite: bool) -> None:
        options, channel = struct("skg_scan_file_options"), struct("skg_channel")
        call("skg_plan_channel_get", self.plan, 0, channel)
        texts = [ffi.new("char[]", self.hash.encode()), channel]
        options.type, options.scan, options.hash = self.run.type, self.scan._handle, texts[0]
        options.name, options.unit, options.flat_field = channel.name, channel.unit, channel.flat_field
        options.flat_varies = channel.uneven
        self.varies = bool(channel.uneven)
        options.samples = filled("skg_plan_report", "skg_plan_report_get", self.plan)["samples"]
        options.flats, options.darks = self.fields
        options.overwrite = overwrite
        file = ffi.new("skg_scan_file **")
        call("skg_scan_file_open", path, options, file)
        self.file = file[0]

    def start(self) -> Any:
        if self.has_fields:
            self._write_fields()
        return super().start()

    def _write_fields(self) -> None:
        """Flat and dark fields as the plan makes them."""
        flats, darks = self.fields
        white, dark = (np.zeros((count, *self.view.shape), self.dtype) for count in self.fields)
        pointers = [ffi.cast("void *", array.__array_interface__["data"][0]) for array in (white, dark)]
        if flats:
            check(lib.skg_scan_flat_fields_render(self.plan, self.state.handle, self.scan._handle, self.run, flats,
                                                  pointers[0]))
        if darks:
            call("skg_scan_dark_fields_render", self.plan, self.scan._handle, self.run, darks, pointers[1])
        call("skg_scan_file_fields_write", self.file, flats, pointers[0], darks, pointers[1])

    def receive(self, batch: Any, done: int) -> None:
        call("skg_scan_file_write", self.file, batch.count, batch.indices, batch.images, batch.phases)

    def finish(self) -> None:
        call("skg_scan_file_finish", self.file)

    def end(self) -> None:
        release("skg_scan_file", self.file)


def _hash(state: State, scan: Scan, wanted: Wanted) -> str:
    """Hash that identifies the scan; the command's if nothing was changed since the scene was read."""
    keep: list[Any] = []
    options = state.plans.options(state.options_setup, wanted.options, keep)
    run, found = struct("skg_scan_run_options"), ffi.new("char[65]")
    run.subframes = wanted.subframes
    run.type = int(options.precision == ENUMS["precision"]["double"])
    run.motion = state.linked() if wanted.breathing else ffi.NULL
    call("skg_scan_hash_get", state.setup, options, run, found, 65)
    return digest(text(found), state, scan if state.trajectory is not None else None, wanted.options)


#: What the thread says: the number of projections that are done, how it failed, or the sentence it ends with.
Word = Union[int, BaseException, str]


class _Work:
    """A job in its thread."""

    def __init__(self, job: _Job, restore: Any) -> None:
        self._job, self._restore = job, restore
        self._progress = owned("skg_progress", make("skg_progress_create", "skg_progress", ffi.NULL, ffi.NULL))
        job.run.progress = self._progress
        self._words: queue.SimpleQueue[Word] = queue.SimpleQueue()
        self.total = 0
        self._thread = threading.Thread(target=self._work, name="skiagraph scan")

    def _work(self) -> None:
        last: Word = ""
        try:
            last = self._compute()
        except BaseException as error:
            last = error
        self._words.put(last)

    def _compute(self) -> str:
        """The sentence about the verified range, if it was left."""
        run = ffi.NULL
        try:
            run = self._job.start()
            self.total = integer("skg_scan_run_projection_count", run)
            ranged = self._batches(run)
            self._job.finish()
            return ranged
        finally:
            release("skg_scan_run", run)
            self._job.end()
            self._restore()

    def _batches(self, run: Any) -> str:
        batch, done, ranged = struct("skg_scan_batch"), 0, ""
        while True:
            if check(lib.skg_scan_run_next(run, batch)) == RANGE:
                ranged = text(lib.skg_last_error())
            if batch.count == 0:
                return ranged
            self._job.receive(batch, done)
            done += int(batch.count)
            self._words.put(done)

    def _stop(self) -> None:
        """Cancels the run, and waits for what the device was given of it."""
        call("skg_progress_cancel", self._progress)
        if self._thread.ident is not None:
            self._thread.join()

    def follow(self, device: Device, progress: Progress) -> None:
        """Starts, and waits for the end; a signal is answered at once. The device knows of the work before it begins, so that an
        interrupt at any moment leaves it there."""
        meter: Meter | None = None
        device.abandon(self._stop, self)
        try:
            self._thread.start()
            while isinstance(word := self._words.get(), int):
                meter = meter or Meter(progress, self.total)
                meter.update(word)
        except BaseException:
            call("skg_progress_cancel", self._progress)
            raise
        self._thread.join()
        device.settle(self._stop)
        if isinstance(word, BaseException):
            raise word
        if word:
            warn(word, RangeWarning)


def compute(state: State, scan: Scan, wanted: Wanted, out: Any) -> NDArray[Any]:
    """Projections as an array, [n, row, column]."""
    for again in (False, True):
        job = _ToArray(state, scan, wanted, out, again)
        try:
            _Work(job, _restorer(state, wanted)).follow(state.device, wanted.progress)
            break
        except Stale as stale:
            if again:
                raise SceneError(str(stale)) from None
    return job.target


def write(state: State, scan: Scan, wanted: Wanted, path: str | os.PathLike[str], fields: tuple[int | None, int | None],
          overwrite: bool) -> dict[str, Any]:
    """Projections to a file, which is continued if it has some of this scan already."""
    name = encode(path, "out")
    call("skg_scan_file_path_check", name)
    if wanted.options.get("bands") is not None or (channels_of(state, wanted.options) or 1) > 1:
        raise ArgumentError("a file of projections has one channel; compute an array, or bands and thresholds one by one")
    for again in (False, True):
        job = _ToFile(state, scan, wanted, name, fields, overwrite, again)
        work = _Work(job, _restorer(state, wanted))
        try:
            work.follow(state.device, wanted.progress)
            break
        except Stale as stale:
            if again:
                raise SceneError(str(stale)) from None
    return {"file": os.fspath(path), "projections": len(scan), "found": job.found, "computed": work.total,
            "finished": job.found + work.total == len(scan), "hash": job.hash}


def _restorer(state: State, wanted: Wanted) -> Any:
    """A function that poses the scene as it is now."""
    if not wanted.breathing:
        return lambda: None
    if state.breath:
        return functools.partial(state.pose, state.breath)
    meshes = [(part.mesh, part.mesh.vertices) for part in state.parts() if state.moves(part.number)]

    def restore() -> None:
        for mesh, vertices in meshes:
            mesh._place(vertices)

    return restore
