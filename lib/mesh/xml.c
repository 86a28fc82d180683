/* Tags of XML documents. No document type definitions, entities of their own or checks of nesting. */
#include "mesh/xml.h"

#include <string.h>

static const char spaces[] = " \t\r\n";

static int skip_to(skg_xml *xml, const char *end) {
    const char *found = strstr(xml->at, end);
    if (found) xml->at = found + strlen(end);
    return found != NULL;
}

static int starts(const char *at, const char *word) {
    return strncmp(at, word, strlen(word)) == 0;
}

/* Skips a comment, a declaration or a section of characters. Returns 1; 0: a tag stands here; -1: it does not end. */
static int skip_other(skg_xml *xml) {
    static const char *const pairs[][2] = {{"<!--", "-->"}, {"<![CDATA[", "]]>"}, {"<?", "?>"}, {"<!", ">"}};
    for (int k = 0; k < 4; k++)
        if (starts(xml->at, pairs[k][0])) return skip_to(xml, pairs[k][1]) ? 1 : -1;
    return 0;
}

/* Behind the prefix of a name. */
static const char *local(const char *name, size_t *length) {
    const char *colon = memchr(name, ':', *length);
    if (!colon) return name;
    *length -= (size_t)(colon + 1 - name);
    return colon + 1;
}

/* Goes behind the > of a tag; quoted values may hold one. */
static int end_tag(skg_xml *xml) {
    while (*xml->at && *xml->at != '>') {
        const char quote = *xml->at++;
        if (quote != '"' && quote != '\'') continue;
        const char *close = strchr(xml->at, quote);
        if (!close) return -1;
        xml->at = close + 1;
    }
    if (!*xml->at) return -1;
    xml->closes |= xml->at[-1] == '/';
    xml->at++;
    return 1;
}

int skg_xml_next(skg_xml *xml) {
    for (;;) {
        xml->at += strcspn(xml->at, "<");
        if (!*xml->at) return 0;
        const int skipped = skip_other(xml);
        if (skipped < 0) return -1;
        if (!skipped) break;
    }
    xml->opens = xml->at[1] != '/', xml->closes = !xml->opens;
    xml->at += 1 + xml->closes;
    const char *name = xml->at;
    xml->name_length = strcspn(name, " \t\r\n/>");
    if (xml->name_length == 0) return -1;
    xml->at += xml->name_length;
    xml->name = local(name, &xml->name_length);
    xml->attributes = xml->at;
    return end_tag(xml);
}

int skg_xml_is(const skg_xml *xml, const char *name) {
    return strlen(name) == xml->name_length && memcmp(xml->name, name, xml->name_length) == 0;
}

/* Copies a value with its entities replaced. */
static int copy(const char *from, size_t length, char *value, size_t size) {
    static const char *const entities[] = {"&amp;", "&lt;", "&gt;", "&quot;", "&apos;"};
    static const char characters[] = "&<>\"'";
    size_t used = 0;
    for (size_t i = 0; i < length; used++) {
        int entity = -1;
        if (used + 1 >= size) return -1;
        for (int k = 0; k < 5 && entity < 0; k++)
            if (starts(from + i, entities[k])) entity = k;
        value[used] = entity < 0 ? from[i] : characters[entity];
        i += entity < 0 ? 1 : strlen(entities[entity]);
    }
    value[used] = '\0';
    return 1;
}

int skg_xml_attribute(const skg_xml *xml, const char *name, char *value, size_t size) {
    const char *at = xml->attributes;
    for (;;) {
        at += strspn(at, spaces);
        if (at >= xml->at || *at == '>' || *at == '/') return 0;
        size_t length = strcspn(at, " \t\r\n=>");
        const char *its = local(at, &length);
        at = its + length;
        at += strspn(at, spaces);
        if (*at != '=') return -1;
        at++;
        at += strspn(at, spaces);
        if (*at != '"' && *at != '\'') return -1;
        const char *close = strchr(at + 1, *at);
        if (!close || close >= xml->at) return -1;
        if (length == strlen(name) && memcmp(its, name, length) == 0)
            return copy(at + 1, (size_t)(close - at - 1), value, size);
        at = close + 1;
    }
}
