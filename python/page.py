"""Writes the page of `skiagraph live` with its scripts inside, for scenes in notebooks.

    python3 page.py page.html OUTPUT

A line <script src="FILE"></script> becomes the script of that file, beside the page, as host/cli/embed_page.cmake has it.
"""
import pathlib
import re
import sys


def main():
    if len(sys.argv) != 3:
        sys.exit("usage: python3 page.py page.html OUTPUT")
    page = pathlib.Path(sys.argv[1])

    def script(found):
        return "<script>\n" + (page.parent / found[1]).read_text(encoding="utf-8") + "</script>"

    text = re.sub(r'<script src="([^"]*)"></script>', script, page.read_text(encoding="utf-8"))
    pathlib.Path(sys.argv[2]).write_text(text, encoding="utf-8")


main()
