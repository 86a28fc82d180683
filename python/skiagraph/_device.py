"""Devices: a context of the library, its lock, and what it says."""
from __future__ import annotations

import atexit
import contextlib
import logging
import os
import signal
import sys
import threading
import warnings
import weakref
from collections.abc import Callable, Iterator
from types import TracebackType
from typing import Any

from . import _pocl
from ._interface import OK, ArgumentError, ENUMS, Error, NoDeviceError
from ._library import as_dict, call, encode, ffi, filled, integer, lib, make, release, struct, text

_log = logging.getLogger("skiagraph")
_package = os.path.dirname(__file__)


class SkiagraphWarning(UserWarning):
    """The library warns of something that the caller should know about a result."""


class RangeWarning(SkiagraphWarning):
    """An image is valid, but left the range over which its error bound was verified."""


def warn(sentence: str, category: type[Warning] = SkiagraphWarning) -> None:
    """Warns at the line outside of this package that called it."""
    level, frame = 1, sys._getframe()
    while frame.f_back and (frame.f_code.co_filename.startswith(_package + os.sep)
                            or frame.f_code.co_filename == contextlib.__file__):
        level, frame = level + 1, frame.f_back
    warnings.warn(sentence, category, stacklevel=level)


def note(sentence: str) -> None:
    """A note for the logger "skiagraph"."""
    _log.info("%s", sentence)


class Log:
    """Collects what the library says during a call; deliver() passes it on."""

    def __init__(self) -> None:
        self._lines: list[tuple[int, str]] = []

        def receive(level: int, sentence: Any, user: Any) -> None:
            self._lines.append((level, text(sentence)))

        self.function = ffi.callback("skg_log_function", receive)

    def deliver(self, said: set[str] | None = None) -> None:
        """Warnings become Python's; notes and progress go to the logger "skiagraph". said: what was warned of already."""
        lines, self._lines = self._lines, []
        for level, sentence in lines:
            if level != ENUMS["log_level"]["warning"]:
                _log.log(logging.INFO if level == ENUMS["log_level"]["note"] else logging.DEBUG, "%s", sentence)
        for level, sentence in lines:
            if level == ENUMS["log_level"]["warning"] and (said is None or sentence not in said):
                if said is not None:
                    said.add(sentence)
                warn(sentence)


class Device:
    """An OpenCL device. Scenes share one unless they are given their own.

    config: words such as "device=gpu", "device=cpu threads=4", "driver=/opt/pocl/libpocl.so.2" or a part of a device's name;
    None: the environment variable SKG_DEVICE, or else the best device. Where OpenCL offers no device, the driver of the
    package pocl-binary-distribution is used, if it is installed and no other driver= is named.

    Calls on scenes of a device queue: one thread computes at a time. Give scenes devices of their own to compute in
    several threads at once. A device does not survive os.fork(): start processes with multiprocessing's "spawn".

    >>> with Device("device=cpu") as device:
    ...     device.info["cpu"]
    1
    """

    def __init__(self, config: str | None = None) -> None:
        self._config = config
        self._lock = threading.RLock()
        self._depth = 0
        self._garbage: list[tuple[str, Any]] = []
        self._unfinished: list[tuple[Any, Callable[[], object], Any]] = []
        self._log = Log()
        self._handle = ffi.NULL
        _all.add(self)
        words = _pocl.configuration(config)
        try:
            self._handle = make("skg_context_create", "skg_context",
                                ffi.NULL if words is None else encode(words, "config"))
        except NoDeviceError as error:
            if _pocl.names_driver(words) or integer("skg_device_count") > 0:
                raise
            raise NoDeviceError(f"{error}. {_pocl.advice()}") from None
        call("skg_context_log_set", self._handle, self._log.function, ffi.NULL)

    @property
    def info(self) -> dict[str, Any]:
        """Properties of the device that OpenCL reports: name, compute units, memory and so on."""
        with self.calls():
            return filled("skg_device_info", "skg_context_device_get", self.handle)

    @property
    def handle(self) -> Any:
        if self._handle == ffi.NULL:
            raise ArgumentError("the device was closed")
        return self._handle

    @contextlib.contextmanager
    def calls(self, said: set[str] | None = None) -> Iterator[None]:
        """Inside of it this thread alone calls the library with this device. said: warnings that are not repeated.

        A call that fails passes on its warnings, too, before its error.
        """
        outermost = False
        try:
            with self._lock:
                self._depth += 1
                try:
                    if self._depth == 1:
                        self._collect()
                    yield
                finally:
                    self._depth -= 1
                    outermost = self._depth == 0
        except BaseException:
            if outermost:
                with contextlib.suppress(Warning):  # where warnings are errors, the call's own error comes first
                    self._log.deliver(said)
            raise
        if outermost:
            self._log.deliver(said)

    def __enter__(self) -> Device:
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None,
                 trace: TracebackType | None) -> None:
        self.close()

    def _collect(self) -> None:
        """Frees what was dropped meanwhile. Jobs that nobody waited for are cancelled, and have to end first."""
        for job, _finish, _keep in self._unfinished:
            if job is not None and job[0] != ffi.NULL:
                lib.skg_job_cancel(job[0])
        while self._unfinished:
            self._unfinished[0][1]()
            self._unfinished.pop(0)
        while self._garbage:
            release(*self._garbage.pop())

    def drop(self, kind: str, handle: Any) -> None:
        """Releases a handle that belongs to this device, now or with the next call."""
        self._garbage.append((kind, handle))

    def begin(self, keep: Any) -> Any:
        """A place for a job that is about to be submitted, and what has to stay as long as it runs. It is taken before the submission,
        so that an interrupt at any moment leaves the job here."""
        job = ffi.new("skg_job **")
        self._unfinished.append((job, lambda: self._wait(job), keep))
        return job

    def interruptible(self, kind: str, work: Callable[[], Any]) -> Any:
        """The handle that a call makes which may compute for long before it returns. A thread of its own makes it, so that the main thread
        answers an interrupt, which ends the call; a handle that was made by then is released."""
        if threading.current_thread() is not threading.main_thread():
            return work()
        done: list[Any] = []
        begun: list[bool] = []
        given_up: list[bool] = []

        def call_it() -> None:
            begun.append(True)
            try:
                done.append(None if given_up else work())
            except BaseException as error:
                done.append(error)

        thread = threading.Thread(target=call_it, name="skiagraph-plan", daemon=True)
        try:
            thread.start()
            thread.join()
        except BaseException:
            given_up.append(True)  # an interrupt of start() comes before the thread counts as alive
            while begun and not done:
                lib.skg_context_interrupt(self._handle)
                with contextlib.suppress(KeyboardInterrupt):
                    thread.join(0.05)
            if done and done[0] is not None and not isinstance(done[0], BaseException):
                self.drop(kind, done[0])
            raise
        if isinstance(done[0], BaseException):
            raise done[0]
        return done[0]

    def abandon(self, finish: Callable[[], object], keep: Any) -> None:
        """Takes work that was not waited for: a function that waits, and what has to stay as long as it runs."""
        self._unfinished.append((None, finish, keep))

    def settle(self, finish: Callable[[], object]) -> None:
        """The work of this function is over."""
        self._unfinished[:] = [entry for entry in self._unfinished if entry[1] != finish]

    @staticmethod
    def _wait(job: Any) -> int:
        return OK if job[0] == ffi.NULL else int(lib.skg_job_wait(job))

    def end(self, job: Any) -> int:
        """Waits for a job that was begun; its place may be empty. Gives the status."""
        status = self._wait(job)
        self._unfinished[:] = [entry for entry in self._unfinished if entry[0] is not job]
        return status

    def close(self) -> None:
        """Frees the device. Scenes that use it cannot be used any more."""
        with self.calls():
            self._collect()
            handle, self._handle = self._handle, ffi.NULL
            release("skg_context", handle)

    def __del__(self) -> None:
        if getattr(self, "_handle", ffi.NULL) != ffi.NULL and not sys.is_finalizing():
            self.close()

    def __repr__(self) -> str:
        return f"<Device {self.info['name']}>" if self._handle != ffi.NULL else "<Device, closed>"

    def __reduce__(self) -> tuple[Any, ...]:
        return device_of, (self._config,)


def device_of(device: Device | str | None) -> Device:
    """This device, or the one that this process shares for a configuration."""
    if isinstance(device, Device):
        return device
    if device is not None and not isinstance(device, str):
        raise ArgumentError(f"device is a {type(device).__name__}; give a Device, its configuration or None")
    with _shared_lock:
        shared = _shared.get(device)
        if shared is None or shared._handle == ffi.NULL:
            shared = _shared[device] = Device(device)
    return shared


def devices() -> list[dict[str, Any]]:
    """All devices of OpenCL, a dictionary a device.

    >>> all("name" in device for device in devices())
    True
    """
    if integer("skg_device_count") == 0:
        with contextlib.suppress(Error):  # a driver that SKG_DEVICE or a package names is listed once it is open
            device_of(None)
    found = []
    for i in range(integer("skg_device_count")):
        info = struct("skg_device_info")
        call("skg_device_get", i, info)
        found.append(as_dict(info, "skg_device_info"))
    return found


_all: weakref.WeakSet[Device] = weakref.WeakSet()
_shared: dict[str | None, Device] = {}
_shared_lock = threading.Lock()


def _forget() -> None:
    """In a child process: locks may be held by threads that are not here, and devices are of no use."""
    global _shared_lock
    _shared_lock = threading.Lock()
    for device in _all:
        device._lock, device._depth = threading.RLock(), 0
        device._garbage, device._unfinished = [], []
    _shared.clear()


def _close() -> None:
    """At the end of the process, while the library is still there: what devices still do ends before the memory that they write to. An
    interrupt is put off, since it would leave them at work."""
    with contextlib.suppress(ValueError):  # another thread ends the process
        signal.signal(signal.SIGINT, signal.SIG_IGN)
    for device in list(_all):
        if device._handle != ffi.NULL and device._lock.acquire(timeout=1):  # a thread that is in a call keeps what it needs
            try:
                device._collect()
            finally:
                device._lock.release()
    _shared.clear()


os.register_at_fork(after_in_child=_forget)
atexit.register(_close)
