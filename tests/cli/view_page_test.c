/* The page of the verb view in a real browser, with WebGL in software: needs chromium. */
#include "cli/browser.h"

/* A cube with a cylinder in it, 400 mm from a point source, the detector 100 mm behind. */
static const char scene[] =
    "{\"Source\": {\"Position\": [0, -40, 0, \"cm\"], \"Shape\": \"PointSource\","
    "\"Beam\": [{\"Energy\": 60, \"Unit\": \"keV\", \"PhotonCount\": 1000}]},"
    "\"Detector\": {\"Position\": [0, 10, 0, \"cm\"], \"UpVector\": [0, 0, -1], \"NumberOfPixels\": [33, 25],"
    "\"Size\": [33, 25, \"cm\"]},"
    "\"Samples\": [{\"Label\": \"tissue\", \"Cube\": [80, \"mm\"], \"Material\": [\"mu\", 0.2], \"Type\": \"outer\"},"
    "{\"Label\": \"bone\", \"Cylinder\": [32, 60, 12, \"mm\"], \"Material\": [\"mu\", 0.5]}]}";

/* First and last lines of both scripts: the verdict becomes an attribute of the body. */
static const char begin_script[] =
    "<script>\n"
    "const verdict = [], check = (name, is) => { if (!is) verdict.push(name); };\n"
    "const width = () => canvas.width, height = () => canvas.height;\n"
    "const pixels = () => { resize(); draw(); const p = new Uint8Array(4 * width() * height());\n"
    "  gl.readPixels(0, 0, width(), height(), gl.RGBA, gl.UNSIGNED_BYTE, p); return p; };\n"
    "const sum = () => { let s = 7; for (const x of pixels()) s = (Math.imul(s, 31) + x) | 0; return s; };\n"
    "const differs = (name, act) => { const old = sum(); act(); check(name, sum() !== old); };\n"
    "const fire = (kind, x, y, more = {}) => canvas.dispatchEvent(new PointerEvent(kind, {pointerId: 1, clientX: x, clientY: y,\n"
    "  bubbles: true, cancelable: true, button: 0, buttons: kind === 'pointerup' ? 0 : 1, ...more}));\n"
    "const drag = (x, y, dx, dy, more) => { fire('pointerdown', x, y, more); fire('pointermove', x + dx, y + dy, more);\n"
    "  fire('pointerup', x + dx, y + dy, more); };\n"
    "const key = (k, more = {}) => canvas.dispatchEvent(new KeyboardEvent('keydown', {key: k, bubbles: true, ...more}));\n"
    "canvas.setPointerCapture = () => {};\n"
    "const seen = p => place(shot.m, p, canvas.clientWidth, canvas.clientHeight);\n"
    /* from the source, without parts and beam, the pixels of the detector are those of the image, and left is left; at: a place by shares of
     * width and height */
    "const sameImage = at => { const kept = [lines, points]; lines = points = []; lookAs('source');\n"
    "  const image = scene.image, p = pixels(), bad = [];\n"
    "  for (let r = 2; r < image.rows - 2; r++) for (let c = 2; c < image.columns - 2; c++) {\n"
    "    const [x, y] = seen(at((c + 0.5) / image.columns, (r + 0.5) / image.rows)).map(q => q * width() / canvas.clientWidth);\n"
    "    const grey = p[4 * (Math.floor(height() - y) * width() + Math.floor(x))];\n"
    "    if (grey !== bytes[image.at + r * image.columns + c]) bad.push([r, c]); }\n"
    "  check('image ' + bad.slice(0, 5), bad.length === 0); [lines, points] = kept; };\n"
    "function work() {\n"
    "if (!gl) return verdict.push('no WebGL');\n"
    "check('error', byId('failure').hidden);\n"
    "const first = sum(); check('again', first === sum()); check('drawn', new Set(pixels()).size > 50);\n";

static const char end_script[] =
    "check('no error of WebGL', gl.getError() === 0);\n"
    "}\n"
    "try { work(); } catch (error) { verdict.push(error.stack); }\n"
    "document.body.setAttribute('data-verdict', verdict.length ? 'failed: ' + verdict : 'all works');\n"
    "</script>\n";

/* Camera, list, names, the detector's image. */
static const char still_script[] =
    "for (const [name, act] of [\n"
    "  ['turn', () => drag(200, 200, 60, 20)], ['move', () => drag(200, 200, 40, 10, {shiftKey: true})],\n"
    "  ['move by the right button', () => drag(200, 200, 40, 10, {button: 2, buttons: 2})],\n"
    "  ['roll', () => canvas.dispatchEvent(new WheelEvent('wheel', {deltaY: -120, cancelable: true}))],\n"
    "  ['left', () => key('ArrowLeft')], ['up', () => key('ArrowUp')], ['shift', () => key('ArrowUp', {shiftKey: true})],\n"
    "  ['plus', () => key('+')], ['minus', () => key('-')], ['parallel', () => key('p')], ['fit', () => key('f')]])\n"
    "  differs(name, act);\n"
    "key('p'); key('0'); check('start', sum() === first);\n"
    "const views = new Set([first]);\n"
    "for (const name of ['front', 'side', 'top', 'source']) {\n"
    "  document.querySelector('[data-look=' + name + ']').click(); views.add(sum()); }\n"
    "check('views', views.size >= 4);\n" /* the front may be that of the source */
    "fire('pointerdown', 100, 100); fire('pointerdown', 200, 100, {pointerId: 2});\n"
    "differs('pinch', () => fire('pointermove', 260, 100, {pointerId: 2}));\n"
    "fire('pointerup', 100, 100); fire('pointerup', 260, 100, {pointerId: 2}); key('0');\n"
    "rows.forEach((row, i) => { const box = row.firstChild; differs('hide ' + i, () => box.click()); box.click(); });\n"
    "check('shown again', sum() === first);\n"
    "check('box of the cube', scene.parts[0].low.every(x => Math.abs(x + 40) < 1e-6)\n"
    "  && meshes[0].high.every(x => Math.abs(x - 40) < 1e-6));\n" /* 65535 steps of a double */
    "const v0 = scene.view, centre = seen([0, 0, 0]), edge = seen([-38, -38, 38]);\n"
    "check('bone', partAt(...centre) === 1); check('tissue', partAt(...edge) === 0); check('none', partAt(2, 2) === -1);\n"
    "pointAt(...centre); check('hint', !byId('hint').hidden && byId('hint').textContent === 'bone');\n"
    "check('under', rows[1].className === 'under'); pointAt(2, 2); check('no hint', byId('hint').hidden);\n"
    "const rect = canvas.getBoundingClientRect();\n"
    "differs('click', () => drag(rect.left + centre[0], rect.top + centre[1], 0, 0));\n"
    "check('chosen', shot.chosen === 1 && rows[1].className === 'chosen' && byId('about').textContent.includes('bone'));\n"
    "const slider = byId('about').querySelector('input'); slider.value = 0.3;\n"
    "differs('opacity', () => slider.oninput()); slider.value = 1; slider.oninput();\n"
    "key('Escape'); check('none chosen', shot.chosen === -1 && sum() === first);\n"
    "byId('filter').value = 'BO'; byId('filter').oninput(); check('filter', rows[0].hidden && !rows[1].hidden);\n"
    "byId('none').click(); check('only the found', meshes[0].visible && !meshes[1].visible); byId('all').click();\n"
    "byId('filter').value = ''; byId('filter').oninput(); byId('none').click();\n"
    "check('distances', byId('measures').textContent.includes('500 mm') && byId('measures').textContent.includes('1.25'));\n"
    "check('field', v0.field.every((p, i) => p.every((x, k) => Math.abs(x - v0.strips[i % 3 ? 1 : 0][i < 2 ? 0 : 1][k]) < 1e-9)) && v0.jaws.length === 0);\n"
    "check('loaded', byId('loading').hidden);\n"
    "key('?'); check('keys', byId('key-list').open && byId('key-list').textContent.includes('hide the chosen part')); key('?');\n"
    "check('no keys', !byId('key-list').open);\n"
    "const shown = id => getComputedStyle(byId(id)).display !== 'none', wheel = () => canvas.dispatchEvent(\n"
    "  new WheelEvent('wheel', {deltaY: -120, cancelable: true}));\n"
    "canvas.blur(); key('0'); const before = sum(); setBare(true); check('bare', !shown('buttons') && !shown('labels') && canvas.clientWidth === innerWidth);\n"
    "const alone = sum(); wheel(); check('the wheel is the outer page\\'s', sum() === alone);\n"
    "canvas.focus(); differs('wheel', wheel); setBare(false); key('0'); check('as before', sum() === before);\n"
    "check('labels', [...document.querySelectorAll('.label')].some(l => l.textContent === 'detector at 500 mm'));\n"
    "const v = v0, low = v.strips[0], high = v.strips[1];\n"
    "sameImage((across, down) => low[0].map((x, k) => x + across * (high[0][k] - x) + down * (low[1][k] - x)));\n"
    "differs('no beam', () => key('m')); key('m'); byId('all').click();\n"
    "key('0'); const ground = pixels()[0]; darken(!document.documentElement.classList.contains('dark'));\n"
    "check('dark', Math.abs(pixels()[0] - ground) > 100);\n"
    "check('panel', (key('l'), getComputedStyle(document.querySelector('aside')).display === 'none'));\n";

/* A detector on a cylinder of 500 mm about the source, with 33 columns of 10 mm: 33 / 50 along its arc. */
static const char curved_script[] =
    "const v = scene.view, far = p => Math.hypot(p[0], p[1] + 400), near = (a, b) => Math.abs(a - b) < 1e-6;\n"
    "check('strips', v.strips.length === 24 && v.strips.every(s => s.every(p => near(far(p), 500) && near(Math.abs(p[2]), 125))));\n"
    "const angle = p => Math.atan2(p[0], p[1] + 400), edge = angle(v.strips[0][0]), all = angle(v.strips[23][0]) - edge;\n"
    "check('arc', near(Math.abs(all), 0.66) && v.strips.every((s, i) => near(angle(s[0]), edge + all * i / 23)));\n"
    "check('steps', near(size(v.steps[0]), 10) && near(size(v.steps[1]), 10));\n"
    "byId('none').click();\n"
    "sameImage((across, down) => [500 * Math.sin(edge + across * all), 500 * Math.cos(edge + across * all) - 400,\n"
    "  v.strips[0][0][2] + down * (v.strips[0][1][2] - v.strips[0][0][2])]);\n";

/* Breath: time moves the parts, and comes round. */
static const char moving_script[] =
    "check('time', !byId('time').hidden); play(false); setTime(0); const start = sum();\n"
    "differs('half', () => setTime(0.5)); setTime(1); check('round', sum() === start);\n"
    "differs('between key frames', () => setTime(0.02));\n"
    "byId('moment').value = 0.25; differs('slider', () => byId('moment').oninput()); check('stopped', !playing);\n"
    "check('says the time', byId('now').textContent === '1.00 s of 4 s'); key(' '); check('plays', playing);\n"
    "const liver = scene.parts.find(q => q.label === 'liver'), ofFrame = f => positionsOf(liver)\n"
    "  .subarray(3 * liver.vertices * f, 3 * liver.vertices * (f + 1)).filter((_, i) => i % 3 === 2);\n"
    "const mean = f => ofFrame(f).reduce((s, x) => s + x, 0) / liver.vertices * liver.step[2];\n"
    "check('rounded by less than .03 mm', liver.unit.every((u, k) => u >= 1 && u * liver.step[k] < 0.06));\n"
    "const all = positionsOf(liver), count = 3 * liver.vertices, most = k => all.reduce((m, x, i) => i % 3 === k && i >= count ?\n"
    "  Math.max(m, Math.abs(x - all[i - count])) : m, 0);\n"
    "check('8 bits are used', [0, 1, 2].some(k => most(k) > 100 * liver.unit[k]));\n"
    "check('the liver goes down', mean(10) - mean(0) > 8);\n"; /* mm, from inspiration to expiration; breathe_test */

/* Colours by sensitivity: the tissue changes the image more than the bone in it, and comes first. */
static const char sensitive_script[] =
    "const swatch = i => rows[i].querySelector('.swatch').style.background, button = byId('sensitive');\n"
    "check('shown', !byId('legend').hidden && !byId('scale').hidden && !button.hidden && isColoured());\n"
    "check('order', byId('list').firstChild === rows[0] && rows[0].nextSibling === rows[1]);\n"
    "const its = scene.sensitivity.parts; check('largest first', its[0].part === 'tissue' && its[0].largest > its[1].largest);\n"
    "rows.forEach((row, i) => check('number ' + i, row.querySelector('.change').textContent === percent(changeOf(i).largest)));\n"
    "check('ends', byId('ends').firstChild.textContent === percent(its[1].largest) && byId('ends').lastChild.textContent === percent(its[0].largest));\n"
    "check('middle', Math.abs(levelOf(Math.sqrt(its[0].largest * its[1].largest)) - 0.5) < 1e-9);\n"
    "check('colours', String(meshes.map(m => m.colour.slice(0, 3).map(x => Math.round(255 * x)))) === '253,231,37,59,82,139');\n"
    "check('swatch', swatch(0) === 'rgb(253, 231, 37)' && swatch(1) === 'rgb(59, 82, 139)');\n"
    "const opacity = meshes.map(m => m.colour[3]);\n"
    "differs('by density', () => button.click()); check('off', !isColoured() && byId('scale').hidden);\n"
    "check('own colours', meshes.every((m, i) => m.colour.every((x, k) => Math.abs(255 * x - scene.parts[i].colour[k]) < 1e-9)));\n"
    "key('s'); check('on again', sum() === first && String(meshes.map(m => m.colour[3])) === String(opacity));\n"
    "setChosen(1); check('chosen', byId('about').textContent.includes('for a mm' + percent(changeOf(1).largest))); setChosen(-1);\n"
    "darken(true); check('dark', sum() !== first && meshes[0].colour[0] === 253 / 255);\n";

/* A part that has no derivative: the reason, and the colours of other pages. */
static const char insensitive_script[] =
    "check('reason', !byId('legend').hidden && byId('notes').textContent.includes('the mesh of part open is not closed'));\n"
    "check('no scale', byId('scale').hidden && byId('sensitive').hidden && !isColoured());\n"
    "check('own colours', meshes.every((m, i) => m.colour.every((x, k) => Math.abs(255 * x - scene.parts[i].colour[k]) < 1e-9)));\n"
    "check('no numbers', !document.querySelector('.change')); key('s'); check('no key', sum() === first);\n";

/* Adds the script to a.html and lets the browser work on it. Returns 0 if the browser has no WebGL 2. */
static int work(const char *script) {
    const char *const texts[] = {begin_script, script, end_script};
    char *verdict = work_on_page(
        "a.html", "--use-gl=angle --use-angle=swiftshader --enable-unsafe-swiftshader --window-size=900,600",
        3, texts);
    const int drawn = strcmp(verdict, "failed: no WebGL") != 0;
    ck_assert_msg(!drawn || strcmp(verdict, "all works") == 0, "%.600s", verdict);
    free(verdict);
    return drawn;
}

START_TEST(a_page_can_be_turned) {
    need_browser();
    write_text("s.json", scene);
    ck_run(0, "view s.json -o a.html --quiet");
    if (!work(still_script)) skip_test("the browser has no WebGL 2");
}
END_TEST

START_TEST(a_page_shows_sensitivity) {
    need_browser();
    write_text("s.json", scene);
    ck_run(0, "view s.json --sensitivity -o a.html --quiet");
    if (!work(sensitive_script)) skip_test("the browser has no WebGL 2");
    write_text("open.obj", "v -9 -9 -9\nv 9 -9 -9\nv 0 9 -9\nv 0 0 9\nf 1 3 2\nf 1 2 4\nf 2 3 4\n");
    ck_run(
        0,
        "view s.json --sensitivity -o a.html --quiet --set 'Samples.bone={\"Label\":\"open\",\"Path\":\"open.obj\","
        "\"Unit\":\"mm\",\"Material\":[\"mu\",0.3]}'");
    if (!work(insensitive_script)) skip_test("the browser has no WebGL 2");
}
END_TEST

START_TEST(a_curved_detector_is_drawn_curved) {
    need_browser();
    write_text("s.json", scene);
    ck_run(0, "view s.json -o a.html --quiet --set 'Detector.Curved={\"Radius\":[500,\"mm\"]}'");
    if (!work(curved_script)) skip_test("the browser has no WebGL 2");
}
END_TEST

/* A page without --sensitivity has no legend, and the list in the order of the scene. */
START_TEST(a_page_without_sensitivity) {
    need_browser();
    write_text("s.json", scene);
    ck_run(0, "view s.json -o a.html --quiet");
    if (!work(
            "check('none', byId('legend').hidden && byId('sensitive').hidden && !isColoured() && !('sensitivity' in scene));\n"
            "check('order', byId('list').firstChild === rows[0]);\n"))
        skip_test("the browser has no WebGL 2");
}
END_TEST

START_TEST(a_page_breathes) {
    need_browser();
    ck_run(0, "thorax -o . --simple --triangles 10000 --quiet");
    ck_run(
        0,
        "view thorax.json --set Breathing=null --seconds 4 --set Detector.NumberOfPixels=[80,80] -o a.html --quiet");
    if (!work(moving_script)) skip_test("the browser has no WebGL 2");
}
END_TEST

/* A part that jumps keeps its shape: the distances between its vertices. */
static const char jumping_script[] =
    "const part = scene.parts.find(q => q.label === 'needle'), count = 3 * part.vertices, all = positionsOf(part);\n"
    "check('jumps', part.jumps && scene.parts.some(q => q.frames > 1 && !q.jumps));\n"
    "const at = (f, i) => all[f * count + i] * part.step[i % 3], moved = f => [0, 1, 2].map(k => at(f, k) - at(0, k));\n"
    "const far = (f, v) => size([0, 1, 2].map(k => at(f, 3 * v + k) - at(f, k))); // from the first vertex\n"
    "const off = f => { let most = 0;\n"
    "  for (let v = 0; v < part.vertices; v++) most = Math.max(most, Math.abs(far(f, v) - far(0, v)));\n"
    "  return most; };\n"
    "const last = part.frames - 1; check('it has moved', size(moved(last)) > 100, String(moved(last)));\n"
    "check('a shape as it was', off(last) < 4 * Math.max(...part.step), String(off(last)));\n"; /* four roundings of 16 bits */

START_TEST(a_part_jumps) {
    need_browser();
    ck_run(0, "thorax -o . --triangles 10000 --quiet");
    ck_run(0, "view thorax.json --set Breathing.Events='[{\"Needle\":[[0.3,-20],[0.301,110]]}]' --seconds 1 "
              "--set Detector.NumberOfPixels=[80,80] -o a.html --quiet");
    if (!work(jumping_script)) skip_test("the browser has no WebGL 2");
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_checked_fixture(tests, set_up, tear_down);
    tcase_add_test(tests, a_page_can_be_turned);
    tcase_add_test(tests, a_page_shows_sensitivity);
    tcase_add_test(tests, a_page_without_sensitivity);
    tcase_add_test(tests, a_curved_detector_is_drawn_curved);
    tcase_add_test(tests, a_page_breathes);
    tcase_add_test(tests, a_part_jumps);
}

SKG_SUITE_MAIN("view_page", add_tests)
