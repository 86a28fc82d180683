"""Tube spectra beside PTB's measurements, IEC 61267, and SpekPy."""
from __future__ import annotations

import csv
import math
import os
from typing import Any

import packages
import skiagraph as sk
from page import Page, largest, percent, signed

NUMBER = {"W": 74, "Mo": 42, "Rh": 45}
MODELS = ("ebel", "birch")


def quality(model: str, kvp: float, angle: float, layers: dict[str, float], anode: str = "W") -> dict[str, float]:
    return sk.Beam.tube(kvp, {k: v for k, v in layers.items() if v > 0}, target_angle=angle, anode=NUMBER[anode],
                        model=model).quality


def _table(name: str) -> list[dict[str, str]]:
    with open(os.path.join(packages.TABLES, name), encoding="utf-8") as file:
        return list(csv.DictReader(line for line in file if not line.startswith("#")))


def _measured(page: Page, name: str, metal: str) -> None:
    """Both half-value layers of a table, by both models."""
    cells, worst = [], {model: [] for model in MODELS}
    for row in _table(name):
        layers = {"Kapton": 0.25, "Air": 950.0}
        layers.update({key[:2].strip("_").capitalize(): float(row[key]) for key in row if key.endswith("_mm")})
        cell = [row["quality"], row["kV"]]
        for order in (1, 2):
            reference = float(row[f"hvl{order}"])
            cell.append(row[f"hvl{order}"])
            for model in MODELS:
                ours = quality(model, float(row["kV"]), 20, layers)[f"hvl{order}_mm_{metal}"]
                difference = percent(ours, reference)
                cell.append(f"{ours:.3g} ({difference:+.1f} %)")
                worst[model].append((difference, f"layer {order} of {row['quality']}"))
        cells.append(cell)
    page.table(["quality", "kV", "first, PTB", "Ebel", "Birch", "second, PTB", "Ebel", "Birch"], cells)
    for model in MODELS:
        difference, note = largest(worst[model])
        page.judge(f"PTB's half-value layers in {metal.capitalize()}, {model.capitalize()}", difference, 3, "%", note)


PTB = ("measured at the PTB (U. Ankerhold, Catalogue of X-ray spectra and their characteristic data, PTB report Dos-34, 2000), "
       "as listed in the examples of SpekPy 2.5; W, 20 degrees; entered 2026-11 (`bench/validate/tables/{}`).")


def with_ptb(page: Page) -> None:
    page.claim("Half-value layers of diagnostic beams", PTB.format("ptb_al.csv"),
               "First and second half-value layers in mm of aluminium, behind 0.25 mm of Kapton, beryllium and 950 mm of air.",
               "The models are calibrated to SpekPy's spectra, not to these measurements. SpekPy itself gives +2.5 % for RQA10.")
    _measured(page, "ptb_al.csv", "al")
    page.claim("Half-value layers of filtered beams", PTB.format("ptb_cu.csv"), "The same in mm of copper, qualities of ISO 4037.")
    _measured(page, "ptb_cu.csv", "cu")


def with_iec(page: Page) -> None:
    page.claim("Homogeneity of RQR qualities", "IEC 61267:2005, as remembered (`bench/validate/tables/iec_rqr.csv`): first layers were confirmed to 0.1 mm by a "
               "secondary source, second decimals and homogeneity were not.",
               "Aluminium is added until the first half-value layer (W, 12 degrees) is the standard's; the ratio of the first to "
               "the second follows.")
    cells, worst = [], []
    for row in _table("iec_rqr.csv"):
        low, high = 0.5, 8.0
        while high - low > 1e-3:
            middle = (low + high) / 2
            found = quality("ebel", float(row["kV"]), 12, {"Al": middle})
            low, high = (middle, high) if found["hvl1_mm_al"] < float(row["hvl1"]) else (low, middle)
        difference = found["homogeneity"] - float(row["homogeneity"])
        worst.append((difference, row["quality"]))
        cells.append([row["quality"], row["kV"], row["hvl1"], f"{low:.2f}", f"{found['homogeneity']:.3f}", row["homogeneity"],
                      f"{difference:+.3f}"])
    page.table(["quality", "kV", "first layer, mm Al", "our filter, mm Al", "ours", "IEC", "difference"], cells)
    difference, note = largest(worst)
    page.judge("homogeneity of RQR qualities", difference, 0.02, "", note)


def with_spekpy(page: Page) -> None:
    rows, source = packages.rows_of("spekpy")
    page.claim("Half-value layers and output beside SpekPy", source + "; W, Mo and Rh at 12 degrees, 1 m, vacuum.",
               "Both models are calibrated to SpekPy's unfiltered spectra (`bench/validate/calibrate`), so these tables show how "
               "well that fit does behind filters. They are no independent proof.")
    cells: list[list[Any]] = []
    worst: dict[str, list[tuple[float, str]]] = {}
    for row in rows:
        if row["beam"] == "heel":
            continue
        anode, filters, _ = packages.BEAMS[row["beam"]]
        cell: list[Any] = [row["beam"], row["kvp"]]
        found = {model: quality(model, float(row["kvp"]), 12, dict(filters), anode) for model in MODELS}
        for key, ours in (("hvl1_mm_al", "hvl1_mm_al"), ("kerma_ugy", "air_kerma_ugy")):
            reference = float(row[key])
            cell.append(reference)
            for model in MODELS:
                difference = percent(found[model][ours], reference)
                cell.append(f"{found[model][ours]:.4g} ({difference:+.1f} %)")
                kind = "2.5 mm Al" if row["beam"] == "W, 2.5 mm Al" else "thin filters" if "0.5 mm Al" in row["beam"] else "mammography"
                worst.setdefault(kind, []).append((difference, f"{model.capitalize()}, {row['beam']}, {row['kvp']} kV"))
        cells.append(cell)
    page.table(["beam", "kV", "first layer, mm Al", "Ebel", "Birch", "air kerma, uGy/mAs", "Ebel", "Birch"], cells)
    for kind, bar in (("2.5 mm Al", 2), ("thin filters", 5), ("mammography", 2)):
        difference, note = largest(worst[kind])
        page.judge(f"layers and output beside SpekPy, {kind}", difference, bar, "%", note)
    _heel(page, rows, source)


def _heel(page: Page, rows: list[dict[str, str]], source: str) -> None:
    page.claim("Heel effect", source + "; W, 12 degrees, 100 kV, 2.5 mm Al crossed straight.",
               "Air kerma in a plane at 1 m, over that on the central ray, and first half-value layer. Distances are towards the "
               "cathode. SpekPy's kerma has the inverse square of the distance, which is taken out.")
    centre = next(row for row in rows if row["beam"] == "heel" and float(row["aside_cm"]) == 0)
    ours_centre = quality("ebel", 100, 12, packages.AL)["air_kerma_ugy"]
    cells, worst = [], []
    for row in rows:
        x = float(row["aside_cm"]) / 100
        if row["beam"] != "heel" or x == 0:
            continue
        angle = 12 + math.degrees(math.atan(x))
        found = quality("ebel", 100, angle, packages.AL)
        ours, reference = found["air_kerma_ugy"] / ours_centre, float(row["kerma_ugy"]) / float(centre["kerma_ugy"]) * (1 + x * x)
        differences = percent(ours, reference), percent(found["hvl1_mm_al"], float(row["hvl1_mm_al"]))
        worst += [(difference, f"{row['aside_cm']} cm") for difference in differences]
        cells.append([row["aside_cm"], f"{angle:.2f}", ours, reference, signed(differences[0]), found["hvl1_mm_al"],
                      float(row["hvl1_mm_al"]), signed(differences[1])])
    page.table(["cm", "take-off angle", "kerma, ours", "SpekPy", "difference", "layer, ours", "SpekPy", "difference"], cells)
    difference, note = largest(worst)
    page.judge("heel effect", difference, 2, "%", note)


def add(page: Page) -> None:
    with_ptb(page)
    with_iec(page)
    with_spekpy(page)
