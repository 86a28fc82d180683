"""Compares the energy that a scintillator keeps of photons with photons that are followed one by one."""
from __future__ import annotations

import csv
import os

import packages
import skiagraph as sk
from page import Page, largest, percent

THICKNESS_MM, PACKING = 0.6, 0.8
CURVE = (20, 30, 33, 34, 40, 50, 60, 70, 80, 90, 100, 120, 140, 160, 180, 200, 225, 250, 300, 350, 400, 450)
UNSURE = 450  # keV, where both of those that follow photons differ


def kept(kev: float) -> float:
    """Of the energy of photons that interact."""
    layer = sk.Response.scintillator("CsI", THICKNESS_MM, PACKING)
    recorded, efficiency = layer.at(kev)
    return recorded / (efficiency * kev)


def add(page: Page) -> None:
    with open(os.path.join(packages.TABLES, "deposition.csv"), encoding="utf-8") as file:
        rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
    page.claim("Energy that a scintillator keeps", "photons followed one by one by two programs, 2026-11 (`bench/validate/tables/deposition.csv`): an analogue "
               "Monte Carlo of a tester, from outside, and that of `tests/beam/deposition_test.c`.",
               "The share of its energy that a photon which interacts leaves in 600 um of CsI with a packing of 0.8, without K escape.",
               "At 450 keV the two differ by 4 %, and the response agrees with the second, whose error is 0.3 % there; the first is not judged at that energy.")
    cells, outside, own = [], [], []
    for row in rows:
        kev, ours = float(row["keV"]), kept(float(row["keV"]))
        cell = [row["keV"], ours]
        for name, worst in (("outside", outside), ("own", own)):
            cell.append(f"{row[name]} ({percent(ours, float(row[name])):+.1f} %)" if row[name] else "")
            if row[name] and (name == "own" or kev < UNSURE):
                worst.append((percent(ours, float(row[name])), f"{row['keV']} keV"))
        cells.append(cell)
    page.table(["keV", "kept, response", "from outside", "deposition_test"], cells)
    page.judge("energy kept by CsI, from outside, to 300 keV", *_judged(outside, 1))
    page.judge("energy kept by CsI, deposition_test", *_judged(own, 0.5))
    page.text("The curve:")
    half = (len(CURVE) + 1) // 2
    page.table(["keV", *map(str, CURVE[:half])], [["kept", *(f"{kept(kev):.3f}" for kev in CURVE[:half])]])
    page.table(["keV", *map(str, CURVE[half:])], [["kept", *(f"{kept(kev):.3f}" for kev in CURVE[half:])]])


def _judged(values: list[tuple[float, str]], bar: float) -> tuple[float, float, str, str]:
    worst, note = largest(values)
    return worst, bar, "%", note
