"""Where a scene comes from: its text, its settings and its files, and the same as content. Private."""
from __future__ import annotations

import json
import os
import pathlib
import tempfile
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from typing import Any

from ._interface import ArgumentError, FileError
from ._library import call, encode, ffi, integer, make, struct, text


def schema() -> dict[str, Any]:
    size = ffi.new("int64_t *")
    call("skg_setup_schema_get", ffi.NULL, 0, size)
    room = ffi.new("char[]", size[0])
    call("skg_setup_schema_get", room, size[0], size)
    made: dict[str, Any] = json.loads(text(room))
    return made


@dataclass
class Source:
    text: bytes
    path: str | None
    partial: bool
    settings: list[str]
    lenient: bool = False
    lengths_only: bool = False
    #: name in the text -> (path, its size and time when the scene was read)
    files: dict[str, tuple[str, tuple[int, int]]] = field(default_factory=dict)

    def load(self, context: Any, elsewhere: Mapping[str, str] | None = None) -> Any:
        """The set-up, which the caller releases."""
        keep: list[Any] = []
        source = struct("skg_setup_source")
        source.text = _chars(self.text, keep)
        source.path = _chars(encode(self.path, "path"), keep) if self.path else ffi.NULL
        source.partial, source.lenient, source.lengths_only = self.partial, self.lenient, self.lengths_only
        source.settings, source.setting_count = _texts(self.settings, keep), len(self.settings)
        if elsewhere:
            source.file_names, source.file_paths = _texts(elsewhere, keep), _texts(elsewhere.values(), keep)
            source.file_count = len(elsewhere)
        setup = make("skg_setup_create", "skg_setup", context, source)
        self._note_files(setup)
        return setup

    def _note_files(self, setup: Any) -> None:
        name, path = ffi.new("const char **"), ffi.new("const char **")
        for i in range(integer("skg_setup_file_count", setup)):
            call("skg_setup_file_get", setup, i, name, path)
            where = text(path[0])
            self.files[text(name[0])] = (where, _stamp(where))

    def content(self) -> dict[str, Any]:
        """All of it, with what is in the files. Raises FileError if one changed since it was read."""
        files = {}
        for name, (path, stamp) in self.files.items():
            if _stamp(path) != stamp:
                raise FileError(f"{path}: changed since the scene was read, so the scene cannot be pickled")
            if pathlib.Path(path).is_dir():
                raise FileError(f"{path}: is a folder, which is not kept, so the scene cannot be pickled; convert it to .mha")
            files[name] = pathlib.Path(path).read_bytes()
        return {"files": files, **{name: getattr(self, name) for name in _KEPT}}


#: What a source is made of, but for its files.
_KEPT = ("text", "path", "partial", "settings", "lenient", "lengths_only")


class Kept:
    """The content of a source, in files of its own as long as it lives."""

    def __init__(self, content: dict[str, Any]) -> None:
        self._folder = tempfile.TemporaryDirectory(prefix="skiagraph-")
        self.elsewhere: dict[str, str] = {}
        for i, (name, data) in enumerate(content["files"].items()):
            path = pathlib.Path(self._folder.name, str(i), os.path.basename(name))
            path.parent.mkdir()
            path.write_bytes(data)
            self.elsewhere[name] = str(path)
        self.source = Source(**{name: content[name] for name in _KEPT})


def source_of(scene: Any, settings: Any, lenient: bool, lengths_only: bool) -> Source:
    """The source of a path, a dictionary or nothing."""
    words = _settings(settings)
    if scene is None or isinstance(scene, Mapping):
        try:
            return Source(json.dumps(scene or {}, allow_nan=False).encode(), None, True, words, lenient, lengths_only)
        except (TypeError, ValueError) as error:
            raise ArgumentError(f"the scene is no JSON: {error}") from None
    if not isinstance(scene, (str, os.PathLike)):
        raise ArgumentError(f"scene is a {type(scene).__name__}; give the path of a file, a dictionary or None")
    path = os.fspath(scene)
    try:
        found = pathlib.Path(path).read_bytes()
    except OSError:
        call("skg_setup_load", ffi.NULL, encode(path, "path"), 0, ffi.NULL, ffi.new("skg_setup **"))
        raise
    return Source(found, path, False, words, lenient, lengths_only)


def _settings(settings: Any) -> list[str]:
    if isinstance(settings, Mapping):
        return [f"{key}={json.dumps(value)}" for key, value in settings.items()]
    if isinstance(settings, str):
        return [settings]
    return [str(word) for word in settings]


def _stamp(path: str) -> tuple[int, int]:
    status = os.stat(path)
    return status.st_size, status.st_mtime_ns


def _chars(value: bytes, keep: list[Any]) -> Any:
    keep.append(ffi.new("char[]", value))
    return keep[-1]


def _texts(values: Iterable[str], keep: list[Any]) -> Any:
    keep.append(ffi.new("const char *[]", [_chars(encode(value, "text"), keep) for value in values]))
    return keep[-1]
