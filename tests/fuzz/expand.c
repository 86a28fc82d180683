/* Texts by a grammar: each byte of the input of a fuzz target chooses an alternative. */
#include "fuzz/expand.h"

#include <string.h>

enum { DEEPEST = 24 };

typedef struct {
    const rule *rules;
    size_t count;
    const uint8_t *next, *end;
    char *text;
    size_t length;
} writer;

static const rule *find_rule(const writer *w, const char *name, const char *end) {
    const size_t length = (size_t)(end - name);
    for (size_t n = 0; n < w->count; n++)
        if (strlen(w->rules[n].name) == length && strncmp(w->rules[n].name, name, length) == 0)
            return &w->rules[n];
    return NULL;
}

/* The first alternative when the input is used up, or at the depth where recursion has to end. */
static const char *choose(writer *w, const rule *from, int depth) {
    int count = 0;
    while (count < ALTERNATIVES_MAX && from->alternatives[count]) count++;
    if (w->next == w->end || depth >= DEEPEST) return from->alternatives[0];
    return from->alternatives[*w->next++ % count];
}

static void write_rule(writer *w, const rule *from, int depth) {
    for (const char *at = choose(w, from, depth); *at && w->length < EXPANDED_MAX; at++) {
        const char *close = *at == '<' ? strchr(at, '>') : NULL;
        const rule *inner = close ? find_rule(w, at + 1, close) : NULL;
        if (!inner) {
            w->text[w->length++] = *at;
            continue;
        }
        write_rule(w, inner, depth + 1);
        at = close;
    }
}

size_t fuzz_expand(const rule *rules, size_t count, const uint8_t *data, size_t size,
                   char text[EXPANDED_MAX]) {
    writer w = {.rules = rules, .count = count, .next = data, .end = data + size, .text = text};
    write_rule(&w, &rules[0], 0);
    return w.length;
}
