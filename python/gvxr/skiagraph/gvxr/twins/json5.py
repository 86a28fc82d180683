"""JSON with comments, bare keys, single quotes and commas at the ends, in which gVXR describes its twins."""
from __future__ import annotations

import json
import re
from typing import Any

#: What JSON has as it is, what JSON5 has besides, and what neither has.
_TOKENS = re.compile(r"""
    (?P<space>\s+ | //[^\n]* | /\*.*?\*/)
  | (?P<text>"(?:[^"\\\n]|\\.)*" | '(?:[^'\\\n]|\\.)*')
  | (?P<number>[-+]?(?:0[xX][0-9a-fA-F]+ | (?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)? | Infinity | NaN))
  | (?P<name>[A-Za-z_$][\w$]*)
  | (?P<mark>[][{}:,])
""", re.X | re.S)


def _text(quoted: str) -> str:
    """A string of JSON5 as one of JSON."""
    inside = re.sub(r"\\'", "'", quoted[1:-1])
    inside = re.sub(r"\\\n", "", inside)
    return '"' + (inside if quoted[0] == '"' else re.sub(r'(?<!\\)"', r'\\"', inside)) + '"'


def _number(word: str) -> str:
    """A number of JSON5 as one of JSON."""
    sign, digits = ("-" if word[0] == "-" else ""), word.lstrip("+-")
    if digits[:2] in ("0x", "0X"):
        return sign + str(int(digits, 16))
    if digits[0] == ".":
        digits = "0" + digits
    return sign + re.sub(r"\.(?=[eE]|$)", ".0", digits)


def loads(text: str) -> Any:
    """The value that a text of JSON5 describes."""
    parts: list[str] = []
    at = 0
    while at < len(text):
        found = _TOKENS.match(text, at)
        if not found:
            line = text.count("\n", 0, at) + 1
            raise ValueError(f"line {line}: {text[at]!r} is no JSON5")
        at, kind, word = found.end(), found.lastgroup, found.group()
        if kind == "text":
            parts.append(_text(word))
        elif kind == "number":
            parts.append(_number(word))
        elif kind == "name":
            parts.append(word if word in ("true", "false", "null") else f'"{word}"')
        elif kind == "mark":
            if word in "]}" and parts and parts[-1] == ",":
                parts.pop()
            parts.append(word)
    return json.loads(" ".join(parts))
