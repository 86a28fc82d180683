/* Works on a page in a real browser: $CHROMIUM, or chromium. */
#ifndef SKG_TESTS_BROWSER_H
#define SKG_TESTS_BROWSER_H

#include "cli/command.h"

#include <stdlib.h>

enum { LARGEST_PAGE = 1 << 23 };

/* A file of any size; the caller frees it. */
static inline char *read_page(const char *name) {
    char path[512], *text = calloc(LARGEST_PAGE, 1);
    snprintf(path, sizeof path, "%s/%s", folder, name);
    FILE *stream = fopen(path, "rb");
    ck_assert(stream && text);
    ck_assert_uint_lt(fread(text, 1, LARGEST_PAGE - 1, stream), LARGEST_PAGE - 1);
    fclose(stream);
    return text;
}

/* Ends the test if there is no browser. */
#define need_browser()                                                                                       \
    do {                                                                                                     \
        if (system("command -v \"${CHROMIUM:-chromium}\" >/dev/null 2>&1") != 0)                             \
            skip_test("no chromium; CHROMIUM names another browser of that kind");                           \
    } while (0)

/* Adds texts to the end of the body of a page, lets the browser work on it, and returns what the script wrote to the body's
 * attribute data-verdict. The caller frees the text.
 *
 * flags   of the browser: of its graphics and the size of its window */
static inline char *work_on_page(const char *page_name, const char *flags, int count,
                                 const char *const *texts) {
    char *page = read_page(page_name), line[1024], profile[] = "/tmp/skg-browser-XXXXXX";
    char *end = strstr(page, "</body>");
    ck_assert_ptr_nonnull(end);
    for (int i = 0; i < count; i++) {
        ck_assert_uint_lt((size_t)(end - page) + strlen(texts[i]) + 16, LARGEST_PAGE);
        end += sprintf(end, "%s", texts[i]);
    }
    strcpy(end, "</body></html>\n");
    write_text("worked.html", page);
    free(page);
    ck_assert_ptr_nonnull(mkdtemp(profile));
    snprintf(
        line, sizeof line,
        "cd %s && HOME=%s timeout 200 \"${CHROMIUM:-chromium}\" --headless --no-sandbox %s --user-data-dir=%s "
        "--virtual-time-budget=60000 --dump-dom 'file://%s/worked.html' 2>/dev/null >dom.html",
        folder, profile, flags, profile, folder);
    const int status = system(line);
    snprintf(line, sizeof line, "rm -rf %s", profile);
    ck_assert_int_eq(system(line), 0);
    ck_assert_int_eq(status, 0);
    page = read_page("dom.html");
    const char mark[] = "data-verdict=\"", *verdict = strstr(page, mark);
    ck_assert_msg(verdict != NULL, "the page's script did not end");
    verdict += sizeof mark - 1;
    char *said_there = strndup(verdict, strcspn(verdict, "\""));
    ck_assert_ptr_nonnull(said_there);
    free(page);
    return said_there;
}

#endif
