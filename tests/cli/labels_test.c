/* Labels and names of files that other programs would take for markup, formulas, commands or paths. */
#include "cli/browser.h"

#include "common/encode.h"
#include "common/file.h"

#include <sys/stat.h>

static const char *const labels[] = {"<!--<script>",
                                     "</script>",
                                     "<script>alert(1)</script>",
                                     "<!--",
                                     "-->",
                                     "<![CDATA[",
                                     "]]>",
                                     "<img src=x onerror=alert(1)>",
                                     "<style>*{display:none}</style>",
                                     "<plaintext>",
                                     "<textarea>",
                                     "</title>",
                                     "<base href=//x>",
                                     "<svg/onload=alert(1)>",
                                     "&lt;b&gt;",
                                     "&amp;",
                                     "&#0;",
                                     "\"quoted\"",
                                     "'single'",
                                     "back\\slash",
                                     "\\u003cscript",
                                     "`id`",
                                     "$(id)",
                                     "${x}",
                                     "javascript:alert(1)",
                                     "*/ alert(1) /*",
                                     "// comment",
                                     "\"};alert(1);//",
                                     "BYTES",
                                     "\"SCENE\"",
                                     "__proto__",
                                     "constructor",
                                     "=1+1",
                                     "+1",
                                     "-1",
                                     "@SUM(A1)",
                                     "=cmd|' /C calc'!A0",
                                     "a,b;c",
                                     "tab\there",
                                     "line\nbreak",
                                     "..",
                                     "../../up",
                                     "/etc/passwd",
                                     ".hidden",
                                     "%s%n%d",
                                     "%00",
                                     "\xE2\x80\xA8separator",
                                     "\xE2\x80\xAEright to left",
                                     "\xF0\x9F\x92\x80 skull",
                                     "\xC3\xBC\xC3\x9F"};
enum { LABELS = sizeof labels / sizeof *labels };

/* A scene of small spheres with these labels, and a long one. */
static void write_scene(const char *name) {
    char path[512], longest[301];
    memset(longest, 'x', 300), longest[300] = '\0';
    json_error_t error;
    json_t *root = json_loads(
        "{\"Source\":{\"Position\":[0,-400,0,\"mm\"],\"Shape\":\"ParallelBeam\",\"Beam\":[{\"Energy\":60,\"Unit\":\"keV\","
        "\"PhotonCount\":1000}]},\"Detector\":{\"Position\":[0,100,0,\"mm\"],\"UpVector\":[0,0,-1],\"NumberOfPixels\":[33,"
        "25],\"Spacing\":[4,4,\"mm\"]}}",
        0, &error);
    json_t *samples = json_array();
    for (int i = 0; i <= LABELS; i++)
        json_array_append_new(samples, json_pack("{s:s,s:[i,f,s],s:[[s,f,f,f,s]],s:[s,f]}", "Label",
                                                 i < LABELS ? labels[i] : longest, "Sphere", 6, 2.0, "mm",
                                                 "Transform", "Translation", 5.0 * (i % 10) - 25, 0.0,
                                                 5.0 * (i / 10) - 15.0, "mm", "Material", "mu", 0.2));
    json_object_set_new(root, "Samples", samples);
    snprintf(path, sizeof path, "%s/%s", folder, name);
    ck_assert_int_eq(json_dump_file(root, path, 0), 0);
    json_decref(root);
}

static int count_of(const char *text, const char *word) {
    int count = 0;
    for (const char *at = text; (at = strstr(at, word)); at++) count++;
    return count;
}

/* A page has the scripts of its template and no others, and no comment. */
static void ck_scripts(const char *name, const char *template_path) {
    char *page = read_page(name), *text = calloc(LARGEST_PAGE, 1);
    FILE *stream = fopen(template_path, "rb");
    ck_assert(stream && text && fread(text, 1, LARGEST_PAGE - 1, stream) > 0);
    fclose(stream);
    ck_assert_ptr_null(strstr(page, "<!--"));
    ck_assert_int_eq(count_of(page, "<script"), count_of(text, "<script"));
    ck_assert_int_eq(count_of(page, "</script"), count_of(text, "</script"));
    free(text);
    free(page);
}

/* An array of the labels for a script of the page; the caller frees it. */
static char *expected(void) {
    json_t *list = json_array();
    for (int i = 0; i < LABELS; i++) json_array_append_new(list, json_string(labels[i]));
    char *text = json_dumps(list, JSON_ENSURE_ASCII | JSON_ESCAPE_SLASH),
         *safe = calloc(6 * strlen(text) + 1, 1);
    char *to = safe;
    for (const char *c = text; *c; c++) to += sprintf(to, *c == '<' ? "\\u003c" : "%c", *c);
    json_decref(list);
    free(text);
    return safe;
}

START_TEST(the_page_of_view_shows_every_label) {
    write_scene("s.json");
    ck_run(0, "view s.json -o a.html --quiet");
    ck_scripts("a.html", SKG_SOURCE "/host/cli/view/page/page.html");
    need_browser();
    char *list = expected();
    const char *const texts[] = {
        "<script>const wanted = ", list,
        ";\nconst bad = wanted.filter((l, i) => scene.parts[i].label !== l || !rows[i].textContent.includes(l));\n"
        "document.body.setAttribute('data-verdict', bad.length ? 'failed: ' + encodeURIComponent(bad.join(' and ')) : 'all "
        "there'); </script>\n"};
    char *verdict = work_on_page(
        "a.html", "--use-gl=angle --use-angle=swiftshader --enable-unsafe-swiftshader --window-size=900,600",
        3, texts);
    ck_assert_msg(strcmp(verdict, "all there") == 0, "%.600s", verdict);
    free(verdict);
    free(list);
}
END_TEST

/* The name of the scene is a text of this page. */
START_TEST(the_page_of_cost_shows_the_name_of_its_scene) {
    static const char *const names[] = {"<!--<script>.json", "</script>&amp;'$(id)`id`.json"};
    char path[512];
    snprintf(path, sizeof path, "%s/%s", folder, "<");
    ck_assert_int_eq(mkdir(path, 0777), 0); /* of the second name */
    write_scene(names[0]);
    write_scene(names[1]);
    for (int n = 0; n < 2; n++) {
        ck_run(0, n == 0
                      ? "cost '<!--<script>.json' --quick --within 20 --quiet -o a.html"
                      : "cost '</script>&amp;'\"'\"'$(id)`id`.json' --quick --within 20 --quiet -o a.html");
        ck_scripts("a.html", SKG_SOURCE "/host/cli/cost/page/page.html");
        need_browser();
        const char *const texts[] = {
            "<script>const wanted = ",
            n == 0 ? "'\\u003c!--\\u003cscript>.json'" : "'\\u003c/script>&amp;\\'$(id)`id`.json'",
            ";\ndocument.body.setAttribute('data-verdict', study.scene.includes(wanted) && byId('scene').textContent.includes("
            "wanted) && study.settings.every(s => s.command) ? 'all there' : 'failed: ' + encodeURIComponent(study.scene));"
            "</script>\n"};
        char *verdict = work_on_page("a.html", "--disable-gpu --window-size=1280,1000", 3, texts);
        ck_assert_msg(strcmp(verdict, "all there") == 0, "%.600s", verdict);
        free(verdict);
    }
    snprintf(path, sizeof path, "%s/%s", folder, names[1]);
    ck_assert_int_eq(unlink(path), 0);
    snprintf(path, sizeof path, "%s/<", folder);
    ck_assert_int_eq(rmdir(path), 0);
}
END_TEST

/* Reads the cell back as a program would, and as a spreadsheet would. */
START_TEST(no_cell_begins_a_formula) {
    for (int i = 0; i < LABELS; i++) {
        char *text = NULL, back[400], *to = back;
        size_t size = 0;
        FILE *stream = open_memstream(&text, &size);
        cli_csv_text(labels[i], stream);
        fclose(stream);
        ck_assert(size >= 2 && text[0] == '"' && text[size - 1] == '"');
        for (const char *c = text + 1; c < text + size - 1; c++) {
            if (*c == '"') ck_assert_int_eq(*++c, '"');
            *to++ = *c;
        }
        *to = '\0';
        ck_assert_msg(!strchr("=+-@|", back[strspn(back, " \t\r\n")]) || !*back, "%s begins a formula", back);
        ck_assert_str_eq(back + (back[0] == '\'' && labels[i][0] != '\''), labels[i]);
        free(text);
    }
}
END_TEST

/* Each label gives a name of its own within the folder. */
START_TEST(names_of_files_stay_in_their_folder) {
    char names[LABELS + 1][CLI_NAME_OF_PART], longest[301];
    memset(longest, 'x', 300), longest[300] = '\0';
    for (int i = 0; i <= LABELS; i++) {
        cli_name_of_part(i < LABELS ? labels[i] : longest, i, names[i]);
        ck_assert_msg(!strchr(names[i], '/') && names[i][0] != '.' && names[i][0], "%s", names[i]);
        ck_assert_uint_le(strlen(names[i]),
                          140); /* with an ending and the mark of an unfinished file below 255 */
        for (const char *c = names[i]; *c; c++) ck_assert((unsigned char)*c >= ' ' && *c != 127);
        for (int k = 0; k < i; k++) ck_assert_str_ne(names[i], names[k]);
    }
    cli_name_of_part("rib 8 left", 3, names[0]);
    ck_assert_str_eq(names[0], "rib-8-left");
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_checked_fixture(tests, set_up, tear_down);
    tcase_add_test(tests, the_page_of_view_shows_every_label);
    tcase_add_test(tests, the_page_of_cost_shows_the_name_of_its_scene);
    tcase_add_test(tests, no_cell_begins_a_formula);
    tcase_add_test(tests, names_of_files_stay_in_their_folder);
}

SKG_SUITE_MAIN("labels", add_tests)
