"""References that packages compute: SpekPy and xraylib if they are installed, otherwise what they gave (tables/*.csv).

`python3 packages.py` writes these tables again."""
from __future__ import annotations

import csv
import datetime
import importlib
import importlib.metadata
import os
from typing import Any

TABLES = os.path.join(os.path.dirname(os.path.abspath(__file__)), "tables")

ELEMENTS = ("H", "C", "N", "O", "Al", "P", "Ca", "Fe", "Cu", "Mo", "Rh", "I", "Cs", "Gd", "W", "Pb")
COMPOUNDS = ("H2O", "CsI", "Gd2O2S")
ENERGIES = (15, 30, 60, 80, 100, 150, 300, 500)  # keV, rows of both tables
BETWEEN = (22.5, 45, 68, 123)  # keV, between rows

AL = {"Al": 2.5}
#: name of the beam -> anode, model's filters in mm, tube voltages
BEAMS = {
    "W, 2.5 mm Al": ("W", AL, (60, 80, 100, 120, 150)),
    "W, 0.5 mm Al": ("W", {"Al": 0.5}, (25, 30, 35, 40)),
    "Mo, 0.03 mm Mo, 1 mm Be": ("Mo", {"Mo": 0.03, "Be": 1}, (25, 28, 32, 35)),
    "Mo, 0.025 mm Rh, 1 mm Be": ("Mo", {"Rh": 0.025, "Be": 1}, (25, 28, 32, 35)),
    "Rh, 0.025 mm Rh, 1 mm Be": ("Rh", {"Rh": 0.025, "Be": 1}, (25, 28, 32, 35)),
    "W, 0.05 mm Rh, 1 mm Be": ("W", {"Rh": 0.05, "Be": 1}, (25, 28, 32, 35)),
    "W, 0.05 mm Ag, 1 mm Be": ("W", {"Ag": 0.05, "Be": 1}, (25, 28, 32, 35)),
}
ASIDE = (-15, -10, -5, 5, 10, 15)  # cm from the central ray, at 1 m, towards the cathode


def installed(name: str) -> Any:
    """The package, or None."""
    try:
        return importlib.import_module(name)
    except ImportError:
        return None


def of_xraylib(xraylib: Any) -> list[list[Any]]:
    rows = []
    for name in ELEMENTS + COMPOUNDS:
        for kev in sorted(ENERGIES + BETWEEN):
            value = (xraylib.CS_Total(xraylib.SymbolToAtomicNumber(name), kev) if name in ELEMENTS
                     else xraylib.CS_Total_CP(name, kev))
            rows.append([name, kev, f"{value:.6g}"])
    return rows


def of_spekpy(spekpy: Any) -> list[list[Any]]:
    """Half-value layer and air kerma of each beam, then those beside the central ray (heel effect)."""
    rows = []
    for name, (anode, filters, voltages) in BEAMS.items():
        for kvp in voltages:
            tube = spekpy.Spek(kvp=kvp, th=12, targ=anode, dk=0.5, z=100, mas=1)
            for material, mm in filters.items():
                tube.filter(material, mm)
            rows.append([name, kvp, 0, f"{tube.get_hvl1():.5g}", f"{tube.get_kerma():.5g}"])
    for x in (0, *ASIDE):
        tube = spekpy.Spek(kvp=100, th=12, dk=0.5, x=x, z=100, mas=1, obli=False).filter("Al", 2.5)
        rows.append(["heel", 100, x, f"{tube.get_hvl1():.5g}", f"{tube.get_kerma():.5g}"])
    return rows


PACKAGES = {
    "xraylib": (of_xraylib, "material,kev,cm2_per_g", "https://github.com/tschoonj/xraylib, CS_Total and CS_Total_CP, BSD-3-Clause"),
    "spekpy": (of_spekpy, "beam,kvp,aside_cm,hvl1_mm_al,kerma_ugy", "https://bitbucket.org/spekpy/spekpy_release, MIT, W anode angle 12 degrees, 1 m, vacuum, per mAs"),
}


def rows_of(name: str) -> tuple[list[dict[str, str]], str]:
    """The reference's rows, and where they are from."""
    make, header, source = PACKAGES[name]
    package = installed(name)
    if package:
        keys = header.split(",")
        rows = [dict(zip(keys, map(str, row))) for row in make(package)]
        return rows, f"{name} {importlib.metadata.version(name)}, run with this page"
    with open(os.path.join(TABLES, f"{name}.csv"), encoding="utf-8") as file:
        made = file.readline().lstrip("# ").strip()
        return list(csv.DictReader(file)), made


def main() -> None:
    for name, (make, header, source) in PACKAGES.items():
        package = installed(name)
        if not package:
            raise SystemExit(f"{name} is not installed: pip install {name}")
        with open(os.path.join(TABLES, f"{name}.csv"), "w", encoding="utf-8") as file:
            file.write(f"# {name} {importlib.metadata.version(name)}, run on {datetime.date.today()}; {source}\n{header}\n")
            csv.writer(file, lineterminator="\n").writerows(make(package))


if __name__ == "__main__":
    main()
