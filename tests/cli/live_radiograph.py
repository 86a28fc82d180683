"""The radiograph of `skiagraph live --fixed` on the page: how it lies over the image, and the button that registers."""
import json
import os

from chromium import Browser
from live_client import Server
from live_test import BONE, MOVED, command, write_blocks
from live_tried import Tried, check

# The mean square of the difference of image and radiograph, in -ln(I/I0).
APART = ("(() => { let sum = 0; const n = xray.frame.numbers.length; for (let i = 0; i < n; i++)"
         " sum += (shownOf(xray.frame, xray.frame.numbers[i]) - shownOf(fixed.frame, fixed.frame.numbers[i])) ** 2; return sum / n; })()")
# The colours of a pixel of the film, of the bone in the radiograph and beside it in the image.
COLUMN = 26
PIXEL = "[...pen.getImageData(%d, 30, 1, 1).data].slice(0, 3)"


def shown(tried):
    """Over the image by its opacity, left of the slider, as the difference, or not at all."""
    run = tried.browser.run
    plain = "(() => { const was = fixed.how; fixed.how = 'off'; paint(); const p = %s; fixed.how = was; paint(); return p; })()" % (PIXEL % COLUMN)
    ours = run(plain)
    run("typed(byId('fixed-share'), 1)")
    theirs = run(PIXEL % COLUMN)
    check("another grey", abs(ours[0] - theirs[0]) > 20, f"{ours} {theirs}")
    run("typed(byId('fixed-share'), 0.5)")
    check("half of each", abs(run(PIXEL % COLUMN)[0] - (ours[0] + theirs[0]) / 2) <= 1.5)  # two roundings to greys
    run("typed(byId('fixed-share'), 0)")
    check("nothing of it", run(PIXEL % COLUMN) == ours)
    run("typed(byId('fixed-how'), 'beside'); typed(byId('fixed-share'), 0.3)")
    check("right of the slider", run(PIXEL % COLUMN) == ours)
    run("typed(byId('fixed-share'), 0.7)")
    check("left of the slider", run(PIXEL % COLUMN) == theirs)
    run("typed(byId('fixed-how'), 'difference')")
    red, _, blue = run(PIXEL % COLUMN)
    check("blue where the image attenuates less", blue > red + 20, f"{red} {blue}")
    check("the scale is told", "full colour is 0.08 " in run("byId('fixed-text').textContent"), run("byId('fixed-text').textContent"))
    run("typed(byId('fixed-how'), 'off')")
    check("hidden", run(PIXEL % COLUMN) == ours and run("byId('fixed-share').hidden"))
    run("typed(byId('fixed-how'), 'over'); typed(byId('fixed-share'), 0.5)")
    tried.differs("another projection", "typed(byId('projection'), 1)")
    check("it is not shown then", run("!isCompared(xray.frame) && byId('fixed-text').textContent.includes('another view')"), run("byId('fixed-text').textContent"))
    tried.differs("its own view", "byId('reset').click()")
    check("it is shown again", run("isCompared(xray.frame) && state.projection === null"))


def registers(tried):
    """The button moves the chosen part to where the radiograph shows it, as a drag would, and says how well that is known."""
    browser, run = tried.browser, tried.browser.run
    run("choose('')")
    check("no part", run("byId('register').disabled && byId('register-step').textContent.includes('choose a part')"))
    run(f"choose('part', {BONE})")
    check("a part", run("!byId('register').disabled && byId('register').textContent === 'register bone'"))
    before = run(APART)
    run("byId('register').click()")
    check("one at a time", run("byId('register').disabled && !byId('register-stop').hidden"))
    browser.until(f"state.poses[{BONE}]")
    tried.still()
    pose, after = run(f"state.poses[{BONE}]"), run(APART)
    check("found", all(abs(pose[k] - MOVED[k]) < 0.2 for k in (3, 11)), str(pose))  # a tenth of a pixel, as in live_test
    check("agrees", after < 0.01 * before, f"{before} {after}")
    check("the verdict", run("byId('verdict').textContent").startswith("bone: "), run("byId('verdict').textContent"))
    check("sigma", run("byId('freedoms').rows.length === 7 && /mm/.test(byId('freedoms').textContent)"))
    tried.differs("undo", "byId('undo').click()")
    check("undone", run(f"!state.poses[{BONE}]") and run(APART) == before)
    run("typed(byId('rays'), '16')")
    tried.still()
    run("byId('register').click()")
    browser.until("byId('register-step').textContent.includes('step')")
    run("byId('register-stop').click()")
    browser.until("!fixed.runs")
    check("stopped", run("byId('verdict').textContent.includes('stopped') && byId('register-stop').hidden"), run("byId('verdict').textContent"))
    run("byId('reset').click()")
    tried.still()
    run(f"choose('part', {BONE + 1}); byId('register').click()")
    browser.until("!fixed.runs")
    check("refused", run("byId('verdict').textContent.includes('away')") and run("JSON.stringify(state.poses)") == "{}", run("byId('verdict').textContent"))


def radiograph(folder, pictures):
    """A page with a radiograph."""
    scene, own, _ = write_blocks(folder)
    with Server(command, scene, "--fixed", own) as server, Browser(server.url) as browser:
        tried = Tried(browser)
        browser.until("fixed.frame")
        check("shown from the start", browser.run("!byId('fixed').hidden && isCompared(xray.frame)"))
        shown(tried)
        registers(tried)
        browser.run(f"choose('part', {BONE}); byId('register').click()")
        browser.until(f"state.poses[{BONE}]")
        tried.still()
        for is_dark in (False, True):
            browser.run(f"setDark({json.dumps(is_dark)})")
            for width, height in ((1280, 800), (390, 844)):
                browser.size(width, height)
                browser.until("Math.abs(canvas.width - canvas.clientWidth) < 1 && !dirty")
                for box in ("document.documentElement", "document.querySelector('aside')"):
                    check("no scrolling sideways", browser.run(f"{box}.scrollWidth <= {box}.clientWidth"), f"{box} {width}")
                if pictures:
                    browser.run("byId('fixed').scrollIntoView()")
                    browser.picture(os.path.join(pictures, f"fixed-{'dark' if is_dark else 'light'}-{width}.png"))
        check("no exception", not browser.events, json.dumps(browser.events)[:800])
