/* The page of the verb cost in a real browser: needs chromium. */
#include "cli/cost_scene.h"

/* Works every control of the page and leaves the verdict in an attribute of its body. A setting shows in four places, which
 * have to change together: the pixels of image and difference, the numbers, the command, the sliders' words. */
static const char worker[] =
    "<script>\n"
    "const verdict = [], svg = byId('plot'), canvas = byId('difference'), text = id => byId(id).textContent;\n"
    "const check = (name, is) => { if (!is) verdict.push(name); };\n"
    "const fire = (element, kind) => element.dispatchEvent(new Event(kind, {bubbles: true}));\n"
    "const press = (k, element = document.body) => element.dispatchEvent(new KeyboardEvent('keydown', {key: k, bubbles: true}));\n"
    "const marks = () => svg.querySelectorAll('.point').length;\n"
    "const ring = () => Number(svg.querySelector('.ring')?.closest('.point').dataset.index);\n"
    /* everything that a setting changes, and whether it is what the study says */
    "const seen = async () => {\n"
    "  await painting;\n"
    "  if (!byId('image').complete) await new Promise(done => byId('image').addEventListener('load', done, {once: true}));\n"
    "  const s = study.settings[chosen];\n"
    "  check('command of ' + chosen, text('command') === s.command);\n"
    "  check('numbers of ' + chosen, text('numbers').startsWith(price(s.price)) && text('numbers').includes(percent(s.rms)));\n"
    "  check('ring of ' + chosen, ring() === chosen);\n"
    "  check('scale of ' + chosen, text('ends').includes('+' + percent(source >= 0 ? study.sources[source].range : s.range)));\n"
    "  check('size of ' + chosen, canvas.width === 33 && byId('image').naturalWidth === 33);\n"
    "  return {command: text('command'), numbers: text('numbers'), accepted: text('accepted'), had: text('had'), image: byId('image').src,\n"
    "    difference: canvas.getContext('2d').getImageData(0, 0, 33, 25).data.join()}; };\n"
    "const slides = async id => {\n"
    "  const slider = byId(id), all = [];\n"
    "  for (let v = 0; v <= Number(slider.max); v++) { slider.value = v; fire(slider, 'input'); all.push(await seen());\n"
    "    const s = study.settings[chosen], words = all[v].accepted + ', ' + all[v].had; /* rounded, so that two may be alike */\n"
    "    check(id + ' words', words === percent(s.rms) + ', ' + price({ms: s.price.ms, uncertainty: 0}));\n"
    "    check(id + ' stays', Number(slider.value) === v); check('best ' + v, study.settings[chosen].best); }\n"
    "  for (const key of ['command', 'difference']) check(id + ' ' + key, new Set(all.map(a => a[key])).size === all.length);\n"
    "  check(id + ' pictures', new Set(all.map(a => a.image)).size > 1);\n"
    "  return all.map((_, v) => { slider.value = v; fire(slider, 'input'); return study.settings[chosen]; }); };\n"
    "async function work() {\n"
    "  check('summary', text('summary').startsWith('This scene: ') && text('summary').includes('Largest error: '));\n"
    "  check('starts here', chosen === study.here && text('name') === 'This scene');\n"
    "  check('sane', !/NaN|Infinity|undefined/.test(document.body.innerText + svg.innerHTML));\n"
    "  check('marks', marks() === study.settings.filter(s => s.rms !== null).length);\n"
    "  check('you are here', svg.textContent.includes('you are here') && svg.querySelector('#frontier'));\n"
    "  check('second scale', svg.textContent.includes('grey levels') && !svg.textContent.includes('sigma'));\n"
    "  const accept = await slides('accept'), have = await slides('have');\n"
    "  check('several', have.length > 2 && accept.length === have.length);\n"
    "  for (let i = 1; i < have.length; i++) {\n"
    "    check('more time, less error', have[i].price.ms > have[i - 1].price.ms && have[i].rms < have[i - 1].rms);\n"
    "    check('more error, less time', accept[i].rms > accept[i - 1].rms && accept[i].price.ms < accept[i - 1].price.ms); }\n"
    "  byId('home').click(); const home = await seen(); check('home', chosen === study.here);\n"
    "  if (study.buy !== null) { byId('show-buy').click(); const buy = await seen();\n"
    "    check('buy', chosen === study.buy && buy.command !== home.command && buy.difference !== home.difference); }\n"
    "  press('h'); check('key h', chosen === study.here);\n"
    "  press('b'); check('key b', chosen === (study.buy ?? study.here)); press('h');\n"
    "  press('e'); check('key e', document.activeElement === byId('accept')); press('t'); check('key t', document.activeElement === byId('have'));\n"
    "  const before = chosen; press('ArrowRight', svg); check('right', chosen !== before); await seen();\n"
    "  press('ArrowLeft', svg); check('left', chosen === before);\n"
    "  const point = [...svg.querySelectorAll('.point')].find(p => study.settings[p.dataset.index].difference && Number(p.dataset.index) !== chosen);\n"
    "  point.dispatchEvent(new MouseEvent('click', {bubbles: true})); check('click', chosen === Number(point.dataset.index)); await seen();\n"
    "  const bare = study.settings.findIndex(s => s.rms !== null && !s.difference); if (bare >= 0) choose(bare);\n"
    "  check('no picture', bare < 0 || (byId('pictures').hidden && !byId('missing').hidden && ring() === bare && text('command') === study.settings[bare].command));\n"
    "  const shown = svg.innerHTML; byId('error').value = 'max'; fire(byId('error'), 'change'); check('largest', svg.innerHTML !== shown);\n"
    "  byId('error').value = 'rms'; fire(byId('error'), 'change'); check('and back', svg.innerHTML === shown);\n"
    "  byId('home').click(); const whole = await seen();\n"
    "  for (const track of document.querySelectorAll('[data-source]')) {\n"
    "    track.click(); const alone = await seen(), its = study.sources[track.dataset.source];\n"
    "    check('where ' + its.name, source === Number(track.dataset.source) && alone.difference !== whole.difference && text('caption').includes(its.name)); }\n"
    "  check('hatched', document.querySelectorAll('.unknown').length === study.sources.filter(s => s.error === null).length);\n"
    "  check('scatter has a bar', text('bars').includes('scatter'));\n"
    "  let said = ''; const put = document.execCommand.bind(document);\n"
    "  Object.defineProperty(navigator, 'clipboard', {value: {writeText: async t => { said = t; }}, configurable: true});\n"
    "  for (const button of document.querySelectorAll('#bars [data-copy], #advice [data-copy], #copy')) {\n"
    "    said = ''; button.click(); await 0; check('copy', said === (button.dataset.copy || text('command')) && said.startsWith('skiagraph image')); }\n"
    "  said = ''; press('c'); await 0; check('key c', said === text('command'));\n"
    "  check('advice', document.querySelectorAll('#advice tbody tr').length === 4);\n"
    "  check('reasons', study.advice.every((a, i) => a.reason === null || document.querySelectorAll('#advice tbody tr')[i].textContent.includes(a.reason)));\n"
    "  check('rows', document.querySelectorAll('#rows tr').length === study.points.length && byId('models').hidden);\n"
    "  document.querySelector('#rows tr').click(); check('row', document.querySelector('#rows tr').className === 'chosen');\n"
    "  const ground = () => getComputedStyle(document.body).backgroundColor, light = ground(); byId('dark').click();\n"
    "  check('dark', ground() !== light); press('d'); check('light', ground() === light); }\n"
    "work().catch(error => verdict.push(error.stack)).then(() =>\n"
    "  document.body.setAttribute('data-verdict', verdict.length ? 'failed: ' + verdict.join('; ') : 'every control works'));\n"
    "</script>\n";

/* At 20 mAs an image of precision half overflows, so the page also has to show an error that is not finite. */
START_TEST(page_works_in_a_browser) {
    static const char *const texts[] = {worker};
    need_browser();
    ck_run(0, "cost 'small scene.json' --quick --within 3600 --quiet -o a.html %s --set Source.Beam.mAs=20",
           disc);
    char *verdict = work_on_page("a.html", "--disable-gpu --window-size=1280,1000", 1, texts);
    ck_assert_msg(strcmp(verdict, "every control works") == 0, "%.900s", verdict);
    free(verdict);
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_checked_fixture(tests, set_up_scene, tear_down);
    tcase_add_test(tests, page_works_in_a_browser);
}

SKG_SUITE_MAIN("page", add_tests)
