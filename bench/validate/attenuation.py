"""Attenuation coefficients beside xraylib's, and those that the paper prints."""
from __future__ import annotations

import packages
import skiagraph as sk
from page import Page, largest, percent, signed

#: Table 2 to 4 of Vidal and Villard (2016): material as this project names it, keV, 1/cm.
PAPER = [("HU:1329", 80, 0.3971), ("HU:1329", 100, 0.3328), ("HU:1329", 200, 0.2369), ("HU:1329", 300, 0.2018),
         ("HU:51", 80, 0.1937), ("HU:51", 100, 0.1800), ("HU:51", 200, 0.1445), ("HU:51", 300, 0.1251)]


def of(material: str, kev: float) -> float:
    return float(sk.Material(material).coefficients(kev)["total"])


def with_xraylib(page: Page) -> None:
    rows, source = packages.rows_of("xraylib")
    page.claim("Attenuation coefficients", source + ".",
               "Mass attenuation coefficients with coherent scattering, in cm2/g. The project takes the cross sections of NIST "
               "XCOM; xraylib's are another copy with another interpolation. Materials and energies are a selection; "
               "`xraylib_test.c` compares 92 elements from 5 to 800 keV.")
    found: dict[str, list[tuple[float, str]]] = {"at": [], "between": []}
    for row in rows:
        name, kev = row["material"], float(row["kev"])
        difference = percent(of(name, kev), float(row["cm2_per_g"]))
        found["at" if kev in packages.ENERGIES else "between"].append((difference, f"{name} at {kev:g} keV"))
    shown = [("H2O", 30), ("H2O", 60), ("H2O", 100), ("Al", 30), ("Al", 60), ("Ca", 60), ("I", 30), ("I", 45), ("W", 68),
             ("W", 100), ("Pb", 80), ("Pb", 123), ("CsI", 60), ("Gd2O2S", 60)]
    cells = []
    for name, kev in shown:
        reference = next(float(r["cm2_per_g"]) for r in rows if r["material"] == name and float(r["kev"]) == kev)
        cells.append([name, f"{kev}", of(name, kev), reference, signed(percent(of(name, kev), reference))])
    page.table(["material", "keV", "ours", "xraylib", "difference"], cells)
    page.judge("attenuation coefficients at energies of the tables", *_bar(largest(found["at"]), 0.05))
    page.judge("attenuation coefficients between them", *_bar(largest(found["between"]), 0.7))


def _bar(worst: tuple[float, str], bar: float) -> tuple[float, float, str, str]:
    return worst[0], bar, "%", worst[1]


def with_paper(page: Page) -> None:
    page.claim("Hounsfield numbers of tissue", "F. P. Vidal, P.-F. Villard, Development and validation of real-time simulation "
               "of X-ray imaging with respiratory motion, Computerized Medical Imaging and Graphics 49 (2016) 1-15, tables 3 "
               "and 4, four digits.", "Linear attenuation coefficients in 1/cm of tissue given by a Hounsfield number.")
    cells, worst = [], []
    for name, kev, reference in PAPER:
        ours = float(sk.Material(name).attenuation(kev))
        worst.append((percent(ours, reference), f"{name} at {kev} keV"))
        cells.append([name, f"{kev}", ours, reference, signed(worst[-1][0])])
    page.table(["tissue", "keV", "ours", "paper", "difference"], cells)
    page.judge("tissue by Hounsfield number", *_bar(largest(worst), 0.1))


def add(page: Page) -> None:
    with_xraylib(page)
    with_paper(page)
