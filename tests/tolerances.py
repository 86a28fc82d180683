#!/usr/bin/env python3
"""Finds tolerances without a reason: tolerances.py FOLDER. Exit status 1 when there is one.

A tolerance is the last argument of an assertion ..._tol(), the bound of ck_assert_..._le or _lt when it is below 1,
or the number that fabs() is compared with. It has a reason when it is made of an epsilon (FLT_EPSILON, DBL_EPSILON, a
power of two, a named constant) or when a comment stands on its lines or on the two lines above them."""
import pathlib
import re
import sys

NUMBER = r"(?<![\w.])\d+\.?\d*(?:[eE][-+]?\d+)?f?(?![\w.])|(?<![\w.])\.\d+(?:[eE][-+]?\d+)?f?"


def call_end(text, start):
    """The place of the parenthesis that closes the one at `start`."""
    depth = 0
    for place in range(start, len(text)):
        depth += {"(": 1, ")": -1}.get(text[place], 0)
        if depth == 0:
            return place
    return len(text)


def last_argument(text):
    depth = 0
    for place in range(len(text) - 1, -1, -1):
        depth += {")": 1, "]": 1, "(": -1, "[": -1}.get(text[place], 0)
        if text[place] == "," and depth == 0:
            return text[place + 1 :]
    return text


def bare(bound):
    """Whether a bound holds a number that nothing explains: no epsilon and no named constant beside it."""
    if "0x" in bound or re.search(r"epsilon|rounding|tolerance|change|length|error|\bbar\b", bound, re.I):
        return False
    return any(float(number.rstrip("f")) not in (0.0,) for number in re.findall(NUMBER, bound))


def bounds(text):
    """Of every comparison with a tolerance: its first and last place, and the tolerance."""
    for match in re.finditer(r"ck_assert_(?:double|float|ldouble)_(?:eq|ne)_tol\(", text):
        end = call_end(text, match.end() - 1)
        yield match.start(), end, last_argument(text[match.end() : end])
    for match in re.finditer(r"ck_assert_(?:double|float|ldouble)_(?:le|lt)\(", text):
        end = call_end(text, match.end() - 1)
        bound = last_argument(text[match.end() : end])
        numbers = [float(n.rstrip("f")) for n in re.findall(NUMBER, bound)]
        if "fabs" in text[match.end() : end - len(bound)] or any(0 < n < 1 for n in numbers):
            yield match.start(), end, bound
    for match in re.finditer(r"\bfabs[fl]?\(", text):
        end = call_end(text, match.end() - 1)
        after = re.match(r"[^;,&|?\n)]{0,30}?\s*[<>]=?\s*([^;,&|?)]*)", text[end + 1 : end + 120])
        if after:
            yield match.start(), end + after.end(), after.group(1)


def has_comment(lines, first, last):
    return any("/*" in line or "*/" in line for line in lines[max(0, first - 2) : last + 1])


def main():
    folder = pathlib.Path(sys.argv[1])
    found = []
    checked = 0
    for file in sorted([*folder.rglob("*.c"), *folder.rglob("*.h")]):
        text = file.read_text()
        lines = text.split("\n")
        for start, end, bound in bounds(text):
            checked += 1
            first, last = text.count("\n", 0, start), text.count("\n", 0, end)
            if bare(bound) and not has_comment(lines, first, last):
                found.append(f"{file}:{first + 1}: {' '.join(bound.split())}")
    print(f"{checked} tolerances, {len(found)} without a reason")
    print("\n".join(found))
    if checked < 100:
        sys.exit("too few tolerances found: is this the folder of the tests?")
    sys.exit(1 if found else 0)


main()
