"""Fitting the breath of a scene to surfaces. Private."""
from __future__ import annotations

import json
import os
import tempfile
from collections.abc import Mapping, Sequence
from typing import Any

from . import _arrays, _command
from ._interface import ArgumentError, SceneError
from .mesh import as_mesh
from .scene import Scene, state_of


def fit(scene: Scene, targets: Mapping[str, Any] | Mapping[float, Mapping[str, Any]], out: str | os.PathLike[str], *,
        phase: float | None = None, parameters: Sequence[str] = (), bounds: Mapping[str, tuple[float, float]] | None = None,
        evaluations: int | None = None, seed: int | None = None, method: str | None = None,
        checkpoint: str | os.PathLike[str] | None = None) -> dict[str, Any]:
    """Finds the parameters of breathing with which parts come nearest to surfaces that were segmented from a patient.

    targets: {label: mesh} at the phase, or {phase: {label: mesh}}. out: the scene with the fitted parameters, .json. Returns
    what the command `skiagraph fit` prints: error_mm, evaluations, parameters, parts and more. parameters, bounds,
    evaluations, seed, method and checkpoint are flags of that command, which has to be installed.
    """
    if not targets:
        raise ArgumentError("there are no targets; give {label: mesh} with phase=, or {phase: {label: mesh}}")
    nested = all(isinstance(value, Mapping) for value in targets.values())
    if nested == (phase is not None):
        raise ArgumentError("give targets {label: mesh} with phase=, or {phase: {label: mesh}} without it")
    at: Mapping[Any, Any] = targets if nested else {phase: targets}
    state = state_of(scene)
    if state.source.path is None or state.source.settings or state.is_changed():
        raise SceneError("the fit is written as a scene file that refers to the meshes of the scene's own file; save() the scene, "
                         "and fit what sk.Scene reads of that file")
    with tempfile.TemporaryDirectory(prefix="skiagraph-") as folder:
        words = ["fit", state.source.path, "-o", os.fspath(out), "--json"]
        for when, surfaces in at.items():
            words += ["--phase", repr(_arrays.real(when, "phase"))]
            for label, mesh in surfaces.items():
                state.number(label)  # says which labels there are
                path = os.path.join(folder, f"target-{len(words)}.ply")
                as_mesh(mesh).save(path)
                words += ["--target", f"{label}={path}"]
        for name, (low, high) in (bounds or {}).items():
            words += ["--bounds", f"{name}={low!r}:{high!r}"]
        if parameters:
            words += ["--parameters", ",".join(parameters)]
        for flag, value in (("--evaluations", evaluations), ("--seed", seed), ("--method", method), ("--checkpoint", checkpoint)):
            words += [] if value is None else [flag, os.fspath(value) if isinstance(value, os.PathLike) else str(value)]
        if state.source.lenient:
            words.append("--lenient")
        found: dict[str, Any] = json.loads(_command.run(*words))
    return found
