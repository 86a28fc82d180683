/* The parts of a scene that --only and --without leave. */
#include "session/chosen.h"

#include "common/say.h"
#include "core/text.h"
#include "manual/manual.h"

#include <ctype.h>
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

/* Whether a label fits a pattern of a length, in which * stands for any text, without regard to case. */
static int fits(const char *label, const char *pattern, size_t length) {
    if (length == 0) return *label == '\0';
    if (*pattern != '*')
        return *label && tolower((unsigned char)*label) == tolower((unsigned char)*pattern) &&
               fits(label + 1, pattern + 1, length - 1);
    while (length > 0 && *pattern == '*') pattern++, length--;
    if (length == 0) return 1;
    for (; *label; label++)
        if (fits(label, pattern, length)) return 1;
    return 0;
}

/* The scene, and what is left of it. */
typedef struct {
    const skg_scene *scene;
    int64_t count;
    char *chosen;     /* [count] 1: the part stays */
    int64_t *numbers; /* [count] its number in the new scene; -1: not added */
} choice;

static const char *label_of(const choice *c, int64_t part) {
    const char *label = "";
    (void)skg_scene_part_label_get(c->scene, part, &label);
    return label;
}

static int fail_unknown(const choice *c, const char *flag, const char *pattern, size_t length) {
    enum { MOST = 1024, LONGEST = 64 };
    const char *labels[MOST], *near = NULL;
    char word[LONGEST] = "";
    const int64_t count = c->count < MOST ? c->count : MOST;
    for (int64_t p = 0; p < count; p++) labels[p] = label_of(c, p);
    memcpy(word, pattern, length < LONGEST ? length : LONGEST - 1);
    if (!strchr(word, '*')) near = skg_nearest_name(word, labels, count);
    return cli_error(CLI_USAGE, "%s: the scene has no part \"%.*s\"%s%s%s", flag, (int)length, pattern,
                     near ? "; did you mean \"" : "", near ? near : "", near ? "\"?" : "");
}

/* Marks the parts that patterns of a flag name, with commas between them. */
static int mark_text(const choice *c, const char *flag, const char *text, char value) {
    for (const char *at = text; at; at = *at == ',' ? at + 1 : NULL) {
        const char *pattern = at;
        const size_t length = strcspn(at, ",");
        int64_t found = 0;
        at += length;
        for (int64_t p = 0; p < c->count; p++)
            if (fits(label_of(c, p), pattern, length)) c->chosen[p] = value, found++;
        if (!found) return fail_unknown(c, flag, pattern, length);
    }
    return CLI_DONE;
}

static int mark(const choice *c, const cli_arguments *arguments, const char *flag, char value) {
    const char *text;
    int exit_status = CLI_DONE;
    for (int i = 0; exit_status == CLI_DONE && (text = cli_nth_value(arguments, flag, i)); i++)
        exit_status = mark_text(c, flag, text, value);
    return exit_status;
}

int cli_mark_parts(const skg_scene *scene, const char *flag, const char *text, int64_t count, char *chosen) {
    const choice c = {.scene = scene, .count = count, .chosen = chosen};
    return mark_text(&c, flag, text, 1);
}

/* Adds the parts whose surroundings are there; those of a part that is left out are what it lies in. Returns how many. */
static skg_status add_parts(const choice *c, skg_scene *made, int64_t *added) {
    *added = 0;
    for (int64_t p = 0; p < c->count; p++) {
        skg_part part;
        if (!c->chosen[p] || c->numbers[p] >= 0) continue;
        skg_part_init(&part);
        skg_status status = skg_scene_part_get(c->scene, p, &part);
        int64_t inside = part.inside;
        while (status == SKG_OK && inside >= 0 && !c->chosen[inside]) {
            skg_part above;
            skg_part_init(&above);
            status = skg_scene_part_get(c->scene, inside, &above);
            inside = above.inside;
        }
        if (status != SKG_OK) return status;
        if (inside >= 0 && c->numbers[inside] < 0) continue; /* in another round */
        part.inside = inside >= 0 ? c->numbers[inside] : -1;
        status = skg_scene_part_add(made, &part, &c->numbers[p]);
        if (status != SKG_OK) return status;
        ++*added;
    }
    return SKG_OK;
}

static int rebuild(const choice *c, cli_session *session) {
    skg_scene *made = NULL;
    int64_t added = 1;
    skg_status status = skg_scene_create(session->context, &made);
    while (status == SKG_OK && added > 0) status = add_parts(c, made, &added);
    if (status != SKG_OK) {
        skg_scene_release(&made);
        return cli_fail(status);
    }
    session->chosen = session->scene = made;
    return CLI_DONE;
}

int cli_choose_parts(const cli_arguments *arguments, cli_session *session) {
    const int only = cli_given(arguments, "--only"), without = cli_given(arguments, "--without");
    choice c = {.scene = session->scene};
    if (!only && !without) return CLI_DONE;
    const skg_status status = skg_scene_part_count(c.scene, &c.count);
    if (status != SKG_OK) return cli_fail(status);
    c.chosen = calloc((size_t)c.count + 1, 1);
    c.numbers = calloc((size_t)c.count + 1, sizeof *c.numbers);
    int exit_status = c.chosen && c.numbers ? CLI_DONE : cli_error(CLI_DEVICE, "out of host memory");
    for (int64_t p = 0; p < c.count && exit_status == CLI_DONE; p++) c.chosen[p] = !only, c.numbers[p] = -1;
    if (exit_status == CLI_DONE) exit_status = mark(&c, arguments, "--only", 1);
    if (exit_status == CLI_DONE) exit_status = mark(&c, arguments, "--without", 0);
    if (exit_status == CLI_DONE && !memchr(c.chosen, 1, (size_t)c.count))
        exit_status = cli_error(CLI_USAGE, "--without: no part is left");
    if (exit_status == CLI_DONE) exit_status = rebuild(&c, session);
    free(c.chosen);
    free(c.numbers);
    return exit_status;
}
