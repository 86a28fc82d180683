"""Decisions of a plan, and their reasons."""
from __future__ import annotations

import html
from collections.abc import Iterator, Mapping
from typing import Any

from ._interface import ArgumentError, Error
from ._library import call, ffi, filled, integer, listed

_OVERLAPS_SHOWN = 3


class Report(Mapping[str, Any]):
    """A plan's decisions, as a mapping and as text: what is simulated, what is not, and why.

    The keys are the fields of the library's skg_plan_report, and `effects`, `channels`, `energies`, `overlaps` and
    `stages`; `scatter` are those of skg_scatter_report for the last image, or None; `precision_bound` bounds the error of
    rounding, which adds to `bound`, that of fewer energies and planes; None where it cannot be found out.
    """

    def __init__(self, plan: Any, labels: list[str]) -> None:
        found = filled("skg_plan_report", "skg_plan_report_get", plan)
        found["effects"] = listed("skg_effect", "skg_plan_effect", plan)
        for effect in found["effects"]:
            effect["on"] = bool(effect["on"])
        found["channels"] = listed("skg_channel", "skg_plan_channel", plan)
        found["energies"] = _energies(plan)
        found["overlaps"] = listed("skg_overlap", "skg_plan_overlap", plan)
        for overlap in found["overlaps"]:
            overlap["part"], overlap["other"] = labels[overlap["part"]], labels[overlap["other"]]
        found["scatter"] = scatter_report(plan)
        found["precision_bound"] = _precision_bound(plan)
        found["stages"] = listed("skg_stage", "skg_plan_stage", plan)
        self._found = found

    def __getitem__(self, key: str) -> Any:
        return self._found[key]

    def __iter__(self) -> Iterator[str]:
        return iter(self._found)

    def __len__(self) -> int:
        return len(self._found)

    def _summary(self) -> list[tuple[str, str]]:
        f = self._found
        rounding = "" if f["precision_bound"] is None else f", rounding at most {f['precision_bound']:.2g}"
        return [("scene", f"{f['parts']} parts ({f['leaky_parts']} leaky), {f['triangles']} triangles"),
                ("precision", f["precision"] + rounding), ("strategy", f["strategy"]),
                ("planes", f"{f['planes']} of {f['plane_bits']} bits"),
                ("energies", f"{f['nodes']} of {f['bins']}, error at most {f['bound']:.2g}"),
                ("rays per pixel", str(f["samples"])), *_scatter_lines(f["scatter"])]

    def __str__(self) -> str:
        lines = [f"{name:<15} {value}" for name, value in self._summary()]
        lines.append("effects, with their estimated cost in frames of this scene without effects")
        lines += [f"  {'on' if e['on'] else 'off':<3} {e['name']:<22} {e['cost']:+9.2f}  {e['reason']}"
                  for e in self._found["effects"]]
        overlaps = self._found["overlaps"]
        lines += [f"  {o['part']} {'leaves its parent' if o['protrudes'] else 'overlaps'} {o['other']}: "
                  f"{o['volume']:.4g} mm3" for o in overlaps[:_OVERLAPS_SHOWN]]
        if len(overlaps) > _OVERLAPS_SHOWN:
            lines.append(f"  and {len(overlaps) - _OVERLAPS_SHOWN} more; report[\"overlaps\"] lists all")
        return "\n".join(lines)

    def __repr__(self) -> str:
        on = [e["name"] for e in self._found["effects"] if e["on"]]
        return f"<Report: {', '.join(on) or 'no effects'}>"

    def _repr_html_(self) -> str:
        summary = "".join(f"<tr><th>{html.escape(name)}</th><td>{html.escape(value)}</td></tr>"
                          for name, value in self._summary())
        effects = "".join(f"<tr><td>{'on' if e['on'] else 'off'}</td><td>{html.escape(e['name'])}</td>"
                          f"<td>{e['cost']:+.2f}</td><td>{html.escape(e['reason'])}</td></tr>"
                          for e in self._found["effects"])
        return (f"<table>{summary}</table><table><tr><th></th><th>effect</th><th>cost</th><th>reason</th></tr>"
                f"{effects}</table>")


def _scatter_lines(scatter: Mapping[str, Any] | None) -> list[tuple[str, str]]:
    """Lines about the scatter of the last image, if it has any."""
    if scatter is None:
        return []
    once, twice, more = (100 * share for share in scatter["orders"])
    error = 100 * scatter["sigma"] / scatter["mean"] if scatter["mean"] > 0 else 0.0
    return [("scatter", f"mean {scatter['mean']:.4g}, standard error {error:.2g} %, {scatter['histories']} histories in "
                        f"{scatter['seconds']:.2g} s"),
            ("", f"{once:.0f} % scattered once, {twice:.0f} % twice, {more:.0f} % more often; Rayleigh {100 * scatter['rayleigh']:.0f} %")]


def scatter_report(plan: Any) -> dict[str, Any] | None:
    """Report of the scatter of the last image; None: the plan has none, or has made no image."""
    try:
        return filled("skg_scatter_report", "skg_plan_scatter_report_get", plan)
    except ArgumentError:
        return None


def _precision_bound(plan: Any) -> float | None:
    """The bound of the error of rounding; None: the plan has none, as the command shows none then."""
    bound = ffi.new("double *")
    try:
        call("skg_plan_precision_bound_get", plan, bound)
    except Error:
        return None
    return float(bound[0])


def _energies(plan: Any) -> list[tuple[float, float]]:
    """(keV, photons per pixel) of each energy that is used."""
    kev, photons, found = ffi.new("double *"), ffi.new("double *"), []
    for i in range(integer("skg_plan_node_count", plan)):
        call("skg_plan_node_get", plan, i, kev, photons, ffi.NULL)
        found.append((float(kev[0]), float(photons[0])))
    return found
