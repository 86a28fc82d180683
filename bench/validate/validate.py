#!/usr/bin/env python3
"""Writes docs/validation.md to standard output; bench/validate/run calls it. Exit status 1: a bar is missed."""
from __future__ import annotations

import argparse
import datetime
import sys
import warnings

import attenuation
import body
import deposition
import images
import lengths
import packages
import precision
import scatter
import skiagraph as sk
import tubes
from page import Page

HEAD = """# Validation

Every claim of this project that has a reference outside it: ours, the reference, its source and date, and the difference.
`bench/validate/run` makes this page; do not edit it. The rows of this table sum it up; each has a section below.

SpekPy and xraylib serve as references where Python has them, otherwise the tables of `bench/validate/tables` that they gave
do (`bench/validate/packages.py` makes them again). Data that are not part of the repository lie in the folder `$SKG_DATA`.
The line below names a digest of the tokens of `kernels/`; the test `bench_validate_holds` fails when they have changed and this
page was not made again. Comments and formatting do not count.
"""


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--build", required=True)
    parser.add_argument("--data", required=True)
    parser.add_argument("--commit", required=True)
    parser.add_argument("--kernels", required=True)
    given = parser.parse_args()
    warnings.simplefilter("ignore", sk.SkiagraphWarning)  # beams are softer than IEC 60601-1-3 asks for, on purpose
    page = Page()
    attenuation.add(page)
    tubes.add(page)
    deposition.add(page)
    lengths.add(page)
    precision.add(page)
    images.add(page)
    body.add(page, given.build, given.data)
    scatter.add(page, given.build, given.data)
    names = [packages.rows_of(name)[1] for name in packages.PACKAGES]
    head = [*HEAD.splitlines(), f"Made {datetime.date.today()} from commit {given.commit}, kernels {given.kernels}. Packages: {'; '.join(names)}."]
    sys.stdout.write(page.write(head))
    for missed in page.missed:
        print(f"missed: {missed}", file=sys.stderr)
    return 1 if page.missed else 0


if __name__ == "__main__":
    sys.exit(main())
