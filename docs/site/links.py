"""Checks a site without a network. Usage: links.py FOLDER

Every link between its pages leads somewhere, anchors included, and no page loads a script, style, font or picture from elsewhere.
Exit status 1: what does not hold, a line each.
"""
import sys
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit

LOADS = {"script": "src", "img": "src", "iframe": "src", "video": "src", "source": "src"}
LOADED_LINKS = {"stylesheet", "icon", "preload", "manifest"}


class Page(HTMLParser):
    def __init__(self, path):
        super().__init__()
        self.names, self.links, self.loads = set(), set(), set()
        self.feed(path.read_text(encoding="utf-8"))

    def handle_starttag(self, tag, attributes):
        found = dict(attributes)
        self.names |= {found[key] for key in ("id", "name") if found.get(key)}
        if tag == "a" and found.get("href"):
            self.links.add(found["href"])
        if tag == "link" and LOADED_LINKS & set((found.get("rel") or "").split()):
            self.loads.add(found["href"])
        if found.get(LOADS.get(tag, "")):
            self.loads.add(found[LOADS[tag]])


def check(root):
    pages = {path: Page(path) for path in root.rglob("*.html")}
    for path, page in pages.items():
        for word in sorted(page.links | page.loads):
            parts = urlsplit(word)
            if parts.scheme == "data":
                continue
            if parts.scheme or parts.netloc:
                if word in page.loads:
                    yield f"{path.relative_to(root)}: loads {word}"
                continue
            target = (path.parent / unquote(parts.path)).resolve() if parts.path else path
            if not target.exists():
                yield f"{path.relative_to(root)}: {word} is not there"
            elif parts.fragment and target in pages and unquote(parts.fragment) not in pages[target].names:
                yield f"{path.relative_to(root)}: {word} has no such place"


if __name__ == "__main__":
    found = list(check(Path(sys.argv[1]).resolve()))
    print("\n".join(found))
    sys.exit(bool(found))
