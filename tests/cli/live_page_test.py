"""The page of `skiagraph live` in a browser: every control changes what it is for.

usage: live_page_test.py COMMAND [FOLDER for pictures of the page]
"""
import json
import math
import os
import sys
import tempfile
from types import SimpleNamespace

import chromium
from chromium import Browser
from live_client import Page, Server
from live_controls import cut, exposure, presets, sinogram, slices, tape
from live_radiograph import radiograph
from live_test import SCENE, check_same, has_server, image
from live_tried import Tried, check, failures

command = sys.argv[1]
pictures = sys.argv[2] if len(sys.argv) > 2 else None


def scene_of_matter():
    """The scene, of materials that depend on the energy."""
    scene = json.loads(json.dumps(SCENE))
    for sample, matter in zip(scene["Samples"], ("Water", "Aluminium"), strict=True):
        sample["Material"] = matter
    return scene


def beam_and_dials(tried):
    run = tried.browser.run
    first = run("frameSum()")
    tried.differs("energy", "typed(byId('energy'), 90)")
    tried.differs("undo", "byId('undo').click()")
    check("undone", run("frameSum()") == first)
    tried.differs("redo", "byId('redo').click()")
    tried.differs("tube", "byId('make-tube').click()")
    check("tube shown", run("!byId('tube').hidden && byId('mono').hidden"))
    tried.differs("kV slider", "typed(byId('kv').querySelector('input'), 120)")
    tried.differs("kV typed", "typed(byId('kv').querySelector('[type=number]'), 60)")
    tried.differs("filter", "[...byId('filters').querySelectorAll('button')].pop().click()")
    tried.differs("thickness", "typed(byId('filters').querySelector('[type=number]'), 9)")
    tried.differs("noise", "byId('noise').click()")
    tried.differs("mAs", "typed(byId('mas').querySelector('input'), 0.1)")
    tried.differs("mAs typed", "typed(byId('mas').querySelector('[type=number]'), 1e-4)")
    tried.browser.until("!byId('starved').hidden")
    run("byId('noise').click()")
    tried.still()
    tried.differs("rays", "typed(byId('rays'), '2')")
    tried.differs("tolerance", "typed(byId('tolerance'), '0.1')")
    tried.differs("precision", "typed(byId('precision'), 'half')")
    tried.differs("any key", "byId('key').value = 'Samples.bone.Material=[\"mu\", 3]'; byId('key-form').requestSubmit()")
    check("key listed", run("byId('keys').textContent.includes('Samples.bone.Material')"))
    tried.differs("as in the file", "byId('reset').click()")
    check("reset", run("frameSum()") == first)
    run("byId('key').value = 'Source.Beem=1'; byId('key-form').requestSubmit()")
    tried.browser.until("byId('sentence').textContent.includes('Beem')")
    tried.still()
    check("what was refused is taken back", run("!('Source.Beem' in state.settings)") and run("frameSum()") == first)


def bands(tried, path):
    """Photon-counting bands: each is what the verb image computes, and they are in what is taken away."""
    run = tried.browser.run
    run("byId('make-tube').click()")
    tried.differs("bands", "typed(byId('bands'), '20, 40, 80')")
    check("bands listed", run("[...byId('channel').options].map(o => o.textContent).join()") == "20 to 40 keV,40 to 80 keV")
    check_bands(tried, path, 0)
    tried.differs("second band", "typed(byId('channel'), '1')")
    check_bands(tried, path, 1)
    tried.differs("undo of a band", "byId('undo').click()")
    run("document.querySelector('[data-take=command]').click(); document.querySelector('[data-take=py]').click()")
    check("command of bands", run("byId('command').textContent.includes(' --bands 20,40,80 ')"), run("byId('command').textContent"))
    check("script of bands", "scene.image(bands=[20, 40, 80])" in dict(run("saved"))["image.py"])
    run("saved.length = 0; typed(byId('bands'), '40, 20')")
    check("falling edges", run("byId('sentence').textContent.includes('rising') && byId('bands').value === '20, 40, 80'"))
    run("byId('reset').click()")
    tried.still()
    check("no bands", run("byId('channel').hidden && byId('bands').value === ''"))


def check_bands(tried, path, band):
    frame = tried.browser.run("({numbers: [...xray.frame.numbers], low: xray.frame.low, step: xray.frame.step})")
    pixels = image(path, "--quantity", "attenuation", "--bands", "20,40,80", "--set", 'Source.Beam={"kVp": 80, "Filter": [["Al", 2.5, "mm"]]}')
    try:
        check_same(SimpleNamespace(**frame), pixels[band::2])  # the channels of a .mha follow each other in each pixel
    except AssertionError as error:
        check(f"band {band} as the verb image", False, str(error))


def geometry(tried):
    run, browser = tried.browser.run, tried.browser
    run("byId('find').value = 'bon'; byId('find').oninput()")
    check("find", run("rows[0].hidden && !rows[1].hidden"))
    run("byId('find').value = ''; byId('find').oninput(); rows[1].querySelector('button').click()")
    check("chosen", run("chosen.part === 1 && byId('about').textContent.includes('bone')"))
    box = json.loads(run("(() => { draw(); const r = canvas.getBoundingClientRect(), m = onScreen(middleOf()), t = onScreen(add(middleOf(),"
                         " REACH * 0.7 * mmPerPixel(middleOf()), AXES[2])); return JSON.stringify([r.left + t[0], r.top + t[1], m, t]); })()"))
    tried.differs("arrow", lambda: browser.drag(box[0], box[1], 0, -40))
    check("moved up", run("state.poses[1] && state.poses[1][11] > 5 && Math.abs(state.poses[1][3]) < 1e-9"), run("JSON.stringify(state.poses)"))
    tried.differs("undo of an arrow", "byId('undo').click()")
    ring = json.loads(run("(() => { draw(); const r = canvas.getBoundingClientRect(), p = byId('gizmo').querySelector('[data-ring=\"2\"]')"
                          ".getAttribute('d').slice(1).split('L')[6].split(',').map(Number); return JSON.stringify([r.left + p[0], r.top + p[1]]); })()"))
    tried.differs("ring", lambda: browser.drag(ring[0], ring[1], 30, 14))
    check("turned", run("Math.abs(state.poses[1][1]) > 0.02"), run("JSON.stringify(state.poses)"))
    tried.differs("back to its place", "[...byId('about').querySelectorAll('button')].pop().click()")
    tried.differs("x typed", "typed(byId('about').querySelector('.grid input'), 12)")
    check("x", run("Math.abs(middleOf()[0] - 12) < 1e-3"))
    tried.differs("turn typed", "typed(byId('about').querySelectorAll('.grid input')[5], 30)")
    tried.differs("key Alt", lambda: browser.key("ArrowRight", 1))
    check("1 mm", run("Math.abs(middleOf()[0] - 13) < 1e-3"))
    for kind in ("source", "detector"):
        run(f"byId('choose-{kind}').click()")
        tried.differs(kind, "typed(byId('about').querySelector('.grid input'), 30)")
        check(kind + " moved", run("Math.abs(middleOf()[0] - 30) < 1e-3"), run("JSON.stringify(middleOf())"))
    tried.differs("detector turned", "typed(byId('about').querySelectorAll('.grid input')[4], 10)")
    tried.differs("projection", "typed(byId('projection'), 1)")
    tried.differs("3D follows", "byId('reset').click()", "viewSum")


def view(tried):
    browser, run = tried.browser, tried.browser.run
    centre = json.loads(run("(() => { const r = canvas.getBoundingClientRect(); return JSON.stringify([r.left + r.width / 2, r.top + r.height - 40]); })()"))
    run("choose('')")
    tried.differs("turn", lambda: browser.drag(centre[0], centre[1], 60, 10), "viewSum")
    for key in ("1", "2", "3", "4", "0", "f", "+", "-", "ArrowLeft", "ArrowUp"):
        if key not in ("4", "f"):  # the first side is that of the source, and all parts may be all that there is
            run("canvas.focus(); lookAs('start')" if key not in "0" else "canvas.focus(); lookAs('top')")
            tried.differs("key " + key, lambda k=key: browser.key(k), "viewSum")
    run("lookAs('start')")
    tried.differs("wheel", "canvas.dispatchEvent(new WheelEvent('wheel', {deltaY: -120, cancelable: true}))", "viewSum")
    tried.differs("hide", "rows[1].firstChild.click()", "viewSum")
    tried.differs("all", "byId('all').click()", "viewSum")
    run("choose('part', 1)")
    tried.differs("opacity", "(() => { const s = byId('about').querySelector('[type=range]'); s.value = 0.2; s.oninput(); })()", "viewSum")
    tried.differs("dark", "byId('dark').click()", "viewSum")
    browser.key("?")
    check("keys", run("byId('key-list').open && byId('key-list').textContent.includes('move what is chosen')"))
    browser.key("?")
    check("no keys", not run("byId('key-list').open"))
    # A wish that waits: as if it had been sent, and answered later.
    computing = "getComputedStyle(byId('computing')).visibility === 'visible' && getComputedStyle(byId('ms')).opacity < 1"
    tried.still()
    check("not computing", not run(computing))
    run("net.sent++; expect()")
    browser.until(computing)
    run("settle(--net.sent)")
    check("computed", not run(computing))


def served(tried):
    """Pictures of the server: on change only, with fewer pixels while the view moves, and where the overlay has its points."""
    browser, run = tried.browser, tried.browser.run
    run("choose(''); lookAs('start'); meshes.forEach(m => { m.colour[3] = 1; m.visible = true; })")
    first = tried.view()
    browser.size(1280, 801)
    tried.still()
    check("another size", run("served.number > 0 && byId('picture').width === canvas.clientWidth && byId('picture').height === canvas.clientHeight"))
    browser.size(1280, 800)
    check("as at first", tried.view() == first)
    asked = run("served.number")
    run("change(); draw(); change(); draw()")
    tried.still()
    check("on change only", run("served.number") == asked)
    run("served.ms = 2000; orbit(0.4, 0); draw()")
    browser.until("!served.waits")
    check("fewer pixels while it moves", run("byId('picture').width < 0.5 * canvas.clientWidth"), run("byId('picture').width"))
    tried.still()
    check("all pixels when it stands", run("byId('picture').width === canvas.clientWidth"))
    run("lookAs('front')")
    tried.still()
    # the middle of the bone, alone, is where the overlay has it; beside it is the background
    run("meshes[0].visible = false")
    tried.still()
    at = ("(() => { const [x, y] = onScreen(%s), p = byId('picture'); return [...p.getContext('2d').getImageData(Math.floor(x), Math.floor(y), 1, 1).data]; })()")
    ground = run("shot.ground.map(x => Math.round(255 * x))")
    corner = run("[...byId('picture').getContext('2d').getImageData(2, 2, 1, 1).data]")
    check("background", corner[:3] == ground, f"{corner} {ground}")
    bone = run(at % "[4, -30, 6]")
    check("the bone", max(abs(a - b) for a, b in zip(bone, ground)) > 20 and bone[3] == 255, str(bone))
    run("meshes[0].visible = true; choose('part', 1)")
    tried.still()
    run("choose('')")
    tried.still()
    run("lookAs('start')")


def film(tried):
    browser, run = tried.browser, tried.browser.run
    wishes = run("net.sent")
    tried.differs("invert", "byId('invert').click()", "filmSum")
    tried.differs("white", "typed(byId('high'), 1)", "filmSum")
    tried.differs("auto", "byId('auto').click()", "filmSum")
    tried.differs("histogram", "byId('histogram').scrollIntoView(); (() => { const r = byId('histogram').getBoundingClientRect(); window.h = [r.left, r.top, r.width]; })()"
                  "; setWindow(xray.low, xray.low + 0.3 * (xray.high - xray.low))", "filmSum")
    run("byId('auto').click(); byId('profiles').click()")
    place = json.loads(run("(() => { const r = film.getBoundingClientRect(); return JSON.stringify([r.left, r.top, r.width, r.height]); })()"))
    browser.drag(place[0] + 0.1 * place[2], place[1] + 0.5 * place[3], 0.8 * place[2], 0)
    length = run("Number(byId('measured').textContent.match(/over ([0-9.]+) mm/)[1])")
    check("profile", abs(length - 0.8 * 320) < 3, str(length))  # of a detector of 320 mm; a pixel of the page is 1 mm or less
    run("byId('profiles').click()")
    run(f"window.spot = {{clientX: {round(place[0] + 0.7 * place[2])}, clientY: {round(place[1] + 0.4 * place[3])}, cancelable: true}}")
    spot = json.loads(run("JSON.stringify(placeOn(spot))"))
    run("for (let i = 0; i < 4; i++) film.dispatchEvent(new WheelEvent('wheel', {deltaY: -120, ...spot}))")
    zoom = run("film.getBoundingClientRect().width") / place[2]
    check("zoom", abs(zoom - math.exp(1.2)) < 1e-3, str(zoom))
    check("about the cursor", run(f"Math.hypot(placeOn(spot)[0] - {spot[0]}, placeOn(spot)[1] - {spot[1]}) < 1e-4"))
    browser.drag(place[0] + 0.5 * place[2], place[1] + 0.5 * place[3], 20, 0)
    moved = run("placeOn(spot)[0]") - spot[0]
    check("moved", abs(moved + 20 / place[2] / zoom) < 2e-3, str(moved))
    run("film.dispatchEvent(new MouseEvent('dblclick'))")
    check("all of it", run("lens.zoom === 1") and abs(run("film.getBoundingClientRect().left") - place[0]) < 0.01)
    # the server makes the first frame of a scene once more, for its time: frames do not count
    check("no wish for the window", run("net.sent") == wishes)
    browser.mouse("mouseMoved", place[0] + 0.5 * place[2], place[1] + 0.5 * place[3])
    browser.until("byId('value').textContent.includes('bone: 60 mm')")
    check("value", run("byId('value').textContent.includes('column 40, row 30')"), run("byId('value').textContent"))
    run("byId('keep').click()")
    tried.differs("before/after", "typed(byId('energy'), 30); 0", "frameSum")
    tried.differs("slider", "typed(byId('split'), 0.1)", "filmSum")
    run("byId('keep').click(); byId('reset').click()")
    tried.still()


def cost_and_takes(tried):
    browser, run = tried.browser, tried.browser.run
    check("stages", run("byId('stages').textContent.includes('raster')"))
    check("ms", run("/^[0-9.]+ ms for 80 x 60/.test(byId('ms').textContent)"), run("byId('ms').textContent"))
    run("byId('measure').click()")
    browser.until("!byId('measure').disabled", 120)
    check("measured", run("byId('results').rows.length > 3 && /ms/.test(byId('results').textContent)"))
    tried.differs("switch", "[...byId('results').querySelectorAll('button')].find(b => b.textContent.includes('2 x 2')).click()")
    run("choose('part', 1); moveChosen(shift([16, 0, 0]))")
    tried.still()
    shown = run("frameSum()")
    for take in ("json", "py", "command", "png", "tif", "mha"):
        run(f"document.querySelector('[data-take={take}]').click()")
    browser.until("saved.length >= 5")
    names = sorted(name for name, _ in run("saved"))
    check("files", names == ["image.mha", "image.png", "image.py", "image.tif", "scene.json"], str(names))
    texts = dict(run("saved"))
    check("script", "settings={" in texts["image.py"] and 'scene["bone"].pose' in texts["image.py"])
    compile(texts["image.py"], "image.py", "exec")
    check("command", run("byId('command').textContent.includes('--set') && byId('command').textContent.includes('Matrix')"))
    return shown, texts["scene.json"]


def reads_only(server, url):
    """A second page, beside a first one that is not this browser's, once the server has seen that the page before has gone."""
    first = Page(server)
    first.find(lambda m: isinstance(m, dict) and m.get("role") == "owner")
    first.frame()
    with Browser(url) as browser:
        browser.until("typeof net !== 'undefined' && net.role === 'reader' && xray.frame !== null && live !== null")
        before, state = browser.run("xray.frame.number"), browser.run("JSON.stringify(state)")
        browser.run("set('Source.Position', [8, -400, 0, 'mm'])")
        check("reader", browser.run("JSON.stringify(state)") == state)
        wish = first.wish(settings={"Source.Position": [30, -400, 0, "mm"]})
        browser.until(f"xray.frame.wish === {wish}")
        check("reader sees", browser.run("xray.frame.number") > before)
    first.close()


def sizes(tried, name):
    """Wide and as a phone, light and dark."""
    browser = tried.browser
    browser.run("typed(byId('jaws'), 'edges')")
    tried.still()
    for is_dark in (False, True):
        browser.run(f"setDark({json.dumps(is_dark)})")
        for width, height in ((1280, 800), (390, 844)):
            browser.size(width, height)
            browser.until("Math.abs(canvas.width - canvas.clientWidth) < 1 && !dirty")
            for box in ("document.documentElement", "document.querySelector('aside')"):
                check("no scrolling sideways", browser.run(f"{box}.scrollWidth <= {box}.clientWidth"), f"{box} {width}")
            for box in ("header", ".buttons"):
                check("buttons in one row", browser.run(f"document.querySelector('{box}').clientHeight < 55"), f"{box} {width}")
            if pictures:
                browser.picture(os.path.join(pictures, f"{name}-{'dark' if is_dark else 'light'}-{width}.png"))


def work(folder, path):
    with Server(command, path) as server:
        with Browser(server.url) as browser:
            tried = Tried(browser)
            beam_and_dials(tried)
            bands(tried, path)
            exposure(tried, path)
            presets(tried, path)
            check("software draws slowly", tried.browser.run("isSlow && isServed()"))
            for by in ("browser", "server"):
                tried.drawn(by)
                for part in (geometry, view, cut, tape):
                    part(tried)
            served(tried)
            for part in (slices, sinogram, film):
                part(tried)
            shown, scene = cost_and_takes(tried)
            sizes(tried, "live")
            check("no exception", not browser.events, json.dumps(browser.events)[:800])
        reads_only(server, server.url)
    other = os.path.join(folder, "taken.json")
    with open(other, "w", encoding="utf-8") as file:
        file.write(scene)
    with Server(command, other) as server, Browser(server.url) as browser:
        tried = Tried(browser)
        check("the scene file that was taken shows the same", browser.run("frameSum()") == shown)


def breathes(folder):
    """A thorax goes on breathing, and what is dragged while it does."""
    os.system(f"{command} thorax -o {folder} --simple --triangles 10000 --quiet")
    with Server(command, os.path.join(folder, "thorax.json"), "--set", "Detector.NumberOfPixels=[80,80]") as server, Browser(server.url) as browser:
        tried = Tried(browser)
        tried.differs("phase", "typed(byId('phase'), 0.5)")
        for by, phase in (("browser", 0.2), ("server", 0.7)):
            tried.drawn(by)
            tried.differs("3D breathes, " + by, f"typed(byId('phase'), {phase})", "viewSum")
        browser.run("byId('play').click()")
        browser.until("state.play && xray.frame.number > 20")
        browser.run("byId('play').click()")
        tried.still()
        last = browser.run("xray.frame.number")
        tried.differs("phase after the breath", "typed(byId('phase'), (state.phase + 0.5) % 1)")
        check("stopped", browser.run("xray.frame.number") == last + 1)  # no image came between
        check("no exception", not browser.events, json.dumps(browser.events)[:800])


def bends(folder):
    """A curved detector is drawn on its cylinder, measured along it, and keeps its steps when it is moved and turned."""
    path = os.path.join(folder, "curved.json")
    scene = scene_of_matter()
    scene["Detector"] = {"Position": [0, 200, 0, "mm"], "ColumnStep": [8, 0, 0, "mm"], "RowStep": [0, 0, -8, "mm"],
                         "NumberOfPixels": [60, 40], "Curved": {"Radius": [250, "mm"]}}
    with open(path, "w", encoding="ascii") as file:
        json.dump(scene, file)
    with Server(command, path) as server, Browser(server.url) as browser:
        run = browser.run
        tried = Tried(browser)
        tried.still()
        # 480 mm on a radius of 250 mm: its ends are 500 sin(0.96) mm apart.
        ends = "size(add(scene.view.strips[0][0], -1, scene.view.strips[23][0]))"
        check("curved", abs(run(ends) - 500 * math.sin(0.96)) < 1e-6, str(run(ends)))
        check("along the cylinder", abs(run("lengthOnDetector([0.25, 0.5], [0.75, 0.5])") - 240) < 1e-6)
        run("byId('choose-detector').click()")
        tried.differs("moved", "typed(byId('about').querySelector('.grid input'), 30)")
        tried.still()
        check("steps stay", run("valueOf('Detector.ColumnStep').slice(0, 3).join()") == "8,0,0", str(run("valueOf('Detector.ColumnStep')")))
        check("still as wide", abs(run(ends) - 500 * math.sin(0.96)) < 1e-6, str(run(ends)))
        check("no exception", not browser.events, json.dumps(browser.events)[:800])


def main():
    if not chromium.program():
        print("no chromium; CHROMIUM names another browser of that kind")
        return 77
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "scene.json")
        with open(path, "w", encoding="ascii") as file:
            json.dump(scene_of_matter(), file)
        if not has_server(path):
            print("this build has no CivetWeb")
            return 77
        work(folder, path)
        breathes(folder)
        bends(folder)
        radiograph(folder, pictures)
    for failure in failures:
        print("failed:", failure)
    print(f"{len(failures)} failures")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
