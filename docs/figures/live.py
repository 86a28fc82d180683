"""Draws docs/live.png: the page of `skiagraph live` with the generated thorax. Needs Chromium and Pillow.

Usage: live.py SKIAGRAPH OUT.png
"""
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from PIL import Image

sys.path.insert(0, str(Path(__file__).parents[2] / "tests/cli"))
from chromium import Browser  # noqa: E402
from live_client import Server  # noqa: E402

SIZE = 1280, 860
HELPERS = """
const typed = (box, value) => { box.value = value; box.dispatchEvent(new Event('input')); box.dispatchEvent(new Event('change')); };
const part = label => scene.parts.findIndex(its => its.label === label);
const isStill = () => xray.frame && xray.frame.wish === net.sent && !net.waits && !served.waits && !served.reduced && !dirty;
0
"""
# The view is cut through the liver, jaws limit the beam, and the second of two bands is shown.
STEPS = """
setDark(false);
setCut('1');
if (cut.side > 0) byId('cut-side').click();
placeCut(-60);
typed(byId('bands'), '20, 50, 80');
typed(byId('channel'), '1');
typed(byId('jaws'), 'edges');
lookAs('front');
camera.target = [-5, -20, -40], camera.distance = 1450, camera.azimuth += 0.35, camera.elevation += 0.15;
byId('measure-3d').click();
0
"""


def until_still(browser):
    browser.until("isStill()", 120)
    time.sleep(0.5)  # pictures of all pixels follow those of fewer
    browser.until("isStill()", 120)


def main(command, out):
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([command, "thorax", "-o", folder, "--quiet"], check=True)
        with Server(command, f"{folder}/thorax.json") as server, Browser(server.url, SIZE) as browser:
            browser.until("typeof xray !== 'undefined' && xray.frame && net.role === 'owner'", 120)
            browser.run(HELPERS)
            until_still(browser)
            browser.run(STEPS)
            until_still(browser)
            for point in ([-75, -60, -95], [5, -60, -45]):  # of the liver, mm
                x, y = browser.run(f"(() => {{ const r = canvas.getBoundingClientRect(), p = onScreen({point}); return [r.left + p[0], r.top + p[1]]; }})()")
                browser.drag(x, y, 0, 0, 0)
            browser.run("choose('part', part('liver')); document.querySelector('aside').scrollTop = 30")
            until_still(browser)
            browser.picture(out)
    whole = Image.open(out).convert("RGB")
    whole.quantize(256, Image.Quantize.MEDIANCUT, kmeans=6, dither=Image.Dither.NONE).save(out, optimize=True)


if __name__ == "__main__":
    main(*sys.argv[1:3])
