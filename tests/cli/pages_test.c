/* The man pages and the completion of shells hold every verb and every flag of the help, and the command
 * takes these flags. */
#include "cli/command.h"

enum { LIMIT = 32 };

static char verbs[LIMIT][32], flags[LIMIT][32];
static int verb_count, flag_count;

/* The first words of the lines of a help text that begin with two spaces, from a heading to the next empty
 * line. */
static int read_names(const char *heading, char names[LIMIT][32]) {
    char *at = strstr(said, heading);
    int count = 0;
    ck_assert_ptr_nonnull(at);
    at = strchr(at, '\n') + 1;
    for (char *end; *at != '\n' && (end = strchr(at, '\n')); at = end + 1)
        if (at[0] == ' ' && at[1] == ' ' && at[2] != ' ') {
            ck_assert_int_lt(count, LIMIT);
            ck_assert_int_eq(sscanf(at + 2, "%31s", names[count++]), 1);
        }
    return count;
}

static void read_verbs(void) {
    ck_run(0, "help");
    verb_count = read_names("verbs:\n", verbs);
    ck_assert_int_ge(verb_count, 12);
}

/* Flags of a verb; 0: it is help or version, which take none. */
static int read_flags(const char *verb) {
    flag_count = 0;
    if (strcmp(verb, "help") == 0 || strcmp(verb, "version") == 0) return 0;
    ck_run(0, "help %s", verb);
    flag_count = read_names("flags:\n", flags);
    ck_assert_int_ge(flag_count, 3);
    return 1;
}

static const char *read_page(const char *name) {
    static char page[65536];
    char path[512];
    snprintf(path, sizeof path, "%s/%s", SKG_PAGES, name);
    FILE *stream = fopen(path, "rb");
    ck_assert_msg(stream != NULL, "%s is not there", path);
    page[fread(page, 1, sizeof page - 1, stream)] = '\0';
    fclose(stream);
    return page;
}

/* "--repeat" as roff has it: "\fB\-\-repeat\fR". */
static void write_roff(const char *flag, char *text) {
    text += sprintf(text, "\\fB");
    for (; *flag; flag++) text += sprintf(text, *flag == '-' ? "\\-" : "%c", *flag);
    strcpy(text, "\\fR");
}

START_TEST(man_pages_hold_every_verb_and_flag) {
    read_verbs();
    for (int v = 0; v < verb_count; v++) {
        char name[64], roff[128];
        write_roff(verbs[v], roff);
        ck_assert_msg(strstr(read_page("skiagraph.1"), roff) != NULL, "%s", verbs[v]);
        if (!read_flags(verbs[v])) continue;
        snprintf(name, sizeof name, "skiagraph-%.31s.1", verbs[v]);
        const char *page = read_page(name);
        for (int f = 0; f < flag_count; f++) {
            write_roff(flags[f], roff);
            ck_assert_msg(strstr(page, roff) != NULL, "%s lacks %s", name, flags[f]);
        }
    }
}
END_TEST

/* Reads bash's completions of the words, one a line, into `said`. The last word is the one that is completed. */
static void complete(const char *words, int last) {
    char line[2048];
    snprintf(line, sizeof line,
             "cd %s && bash -c '. %s/skiagraph; COMP_WORDS=(%s); COMP_CWORD=%d; _skiagraph; "
             "printf \"%%s\\n\" \"${COMPREPLY[@]}\"' >.said",
             folder, SKG_PAGES, words, last);
    ck_assert_msg(system(line) == 0, "%s", line);
    read_back(".said", said, sizeof said);
}

/* Whether `said` has this line. */
static int has_line(const char *text) {
    const size_t length = strlen(text);
    for (const char *at = said; (at = strstr(at, text)); at++)
        if ((at == said || at[-1] == '\n') && at[length] == '\n') return 1;
    return 0;
}

START_TEST(bash_completes_every_verb_and_flag) {
    read_verbs();
    complete("skiagraph \"\"", 1);
    for (int v = 0; v < verb_count; v++) ck_assert_msg(has_line(verbs[v]), "%s not in %s", verbs[v], said);
    for (int v = 0; v < verb_count; v++) {
        char words[128];
        if (!read_flags(verbs[v])) continue;
        snprintf(words, sizeof words, "skiagraph %.31s -", verbs[v]);
        complete(words, 2);
        for (int f = 0; f < flag_count; f++)
            ck_assert_msg(has_line(flags[f]), "%s: %s not in %s", verbs[v], flags[f], said);
    }
}
END_TEST

START_TEST(bash_completes_values_and_files) {
    complete("skiagraph image --strategy \"\"", 3);
    ck_assert_str_eq(said, "auto\ncopies\ntiles\natomics\n");
    complete("skiagraph image --strategy t", 3);
    ck_assert_str_eq(said, "tiles\n");
    complete("skiagraph image --precision = d", 4); /* as bash splits --precision=d */
    ck_assert_str_eq(said, "double\n");
    complete("skiagraph image --precision =", 3);
    ck_assert_str_eq(said, "single\ndouble\nhalf\n");
    write_text("a scene.json", "");
    write_text("a mesh.stl", "");
    complete("skiagraph breathe a", 2);
    ck_assert_str_eq(said, "a scene.json\n");
    complete("skiagraph mesh a", 2);
    ck_assert_msg(has_line("a scene.json") && has_line("a mesh.stl"), "%s", said);
    complete("skiagraph thorax -o a", 3); /* no folder of this name */
    ck_assert_msg(!has_line("a scene.json"), "%s", said);
    complete("skiagraph help b", 2);
    ck_assert_str_eq(said, "beam\nbreathe\n");
}
END_TEST

START_TEST(zsh_completes_every_verb_and_flag) {
    char path[512];
    read_verbs();
    snprintf(path, sizeof path, "%s/_skiagraph", SKG_PAGES);
    for (int v = 0; v < verb_count; v++) {
        char text[64], next[64];
        const char *page = read_page("_skiagraph");
        snprintf(text, sizeof text, "\n        '%.31s:", verbs[v]);
        ck_assert_msg(strstr(page, text) != NULL, "%s", verbs[v]);
        if (!read_flags(verbs[v])) continue;
        snprintf(text, sizeof text, "\n    %.31s)\n", verbs[v]);
        const char *begin = strstr(page, text), *end = begin ? strstr(begin, ";;") : NULL;
        ck_assert_ptr_nonnull(end);
        for (int f = 0; f < flag_count; f++) {
            snprintf(text, sizeof text, "'*%.31s[", flags[f]);
            snprintf(next, sizeof next, "'*%.31s=[", flags[f]);
            const char *without = strstr(begin, text), *with = strstr(begin, next);
            ck_assert_msg((without && without < end) || (with && with < end), "%s: %s", verbs[v], flags[f]);
        }
    }
    char line[640];
    snprintf(line, sizeof line, "if command -v zsh >/dev/null; then zsh -n %s; fi", path);
    ck_assert_int_eq(system(line), 0);
}
END_TEST

/* The parser takes a flag of the help, and goes on to the next word, or says that it takes no value. */
START_TEST(the_parser_takes_every_flag_of_the_help) {
    read_verbs();
    for (int v = 0; v < verb_count; v++) {
        if (!read_flags(verbs[v])) continue;
        for (int f = 0; f < flag_count; f++) {
            if (strcmp(flags[f], "--help") == 0) continue;
            ck_run(2, "%s %s=1 --no-such-flag", verbs[v], flags[f]);
            ck_assert_msg(strstr(complained, "unknown flag --no-such-flag") ||
                              strstr(complained, "takes no value"),
                          "%s: %s: %s", verbs[v], flags[f], complained);
        }
    }
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_checked_fixture(tests, set_up, tear_down);
    tcase_add_test(tests, man_pages_hold_every_verb_and_flag);
    tcase_add_test(tests, bash_completes_every_verb_and_flag);
    tcase_add_test(tests, bash_completes_values_and_files);
    tcase_add_test(tests, zsh_completes_every_verb_and_flag);
    tcase_add_test(tests, the_parser_takes_every_flag_of_the_help);
}

SKG_SUITE_MAIN("pages", add_tests)
