"""Focal spot, jaws, cut, measuring line and sinogram of the page of `skiagraph live`."""
import json
import subprocess

from live_test import command
from live_tried import check, check_image


def exposure(tried, path):
    """Focal spot, jaws, and what reaches the detector."""
    run = tried.browser.run
    first = run("frameSum()")
    kerma = json.loads(subprocess.run([command, "plan", path, "--json"], capture_output=True, text=True, check=True).stdout)["open_beam"]["air_kerma_uGy"]
    check("air kerma", run("byId('kerma').textContent") == f"air kerma at the detector {kerma:.3g} \u00b5Gy", run("byId('kerma').textContent"))
    check("a point", run("byId('spot-shape').value === 'PointSource' && byId('spot-width').hidden"))
    tried.differs("disc", "typed(byId('spot-shape'), 'Disc')")
    tried.differs("size", "typed(byId('spot-slider'), 5)")
    check_image(tried, path, {"Source.Shape": ["Disc", 5, "mm"]})
    tried.differs("rectangle", "typed(byId('spot-shape'), 'Rectangle')")
    tried.differs("height", "typed(byId('spot-height'), 9)")
    check("spot", run("JSON.stringify(state.settings['Source.Shape'])") == '["Rectangle",5,9,"mm"]', run("JSON.stringify(state.settings)"))
    run("byId('spot-width').value = -1; byId('spot-width').onchange()")
    tried.browser.until("byId('sentence').textContent.includes('focal spot')")
    tried.still()
    check("width taken back", run("byId('spot-width').value") == "5", run("byId('spot-width').value"))
    tried.differs("point", "typed(byId('spot-shape'), 'PointSource')")
    check("as at first", run("frameSum()") == first)
    middle = "xray.frame.numbers[30 * 80 + 40] * xray.frame.step + xray.frame.low"
    corner = "xray.frame.numbers[0] * xray.frame.step + xray.frame.low"
    tried.differs("the field's jaws", "typed(byId('jaws'), 'field'); typed(byId('margin-slider'), -60)")
    check("jaws stop", run(f"{middle} < 20 && {corner} > 87"))
    check("window between jaws", run("xray.high < 20 && xray.ends[1] < 20"), run("String([xray.high, xray.ends])"))
    check_image(tried, path, {"Collimation": {"Field": "detector", "Margin": [-60, "mm"]}})
    tried.differs("a rectangle of jaws", "typed(byId('jaws'), 'edges')")
    check("jaws in 3D", run("scene.view.jaws.length") == 4)
    tried.differs("left", "typed(byId('jaws-left'), -10)")
    tried.differs("distance", "typed(byId('jaws-distance'), 100)")
    tried.differs("jaws in 3D", "typed(byId('jaws-top'), 4)", "viewSum")
    check_image(tried, path, {"Collimation": json.loads(run("JSON.stringify(state.settings.Collimation)"))})
    run("typed(byId('jaws-right'), -20)")
    tried.browser.until("byId('sentence').textContent.includes('exceed')")
    tried.still()
    check("right taken back", run("Number(byId('jaws-right').value)") > 0, run("byId('jaws-right').value"))
    tried.differs("open jaws", "typed(byId('jaws'), 'open')")
    check("as without jaws", run("frameSum()") == first and run("scene.view.jaws.length") == 0)
    run("set('Source.Beam', {kVp: 80, mAs: 1, Filter: [['Al', 2.5, 'mm']]})")
    tried.still()
    near = run("live.beam.air_kerma_ugy")
    run("set('Source.Position', [0, -900, 0, 'mm'])")
    tried.still()
    check("farther, less", abs(run("live.beam.air_kerma_ugy") / near - 0.25) < 1e-6, str(near))  # of 500 mm and 1000 mm
    tried.browser.until("doses.figures !== null && !byId('dose').hidden && doses.figures.kap_uGy_cm2 > 0")
    run("resetDoses()")
    run("set('Source.Position', [0, -910, 0, 'mm'])")
    tried.still()
    check("dose adds up", run("doses.frames >= 1 && doses.sums.kap_uGy_cm2 > 0"), run("JSON.stringify(doses)"))
    run("byId('dose-reset').click()")
    check("dose begins anew", run("doses.frames === 0 && Object.keys(doses.sums).length === 0"))
    run("set('Source.Beam', {kVp: 80})")  # whose number of photons is not known
    tried.browser.until("byId('dose').hidden")
    run("byId('reset').click()")
    tried.still()


def presets(tried, path):
    """Geometry, beam and grid of examinations, each in one step, as the verb image computes them."""
    run = tried.browser.run
    first = run("frameSum()")
    for name in json.loads(run("JSON.stringify(Object.keys(PRESETS))")):
        tried.differs(name, f"typed(byId('preset'), '{name}')")
        check("preset named", run("byId('preset').value") == name, run("byId('preset').value"))
        asked = json.loads(run("JSON.stringify(state.settings)"))
        check("two keys", sorted(asked) == ["Detector", "Source"], str(sorted(asked)))
        away = run("size(add(scene.view.centre, -1, scene.view.source))")
        check("distance", abs(away - run(f"PRESETS['{name}'].distance")) < 1e-6, f"{name}: {away}")
        words = [word for key, value in asked.items() for word in ("--set", f"{key}={json.dumps(value)}")]
        told = json.loads(subprocess.run([command, "plan", path, "--json", *words], capture_output=True, text=True, check=True).stdout)
        kerma = f"air kerma at the detector {float(format(told['open_beam']['air_kerma_uGy'], '.3g')):g} \u00b5Gy"
        check("kerma of a preset", run("byId('kerma').textContent") == kerma, f"{run('byId(`kerma`).textContent')}, not {kerma}")
        check_image(tried, path, asked)
    run("byId('reset').click()")
    tried.still()
    run("typed(byId('preset'), 'chest PA')")
    tried.still()
    place = "scene.view.source.concat(scene.view.centre).map(x => x.toFixed(6)).join()"
    # a cube of 80 mm about the origin, 50 mm before the detector
    check("from the back", run(place) == "0.000000,1710.000000,0.000000,0.000000,-90.000000,0.000000", run(place))
    run("choose('source')")
    tried.differs("movable", "typed(byId('about').querySelector('.grid input'), 30)")
    check("no preset", run("byId('preset').value") == "", run("byId('preset').value"))
    run("byId('undo').click(); byId('undo').click(); choose('')")
    tried.still()
    check("undone", run("frameSum()") == first and run("byId('preset').value") == "")
    run("window.box = scene.box; scene.box = [[-900, -900, -900], [900, 900, 900]]; typed(byId('preset'), 'hand'); scene.box = window.box")
    check("too deep", run("byId('sentence').textContent.includes('too deep for hand') && Object.keys(state.settings).length === 0"),
          run("byId('sentence').textContent"))
    run("byId('preset').value = ''")


def cut(tried):
    """A plane cuts the parts, and what is cut off is not chosen."""
    browser, run = tried.browser, tried.browser.run
    run("choose(''); canvas.focus(); lookAs('start'); meshes.forEach(m => { m.colour[3] = 1; })")
    whole = tried.view()
    for across in ("0", "1", "2", "view"):
        run(f"typed(byId('cut'), ''); if (cut.side > 0 === {'true' if across == '1' else 'false'}) byId('cut-side').click()")  # seen from -y
        tried.differs("cut " + across, f"typed(byId('cut'), '{across}')", "viewSum")
        tried.differs("place of cut " + across, "typed(byId('cut-slider'), 20)", "viewSum")
    run("typed(byId('cut'), '')")
    check("no cut", tried.view() == whole)
    run("lookAs('front')")
    middle = "partUnder(canvas.clientWidth / 2, canvas.clientHeight / 2)"
    check("the tissue is in front", run(middle) == 0)
    for _ in range(2):
        browser.key("c")
    check("across y", run("byId('cut').value === '1' && byId('cut-mm').value === '0'"), run("byId('cut').value + byId('cut-mm').value"))
    if run("cut.side") > 0:
        tried.differs("other side", "byId('cut-side').click()", "viewSum")
    check("the bone within is seen", run(middle) == 1, str(run(middle)))
    tried.differs("mm", "typed(byId('cut-mm'), 35)", "viewSum")
    check("the tissue behind the bone", run(middle) == 0)
    run("typed(byId('cut'), ''); byId('cut-side').click()")


def tape(tried):
    """Two clicks measure what lies between them."""
    browser, run = tried.browser, tried.browser.run

    def click(point):
        x, y = run(f"(() => {{ draw(); const r = canvas.getBoundingClientRect(), p = onScreen({point}); return [r.left + p[0], r.top + p[1]]; }})()")
        browser.drag(x, y, 0, 0, 0)

    def length():
        return run("(() => { draw(); return parseFloat(byId('length').textContent); })()")

    run("choose(''); canvas.focus()")
    for look in ("front", "start"):
        run(f"lookAs('{look}'); meshes.forEach(m => {{ m.colour[3] = 1; }})")
        run("byId('measure-3d').click()")
        click([-20, -40, -20])
        click([30, -40, 20])
        check("tape " + look, abs(length() - 64.03) < 1.5, str(length()))  # a pixel of the view is less than 1 mm
        # WebGL puts corners of triangles at fractions of a pixel
        check("on the face", run("tape.ends.every(end => Math.abs(placeOfEnd(end)[1] + 40) < 0.05)"), run("JSON.stringify(tape.ends)"))
        check("drawn", run("byId('tape').getBBox().width > 20 && !byId('tape').hasAttribute('hidden')"))
        check("names", run("byId('length').textContent").endswith("from tissue to tissue"), run("byId('length').textContent"))
        run("byId('measure-3d').click(); draw()")
        check("no tape", run("byId('tape').hasAttribute('hidden') && byId('length').hidden"))
    browser.key("m")
    click([0, -40, 0])
    click("scene.view.source")
    check("to the source", abs(length() - 360) < 0.5, str(length()))
    run("choose('part', 0); moveChosen(shift([0, -60, 0]))")
    tried.still()
    check("goes with the part", abs(length() - 300) < 0.5, str(length()))
    run("byId('undo').click(); choose(''); lookAs('front'); typed(byId('cut'), '1'); typed(byId('cut-mm'), -10)")
    tried.still()
    if run("cut.side") > 0:
        run("byId('cut-side').click()")
    browser.key("Enter")
    click([30, -10, 20])
    # Enter takes what is in the middle of the view: from the front the source, which comes before parts
    check("on the cut", run("tape.ends.length === 2 && tape.ends[0].kind === 'source' && Math.abs(placeOfEnd(tape.ends[1])[1] + 10) < 0.01"),
          run("JSON.stringify(tape.ends)"))
    away = run("size(add(scene.view.source, -1, [30, -10, 20]))")
    check("from the middle", abs(length() - away) < 0.5, f"{length()}, not {away}")
    browser.key("Escape")
    check("cleared", run("tape.ends.length") == 0)
    browser.key("m")
    check("off", not run("tape.on"))
    run("typed(byId('cut'), ''); lookAs('start')")


def slices(tried):
    """A slice is reconstructed, says so at once, and stays beside the next one."""
    browser, run = tried.browser, tried.browser.run
    sum_of = "(id => sumOf(byId(id).getContext('2d').getImageData(0, 0, 128, 128).data))"
    check("no slice yet", run("byId('slice-box').hidden"))
    check("no motion", run("switchOf('motion').disabled && byId('slice-why').textContent.includes('No motion: the scene does not breathe')"),
          run("byId('slice-why').textContent"))
    check("as in the scene", run("switchOf('spectrum').checked && !switchOf('noise').checked && !switchOf('scatter').checked"))
    run("byId('make-tube').click()")
    tried.still()
    check("a spectrum", run("!switchOf('spectrum').disabled"))
    check("computing", run("byId('reconstruct').click(); byId('slice-step').textContent === 'computing' && !byId('reconstruct-stop').hidden"))
    browser.until("slices.after !== null && !slices.runs")
    first = run(f"{sum_of}('slice-after')")
    check("one slice", run("!byId('slice-box').hidden && slices.before === null && byId('slice-before').parentElement.hidden"))
    check("its words", run("byId('slice-text').textContent.startsWith('4 projections of 80 x 60 pixels; voxels of ')"), run("byId('slice-text').textContent"))
    for name in ("spectrum", "noise"):
        run(f"window.last = slices.after; switchOf('{name}').click(); byId('reconstruct').click()")
        browser.until("slices.after !== window.last && !slices.runs")
        check("before is the last", run("slices.before === window.last && !byId('slice-before').parentElement.hidden"))
        check(name, run("String(slices.after.frame.numbers) !== String(slices.before.frame.numbers)"))
    check("named", run("byId('slice-after').nextElementSibling.textContent") == "after: " + run("number(slices.after.figures.mean_keV, 3)") + " keV, noise",
          run("byId('slice-after').nextElementSibling.textContent"))
    was = run(f"{sum_of}('slice-after')")
    run("typed(byId('slice-high'), 0.1)")
    check("window", run(f"{sum_of}('slice-after')") not in (was, first) and run("!slices.auto && slices.high === 0.1"))
    run("byId('slice-auto').click(); byId('slices').click()")
    check("automatic window", run(f"{sum_of}('slice-after')") == was)
    check("large", run("byId('slices').offsetWidth > 400"), str(run("byId('slices').offsetWidth")))
    run("byId('slices').click(); set('Scan.FinalAngle', 90)")
    tried.still()
    run("byId('reconstruct').click()")
    browser.until("byId('slice-step').textContent.includes('needs 180 degrees')")
    check("refused", run("!slices.runs && slices.after !== null"))
    run("byId('reset').click()")
    tried.still()


def sinogram(tried):
    """Rows of projections that were seen or asked for."""
    browser, run = tried.browser, tried.browser.run
    rows = ("(() => { drawSinogram(); const c = byId('sinogram'), d = c.getContext('2d').getImageData(0, 0, c.width, c.height);"
            " return [c.width, c.height, ...d.data]; })()")
    row_of_film = "[...pen.getImageData(0, %d, 80, 1).data]"
    run("setWindow(0, 3)")
    check("empty", run(f"{rows}.slice(2).every(x => x === 0)"))
    tried.differs("projection 1", "typed(byId('projection'), 1)")
    check("angle", run("byId('projection-text').textContent") == "1 of 4, 90\u00b0", run("byId('projection-text').textContent"))
    run("typed(byId('sinogram-row'), 30)")
    one = run(rows)
    check("one row", one[:2] == [80, 4] and one[2 + 320:2 + 640] == run(row_of_film % 30) and not any(one[2:2 + 320]), str(one[:2]))
    run("byId('sweep').click()")
    browser.until("!sinogram.sweep")
    tried.still()
    check("all projections", run("sinogram.frames.size === 4 && state.projection === 1"), run("String([...sinogram.frames.keys()])"))
    every = run(rows)
    for k in range(4):
        run(f"typed(byId('projection'), {k})")
        tried.still()
        check(f"row {k}", every[2 + 320 * k:2 + 320 * (k + 1)] == run(row_of_film % 30))
    run("typed(byId('sinogram-row'), 12)")
    other = run(rows)
    check("another row", other != every and other[2 + 960:] == run(row_of_film % 12))
    place = run("(() => { const r = film.getBoundingClientRect(); return [r.left + 0.5 * r.width, r.top + 0.51 * r.height]; })()")
    browser.mouse("mouseMoved", *place)
    check("the cursor's row", run(rows) == every)
    browser.mouse("mouseMoved", 1, 1)
    run("byId('sinogram').dispatchEvent(new MouseEvent('click', {clientX: byId('sinogram').getBoundingClientRect().left + 5,"
        " clientY: byId('sinogram').getBoundingClientRect().top + 0.6 * byId('sinogram').clientHeight}))")
    tried.still()
    check("click", run("state.projection") == 2)
    run("byId('sweep').click(); typed(byId('energy'), 80)")
    tried.still()
    check("a change ends it", run("!sinogram.sweep && sinogram.frames.size < 4"))
    run("byId('auto').click(); byId('reset').click()")
    tried.still()
