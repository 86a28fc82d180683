"""PoCL of the Python package pocl-binary-distribution (`pip install "skiagraph[pocl]"`), where there is no other driver.

PoCL 3.0 links every kernel by ld with the C library and libgcc, and ends the process where they are missing. They come with a
C compiler, so that PoCL is not used where there is none.

The package has a file pocl.icd, but the OpenCL loader does not look for it, and the environment of the process is not ours
to change. So the library is named in the device's configuration.
"""
from __future__ import annotations

import functools
import importlib.metadata
import os
import pathlib
import re
import shutil

from ._library import integer


def _library() -> str | None:
    """The driver's library, which the file .icd of the package names; it lies beside that file."""
    try:
        files = importlib.metadata.files("pocl-binary-distribution") or []
    except importlib.metadata.PackageNotFoundError:
        return None
    for file in files:
        if file.suffix == ".icd":
            icd = pathlib.Path(str(file.locate()))
            try:
                library = icd.parent / icd.read_text(encoding="utf-8").strip()
            except OSError:
                continue
            if library.is_file():
                return str(library)
    return None


def _has_compiler() -> bool:
    return shutil.which("ld") is not None and any(map(shutil.which, ("cc", "gcc", "clang")))


@functools.cache
def word() -> str | None:
    """The word driver=PATH if OpenCL offers no device; None: it does, or the package or a C compiler is not there.

    Asked once, before a driver is opened: later the library lists the devices of that driver, too.
    """
    if integer("skg_device_count") > 0:
        return None
    library = _library()
    return f'driver="{library}"' if library and _has_compiler() else None


def advice() -> str:
    """How to get a driver without root."""
    if _library() is None:
        return 'For CPUs, pip install "skiagraph[pocl]" installs one'
    return ("PoCL of pocl-binary-distribution is installed, but it links kernels by a C compiler's tools, which are not "
            "(apt-get install gcc libc6-dev)")


def names_driver(config: str | None) -> bool:
    """Whether the configuration or SKG_DEVICE names a driver."""
    asked = f"{config or ''} {os.environ.get('SKG_DEVICE', '')}"
    return re.search(r"(^| )driver=", asked, re.IGNORECASE) is not None


def configuration(config: str | None) -> str | None:
    """The configuration with PoCL's driver, if there is no other driver and neither it nor SKG_DEVICE names one."""
    driver = word()
    if driver is None or names_driver(config):
        return config
    return f"{config} {driver}" if config else driver


def environment() -> dict[str, str]:
    """The environment for the command, which knows no packages of Python."""
    words = configuration(os.environ.get("SKG_DEVICE"))
    return {**os.environ, "SKG_DEVICE": words} if words else dict(os.environ)
