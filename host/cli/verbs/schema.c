/* The verb `schema`, and the keys of scene files as text. */
#include "verbs/verbs.h"

#include "common/file.h"
#include "common/say.h"

#include <jansson.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* The caller frees it; NULL: the error has been printed. */
static char *get_schema(int *exit_status) {
    int64_t size = 0;
    char *text = NULL;
    skg_status status = skg_setup_schema_get(NULL, 0, &size);
    if (status == SKG_OK && !(text = malloc((size_t)size))) {
        *exit_status = cli_error(CLI_DEVICE, "out of host memory for the schema");
        return NULL;
    }
    if (status == SKG_OK) status = skg_setup_schema_get(text, size, &size);
    if (status == SKG_OK) return text;
    free(text);
    *exit_status = cli_fail(status);
    return NULL;
}

static void print_paths(json_t *definitions, const char *table, const char *before);

/* The paths below a key whose value is an object, or the first element of a list of them. */
static void print_below(json_t *definitions, json_t *form, const char *path) {
    const char *reference = json_string_value(json_object_get(form, "$ref"));
    json_t *one, *items = json_object_get(form, "items");
    size_t index;
    char element[256];
    if (reference && strncmp(reference, "#/$defs/", 8) == 0) print_paths(definitions, reference + 8, path);
    json_array_foreach(json_object_get(form, "anyOf"), index, one) print_below(definitions, one, path);
    snprintf(element, sizeof element, "%s.0", path);
    if (items) print_below(definitions, items, element);
}

static void print_paths(json_t *definitions, const char *table, const char *before) {
    json_t *form;
    const char *name;
    json_object_foreach(json_object_get(json_object_get(definitions, table), "properties"), name, form) {
        char path[256];
        if (!json_object_get(form, "description") || *name == '$') continue;
        snprintf(path, sizeof path, "%s%s%s", before, *before ? "." : "", name);
        for (char *c = path; *c; c++)
            if (*c == ' ') *c = '-'; /* blanks, hyphens and underscores do not count in keys */
        printf("%s=\n", path);
        print_below(definitions, form, path);
    }
}

static int list_paths(void) {
    int exit_status = CLI_DONE;
    char *text = get_schema(&exit_status);
    if (!text) return exit_status;
    json_t *schema = json_loads(text, 0, NULL);
    print_paths(json_object_get(schema, "$defs"), "Scene", "");
    json_decref(schema);
    free(text);
    return CLI_DONE;
}

int cli_schema(const cli_arguments *arguments) {
    if (cli_given(arguments, "--paths")) return list_paths();
    const char *path = cli_value(arguments, "-o");
    int exit_status = path ? cli_file_check(path) : CLI_DONE;
    char *text = exit_status == CLI_DONE ? get_schema(&exit_status) : NULL;
    if (!text) return exit_status;
    if (path)
        exit_status = cli_write_file(path, text, strlen(text));
    else
        puts(text);
    if (path && exit_status == CLI_DONE && !cli_is_quiet()) printf("wrote %s\n", path);
    free(text);
    return exit_status;
}

int cli_print_keys(void) {
    int exit_status = CLI_DONE;
    char *text = get_schema(&exit_status);
    if (!text) return exit_status;
    json_t *schema = json_loads(text, 0, NULL), *table, *key;
    const char *name, *spelling;
    free(text);
    puts(
        "Keys of scene files, by the object that they stand in; a scene is the object Scene. docs/scene-files.md says more of each.");
    json_object_foreach(json_object_get(schema, "$defs"), name, table) {
        json_t *keys = json_object_get(table, "properties");
        if (keys) printf("\n%s\n", name);
        json_object_foreach(keys, spelling, key) {
            const char *says = json_string_value(json_object_get(key, "description"));
            if (says) printf("  %-22s %s\n", spelling, says);
        }
    }
    json_decref(schema);
    return CLI_DONE;
}
