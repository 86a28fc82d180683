/* The page of the verb cost in a real browser: needs chromium. */
#include "cli/cost_scene.h"

/* Works every control of the page and leaves the verdict in an attribute of its body. */
static const char worker[] =
    "<script>\n"
    "const verdict = [], svg = document.getElementById('plot');\n"
    "const points = () => svg.querySelectorAll('.point').length;\n"
    "const check = (name, is) => { if (!is) verdict.push(name); };\n"
    "const change = (element) => element.dispatchEvent(new Event('change', {bubbles: true}));\n"
    "check('drawn', points() === study.points.filter(p => p.max_open !== null).length);\n"
    "check('half', study.points.some(p => p.max_open === null));\n"
    "check('rows', document.querySelectorAll('#rows tr').length === study.points.length);\n"
    "check('advice', document.querySelectorAll('.advice code').length >= 4);\n"
    "for (const id of ['error', 'time']) {\n"
    "  const select = document.getElementById(id), seen = new Set();\n"
    "  for (let i = 0; i < select.options.length; i++) {\n"
    "    select.selectedIndex = i; change(select); seen.add(svg.innerHTML); check(id + i, points() > 0); }\n"
    "  check(id, seen.size === select.options.length);\n"
    "  select.selectedIndex = 0; change(select); }\n"
    "for (const box of document.querySelectorAll('#dials input')) {\n"
    "  const all = points(); box.checked = false; change(box); check('hide ' + box.value, points() < all);\n"
    "  box.checked = true; change(box); check('show ' + box.value, points() === all); }\n"
    "const buttons = id => document.getElementById(id).click();\n"
    "const all = points(); buttons('none'); check('none', points() === 0);\n"
    "check('no rows', [...document.querySelectorAll('#rows tr')].every(row => getComputedStyle(row).display === 'none'));\n"
    "buttons('all'); check('all', points() === all);\n"
    "for (const id of ['log_error', 'log_time']) {\n"
    "  const box = document.getElementById(id), before = svg.innerHTML;\n"
    "  box.checked = false; change(box); check(id, points() === all && before !== svg.innerHTML);\n"
    "  check(id + ' finite', !/NaN|Infinity|undefined/.test(svg.innerHTML));\n"
    "  box.checked = true; change(box); check(id + ' back', before === svg.innerHTML); }\n"
    "document.querySelector('#rows tr').click(); const a = document.getElementById('description').textContent;\n"
    "check('row', document.querySelector('#rows tr').className === 'chosen');\n"
    "svg.querySelectorAll('.point')[1].dispatchEvent(new MouseEvent('click', {bubbles: true}));\n"
    "check('point', a !== document.getElementById('description').textContent);\n"
    "const canvas = document.getElementById('difference'), scale = document.getElementById('scale');\n"
    "const image = document.getElementById('image'), pictured = document.getElementById('pictured');\n"
    "const painted = async () => {\n"
    "  await painting; return canvas.getContext('2d').getImageData(0, 0, 33, 25).data.join(); };\n"
    "const look = async () => {\n"
    "  const seen = new Set();\n"
    "  for (let i = 0; i < pictured.options.length; i++) {\n"
    "    pictured.selectedIndex = i; change(pictured);\n"
    "    await image.decode(); seen.add(await painted());\n"
    "    check('chosen ' + i, chosen === Number(pictured.value) && canvas.width === 33 && image.naturalWidth === 33); }\n"
    "  check('pictures differ', seen.size > pictured.options.length / 2);\n"
    "  pictured.value = study.points.findIndex(p => p.dial === 'supersampling'); change(pictured);\n"
    "  const roots = await painted(); scale.value = 'straight'; change(scale);\n"
    "  check('straight', roots !== await painted()); };\n"
    "look().catch(error => verdict.push(error)).then(() =>\n"
    "  document.body.setAttribute('data-verdict', verdict.length ? 'failed: ' + verdict : 'every control works'));\n"
    "</script>\n</body>";

/* In $CHROMIUM, or chromium. At 20 mAs an image of precision half overflows, so the page also has to show an
 * error that is not finite. */
START_TEST(page_works_in_a_browser) {
    if (system("command -v \"${CHROMIUM:-chromium}\" >/dev/null 2>&1") != 0)
        skip_test("no chromium; CHROMIUM names another browser of that kind");
    ck_run(0, "cost 'small scene.json' --quick --quiet -o a.html %s --set Source.Beam.mAs=20", disc);
    char *page = read_page("a.html"), line[1024], profile[] = "/tmp/skg-browser-XXXXXX";
    char *end = strstr(page, "</body>");
    ck_assert_ptr_nonnull(end);
    ck_assert_uint_lt(strlen(page) + sizeof worker, LARGEST_PAGE);
    strcpy(end, worker);
    write_text("worked.html", page);
    free(page);
    ck_assert_ptr_nonnull(mkdtemp(profile));
    snprintf(line, sizeof line,
             "cd %s && HOME=%s timeout 100 \"${CHROMIUM:-chromium}\" --headless --no-sandbox --disable-gpu "
             "--user-data-dir=%s --virtual-time-budget=60000 --dump-dom 'file://%s/worked.html' "
             "2>/dev/null >dom.html",
             folder, profile, profile, folder);
    int status = system(line);
    snprintf(line, sizeof line, "rm -rf %s", profile);
    ck_assert_int_eq(system(line), 0);
    ck_assert_int_eq(status, 0);
    page = read_page("dom.html");
    const char *verdict = strstr(page, "<body data-verdict=\"");
    ck_assert_msg(verdict != NULL, "the page's script did not end");
    ck_assert_msg(strncmp(verdict, "<body data-verdict=\"every control works\"", 40) == 0, "%.200s", verdict);
    free(page);
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_checked_fixture(tests, set_up_scene, tear_down);
    tcase_add_test(tests, page_works_in_a_browser);
}

SKG_SUITE_MAIN("page", add_tests)
