"""Shared code of the tests of the page of `skiagraph live`."""
import json
from types import SimpleNamespace

from live_test import check_same, image

# Sums by which pictures are told apart: of the frame's numbers, of the X-ray as it is shown, and of the 3D view.
HELPERS = """
const sumOf = numbers => { let s = 7; for (const x of numbers) s = (Math.imul(s, 31) + x) | 0; return s; };
const frameSum = () => sumOf(xray.frame.numbers) + ' ' + xray.frame.low + ' ' + xray.frame.step + ' ' + xray.frame.columns;
const filmSum = () => sumOf(pen.getImageData(0, 0, film.width, film.height).data);
const pictureSum = () => { const p = byId('picture'); return sumOf(p.getContext('2d').getImageData(0, 0, p.width, p.height).data); };
const viewSum = () => { if (isServed()) return pictureSum(); draw(); const p = new Uint8Array(4 * canvas.width * canvas.height);
  gl.readPixels(0, 0, canvas.width, canvas.height, gl.RGBA, gl.UNSIGNED_BYTE, p); return sumOf(p); };
const settled = () => xray.frame && !net.waits && xray.frame.wish === net.sent && net.shot && net.shot.shot === xray.frame.number &&
  (!isServed() || !dirty && !served.waits && !served.missed && !served.reduced && served.stamp > 0);
const typed = (box, value) => { box.value = value; box.dispatchEvent(new Event('input')); box.dispatchEvent(new Event('change')); };
const saved = []; save = (name, bytes) => saved.push([name, typeof bytes === 'string' ? bytes : bytes.length]);
0
"""
failures = []


def check(name, is_right, what=""):
    if not is_right:
        failures.append(f"{name} {what}")


class Tried:
    """A page, and the effects of its controls."""

    def __init__(self, browser):
        self.browser = browser
        browser.until("typeof net !== 'undefined' && xray.frame !== null && live !== null && net.role === 'owner'")
        browser.run(HELPERS)
        self.still()

    def still(self):
        self.browser.run("if (isServed()) change()")  # tests change things behind the page's back
        self.browser.until("settled()")

    def view(self):
        """The sum of the 3D view."""
        self.still()
        return self.browser.run("viewSum()")

    def drawn(self, by):
        """Lets the browser or the server draw the 3D view, of all parts as at first."""
        self.browser.run("choose(''); lookAs('start'); meshes.forEach((m, i) => { m.visible = true; m.colour[3] = scene.parts[i].colour[3] / 255; })")
        self.browser.run(f"typed(byId('drawer'), '{by}')")
        self.still()
        check("drawn by", self.browser.run("isServed()") == (by == "server") and self.browser.run("byId('picture').hidden") == (by != "server"), by)

    def differs(self, name, action, of="frameSum"):
        """The action changes this sum."""
        self.still()
        before = self.browser.run(f"{of}()")
        action() if callable(action) else self.browser.run(action)
        self.still()
        check(name, self.browser.run(f"{of}()") != before, f"leaves {of} as it is; {self.browser.run('byId(`sentence`).textContent')}")


def check_image(tried, path, settings):
    """The page shows what the verb image computes."""
    frame = tried.browser.run("({numbers: [...xray.frame.numbers], low: xray.frame.low, step: xray.frame.step})")
    words = [word for key, value in settings.items() for word in ("--set", f"{key}={json.dumps(value)}")]
    try:
        check_same(SimpleNamespace(**frame), image(path, "--quantity", "attenuation", *words))
    except AssertionError as error:
        check("as the verb image", False, f"{settings}: {error}")
