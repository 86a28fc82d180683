/* The relationships of a package (ECMA-376, part 2), of which 3MF is one. */
#include "mesh/relations.h"

#include <string.h>

static const char model[] = "http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel";

/* Returns how much there was. */
static size_t skip_space(const char **at) {
    const size_t length = strspn(*at, " \t\r\n");
    *at += length;
    return length;
}

/* Goes behind a word. 0: something else stands there. */
static int take(const char **at, const char *word) {
    const size_t length = strlen(word);
    if (strncmp(*at, word, length) != 0) return 0;
    *at += length;
    return 1;
}

static int skip_to(const char **at, const char *end) {
    const char *found = strstr(*at, end);
    if (found) *at = found + strlen(end);
    return found != NULL;
}

/* An attribute; its value if its name is the given one. 0: there is none, -1: it is damaged. */
static int take_attribute(const char **at, const char *name, char value[SKG_RELATION_MAX]) {
    static const char letters[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz:";
    const size_t space = skip_space(at);
    const char *start = *at;
    const size_t length = strspn(start, letters);
    if (length == 0 || space == 0) return 0;
    *at += length;
    skip_space(at);
    if (!take(at, "=")) return -1;
    skip_space(at);
    const char quote[] = {**at, '<', '&', '\0'}; /* entities are not read */
    if (quote[0] != '"' && quote[0] != '\'') return -1;
    const char *text = ++*at;
    *at += strcspn(*at, quote);
    if (**at != quote[0]) return -1;
    const size_t count = (size_t)(*at - text);
    ++*at;
    if (length != strlen(name) || memcmp(start, name, length) != 0) return 1;
    if (count >= SKG_RELATION_MAX) return -1;
    memcpy(value, text, count), value[count] = '\0';
    return 1;
}

/* Attributes up to the end of an element's name tag. */
static int take_attributes(const char **at, char type[SKG_RELATION_MAX], char target[SKG_RELATION_MAX]) {
    int taken;
    do {
        const char *again = *at;
        taken = take_attribute(at, "Type", type);
        if (taken > 0 && (*at = again, taken = take_attribute(at, "Target", target)) < 0) return 0;
    } while (taken > 0);
    return taken == 0;
}

static int take_relationship(const char **at, char type[SKG_RELATION_MAX], char target[SKG_RELATION_MAX]) {
    *type = *target = '\0';
    if (!take_attributes(at, type, target)) return 0;
    return take(at, "/>") || take(at, "></Relationship>");
}

/* The declaration of XML, and the beginning of the element. */
static int begin(skg_relations *r) {
    char type[SKG_RELATION_MAX], target[SKG_RELATION_MAX];
    take(&r->at, "\xEF\xBB\xBF");
    skip_space(&r->at);
    if (take(&r->at, "<?xml ") && !skip_to(&r->at, "?>")) return 0;
    skip_space(&r->at);
    r->is_begun =
        take(&r->at, "<Relationships") && take_attributes(&r->at, type, target) && take(&r->at, ">");
    return r->is_begun;
}

int skg_relations_next_model(skg_relations *r, char target[SKG_RELATION_MAX]) {
    char type[SKG_RELATION_MAX] = "";
    if (!r->is_begun && !begin(r)) return -1;
    while (strcmp(type, model) != 0) {
        skip_space(&r->at);
        if (take(&r->at, "</Relationships>")) {
            skip_space(&r->at);
            return *r->at ? -1 : 0;
        }
        if (!take(&r->at, "<Relationship") || !take_relationship(&r->at, type, target)) return -1;
    }
    return 1;
}
