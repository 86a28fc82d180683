/* A JSON file, its values, the lines where they stand, and settings that change it. */
#include "json/json_file.h"
#include "core/files.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>

/* The whole file, with a 0 at its end. */
static skg_status read_text(int is_input, const char *path, char **text, size_t *length) {
    FILE *stream = stdin;
    if (!is_input) SKG_TRY(skg_input_open(path, SKG_INPUT_TEXT, &stream, NULL));
    size_t mark = 0;
    skg_status status = skg_input_read(stream, path, SKG_INPUT_TEXT, text, length);
    if (!is_input) fclose(stream);
    if (status == SKG_OK) status = skg_text_mark(path, *text, *length, &mark);
    if (status != SKG_OK) return status;
    memmove(*text, *text + mark, *length - mark + 1);
    *length -= mark;
    return SKG_OK;
}

/* Blanks a comma before a closing bracket, which JSON does not allow but people write. Returns its line; 0: there is
 * none. */
static int64_t blank_comma(char *text, size_t length) {
    char *comma = NULL;
    int64_t line = 1, line_of_comma = 0;
    int is_string = 0;
    for (size_t i = 0; i < length; i++) {
        const char c = text[i];
        line += c == '\n';
        if (is_string) {
            if (c == '\\') i++;
            is_string = c != '"';
            continue;
        }
        if (comma && (c == ']' || c == '}')) {
            *comma = ' ';
            return line_of_comma;
        }
        is_string = c == '"';
        if (c == ',')
            comma = text + i, line_of_comma = line;
        else if (!strchr(" \t\r\n", c))
            comma = NULL;
    }
    return 0;
}

/* Parses the text without commas that are too many, each of which is a remark. *error: of the text as it was */
static skg_status parse_with_commas(skg_json_file *file, size_t length, json_error_t *error) {
    json_error_t again;
    int64_t line = 0;
    while (!file->root && (line = blank_comma(file->text, length)) > 0) {
        char remark[128];
        snprintf(remark, sizeof remark, "line %" PRId64 ": a comma before a closing bracket is passed over",
                 line);
        if (json_array_append_new(file->remarks, json_string(remark)) != 0)
            return skg_fail(SKG_ERR_MEMORY, "%s: no memory for a warning", file->path);
        file->root = json_loadb(file->text, length, JSON_REJECT_DUPLICATES, &again);
    }
    if (file->root) return SKG_OK;
    const char *first = file->text + strspn(file->text, " \t\r\n");
    if (*first && *first != '{' && *first != '[')
        return skg_fail(
            SKG_ERR_FORMAT,
            "%s: is neither a scene nor a mesh: a scene is JSON and begins with {, and a mesh ends in .stl, .ply, .obj "
            "or the like (line %d, column %d: %s)",
            file->path, error->line, error->column, error->text);
    return skg_fail(SKG_ERR_FORMAT, "%s: line %d, column %d: %s", file->path, error->line, error->column,
                    error->text);
}

/* Parses the text of the file, which has this length. */
static skg_status parse(skg_json_file *file, size_t length) {
    const char *path = file->path;
    file->set = json_array();
    file->remarks = json_array();
    if (!file->set || !file->remarks) return skg_fail(SKG_ERR_MEMORY, "%s: no memory for settings", path);
    /* Some editors write a byte order mark, which JSON does not allow. */
    if (length >= 3 && memcmp(file->text, "\xEF\xBB\xBF", 3) == 0) memset(file->text, ' ', 3);
    json_error_t error;
    file->root = json_loadb(file->text, length, JSON_REJECT_DUPLICATES, &error);
    if (!file->root) SKG_TRY(parse_with_commas(file, length, &error));
    if (!json_is_object(file->root))
        return skg_fail(SKG_ERR_FORMAT, "%s: a scene file holds one JSON object { ... }", path);
    return SKG_OK;
}

skg_status skg_json_open(const char *path, skg_json_file *file) {
    const int is_input = strcmp(path, "-") == 0;
    if (is_input) path = "standard input";
    *file = (skg_json_file){.path = path};
    size_t length = 0;
    SKG_TRY(read_text(is_input, path, &file->text, &length));
    return parse(file, length);
}

skg_status skg_json_parse(const char *text, const char *path, skg_json_file *file) {
    *file = (skg_json_file){.path = path};
    SKG_TRY(skg_copy_text(text, &file->text));
    return parse(file, strlen(text));
}

void skg_json_close(skg_json_file *file) {
    json_decref(file->root);
    json_decref(file->set);
    json_decref(file->remarks);
    skg_free(&file->text);
    *file = (skg_json_file){0};
}

skg_json_node skg_json_root(const skg_json_file *file) {
    return (skg_json_node){.file = file, .value = file->root};
}

/* Whether this value, or one around it, comes from a setting. */
static int was_set(const skg_json_node *node) {
    size_t count = json_array_size(node->file->set);
    for (; node; node = node->up)
        for (size_t i = 0; i < count; i++)
            if (node->value && json_array_get(node->file->set, i) == node->value) return 1;
    return 0;
}

/* The text was parsed without an error, so skipping has to watch for its end only. */
static const char *skip_space(const char *at) {
    return at + strspn(at, " \t\r\n");
}

static const char *skip_string(const char *at) {
    for (at++; *at && *at != '"'; at++)
        if (*at == '\\' && at[1]) at++;
    return *at ? at + 1 : at;
}

static const char *skip_value(const char *at) {
    int64_t depth = 0;
    do {
        at = skip_space(at);
        if (*at == '"')
            at = skip_string(at);
        else if (*at == '{' || *at == '[')
            depth++, at++;
        else if (*at == '}' || *at == ']')
            depth--, at++;
        else if (*at == ',' || *at == ':')
            at++;
        else
            at += strcspn(at, " \t\r\n,:]}[{\"");
    } while (depth > 0 && *at);
    return at;
}

/* Whether the string literal at `at` is this key. It is parsed, as it may have escapes. */
static int is_key(const char *at, const char *key) {
    const char *end = skip_string(at);
    json_t *parsed = json_loadb(at, (size_t)(end - at), JSON_DECODE_ANY, NULL);
    int same = parsed && strcmp(json_string_value(parsed), key) == 0;
    json_decref(parsed);
    return same;
}

/* The child of a container that a node names: its key, or the element itself. at: the container's first character.
 * NULL: it is not there. */
static const char *find_child(const char *at, const skg_json_node *node, const char **value) {
    if (*at != '{' && *at != '[') return NULL;
    int object = *at == '{';
    if (object != (node->key != NULL)) return NULL;
    at = skip_space(at + 1);
    for (int64_t index = 0; *at && *at != '}' && *at != ']'; index++) {
        const char *key = at;
        if (object) at = skip_space(skip_space(skip_string(at)) + 1);
        if (object ? is_key(key, node->key) : index == node->index) {
            *value = at;
            return key;
        }
        at = skip_space(skip_value(at));
        if (*at == ',') at = skip_space(at + 1);
    }
    return NULL;
}

/* The first character of a node (of its key, where it has one). *value: that of its value. */
static const char *find_node(const skg_json_node *node, const char **value) {
    if (!node->up) return *value = skip_space(node->file->text);
    const char *around = NULL;
    if (!find_node(node->up, &around)) return NULL;
    return find_child(around, node, value);
}

int64_t skg_json_column(const skg_json_node *node) {
    const char *text = node->file->text, *value = NULL, *end = text ? strchr(text, '\n') : NULL;
    if (!text || was_set(node) || (end && *skip_space(end))) return 0;
    const char *at = find_node(node, &value);
    return at && node->up ? at - text + 1 : 0;
}

int64_t skg_json_line(const skg_json_node *node) {
    const char *value = NULL;
    if (!node->file->text || was_set(node)) return 0;
    const char *at = find_node(node, &value);
    if (!at || !node->up) return 0;
    int64_t line = 1;
    for (const char *c = node->file->text; c < at; c++) line += *c == '\n';
    return line;
}
