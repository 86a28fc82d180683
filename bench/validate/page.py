"""Tables of the page: ours, reference, difference, and whether a bar is met."""
from __future__ import annotations

import math
import textwrap
from collections.abc import Sequence
from typing import Any


def number(value: Any, digits: int = 4) -> str:
    """Text as it is, numbers with so many significant digits."""
    if isinstance(value, str):
        return value
    if value == 0 or not math.isfinite(value):
        return f"{value:g}"
    decimals = digits - 1 - math.floor(math.log10(abs(value)))
    return f"{value:.{min(max(decimals, 0), 9)}f}" if 1e-3 <= abs(value) < 1e6 else f"{value:.{digits - 1}e}"


class Page:
    """Collects the lines of the page, and what misses its bar."""

    def __init__(self) -> None:
        self.lines: list[str] = []
        self.missed: list[str] = []
        self.claims: list[tuple[str, str, str]] = []

    def text(self, *paragraphs: str) -> None:
        for paragraph in paragraphs:
            self.lines += [*textwrap.wrap(paragraph, 120, break_long_words=False, break_on_hyphens=False), ""]

    def table(self, columns: Sequence[str], rows: Sequence[Sequence[Any]]) -> None:
        self.lines += ["| " + " | ".join(columns) + " |", "|" + "---|" * len(columns)]
        self.lines += ["| " + " | ".join(number(cell) for cell in row) + " |" for row in rows]
        self.lines.append("")

    def claim(self, title: str, source: str, *paragraphs: str) -> None:
        """Begins a claim. source: where the reference is from, and of which date."""
        self.lines += [f"## {title}", ""]
        self.text(*paragraphs, f"Reference: {source}")

    def judge(self, what: str, worst: float, bar: float, unit: str = "%", note: str = "") -> None:
        """States the largest difference of a claim and its bar."""
        met = abs(worst) <= bar
        said = f"{number(worst, 2)} {unit}".strip() + (f" ({note})" if note else "")
        asked = f"{bar:g} {unit}".strip()
        self.claims.append((what, said, f"{asked}: {'met' if met else '**missed**'}"))
        self.text(f"Largest difference of {what}: {said}. Bar: {asked}, {'met' if met else '**missed**'}.")
        if not met:
            self.missed.append(f"{what}: {said}, bar {asked}")

    def write(self, head: Sequence[str]) -> str:
        summary = ["| claim | largest difference | bar |", "|---|---|---|"]
        summary += ["| " + " | ".join(claim) + " |" for claim in self.claims]
        return "\n".join([*head, "", *summary, "", *self.lines]).rstrip() + "\n"


def percent(ours: float, reference: float) -> float:
    return 100 * (ours / reference - 1)


def signed(value: float, unit: str = "%") -> str:
    """A difference for a cell."""
    return f"{value:+.2f} {unit}" if abs(value) >= 0.01 else f"{value:+.1e} {unit}"


def largest(values: Sequence[tuple[float, str]]) -> tuple[float, str]:
    """The value of the largest size, and its note."""
    return max(values, key=lambda pair: abs(pair[0]))
