"""The digest of all kernels: the first digits of the SHA-256 of their tokens, so that comments and formatting do not count.

usage: kernels.py FOLDER
"""
import hashlib
import pathlib
import re
import sys

# A token of C: a comment, a text, a word or number, a sign. Signs of several characters are several tokens, which is the same for
# all ways to write them.
TOKEN = re.compile(r"""/\*.*?\*/|//[^\n]*|"(?:[^"\\\n]|\\.)*"|'(?:[^'\\\n]|\\.)*'|[\w.]+|\S""", re.DOTALL)


def tokens(text):
    """The tokens of a source, without comments. Lines that a backslash continues are joined; a directive ends with its line."""
    for line in re.sub(r"/\*.*?\*/", " ", text.replace("\\\n", " "), flags=re.DOTALL).split("\n"):
        of_line = [token for token in TOKEN.findall(line) if not token.startswith(("//", "/*"))]
        yield from of_line
        if of_line[:1] == ["#"]:
            yield "\n"


def digest(folder):
    whole = hashlib.sha256()
    for path in sorted(pathlib.Path(folder).rglob("*"), key=lambda path: path.name):
        if path.suffix in (".cl", ".clh", ".h"):
            whole.update(" ".join([path.name, *tokens(path.read_text(encoding="utf-8"))]).encode())
    return whole.hexdigest()[:16]


if __name__ == "__main__":
    print(digest(sys.argv[1]))
