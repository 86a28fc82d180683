"""Densities of elements as gVXR 2.1 takes them, where a script gives none. Private."""
from __future__ import annotations

from ..material import Material

#: g/cm3, of hydrogen to uranium.
_DENSITIES = tuple(map(float, """
8.988e-05 0.0001785 0.534 1.85 2.34 2.267 0.0012506 0.001429 0.001696 0.0008999 0.971 1.738 2.698 2.3296 1.82 2.067
0.003214 0.0017837 0.862 1.54 2.989 4.54 6.11 7.15 7.44 7.874 8.86 8.912 8.96 7.134 5.907 5.323 5.776 4.809 3.122
0.003733 1.532 2.64 4.469 6.506 8.57 10.22 11.5 12.37 12.41 12.02 10.501 8.69 7.31 7.287 6.685 6.232 4.93 0.005887 1.873
3.594 6.145 6.77 6.773 7.007 7.26 7.52 5.243 7.895 8.229 8.55 8.795 9.066 9.321 6.965 9.84 13.31 16.654 19.25 21.02
22.61 22.56 21.46 19.282 13.5336 11.85 11.342 9.807 9.32 7 0.00973 1.87 5.5 10.07 11.72 15.37 18.95
""".split()))


def element(symbol: str, number: int) -> Material:
    """An element at gVXR's density."""
    return Material(symbol, density=_DENSITIES[number - 1])
