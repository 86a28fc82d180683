/* The JSON Schema of scene files (draft 2020-12), from the tables of their keys. */
#include "core/context.h"
#include "core/text.h"
#include "setup/keys.h"
#include "setup/sections.h"

#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const skg_json_table *const tables[] = {
    &skg_keys_scene,     &skg_keys_world,        &skg_keys_noise,      &skg_keys_collimation,
    &skg_keys_scatter,   &skg_keys_source,       &skg_keys_off_focal,  &skg_keys_heel,
    &skg_keys_bowtie,    &skg_keys_channel,      &skg_keys_beam,       &skg_keys_detector,
    &skg_keys_counting,  &skg_keys_curved,       &skg_keys_grid,       &skg_keys_response,
    &skg_keys_pulses,    &skg_keys_scintillator, &skg_keys_depth,      &skg_keys_grey_values,
    &skg_keys_pixel_map, &skg_keys_sample,       &skg_keys_step_wedge, &skg_keys_scan,
    &skg_keys_drift,     &skg_keys_jitter,       &skg_keys_fields,     &skg_keys_breathing,
    &skg_keys_organ,     &skg_keys_link,         &skg_keys_event,      &skg_keys_body_fit,
};
enum { TABLES = sizeof tables / sizeof *tables };

/* Forms with a name of their own: other forms, or schemas in which ' stands for ". */
static const struct {
    const char *name, *schema;
} named[] = {
    {"any", "{}"},
    {"null", "{'type': 'null'}"},
    {"text", "{'type': 'string'}"},
    {"flag", "{'anyOf': [{'type': 'boolean'}, {'enum': [0, 1]}]}"},
    {"unit", "{'type': 'string', 'examples': ['mm', 'um', 'nm', 'cm', 'dm', 'm', 'in', 'ft']}"},
    {"energy_unit", "{'type': 'string', 'examples': ['keV', 'eV', 'MeV']}"},
    {"length", "lengths 1"},
    {"direction", "numbers 3"},
    {"energy",
     "{'type': 'array', 'prefixItems': [{'type': 'number', 'minimum': 0}, {'$ref': '#/$defs/energy_unit'}], 'minItems': 2, "
     "'maxItems': 2, 'examples': [[2.5, 'keV']]}"},
    {"time",
     "{'anyOf': [{'type': 'number'}, {'type': 'array', 'prefixItems': [{'type': 'number'}, {'type': 'string'}], 'minItems': 2, "
     "'examples': [[20, 'ms']]}]}"},
    {"current",
     "{'anyOf': [{'type': 'number'}, {'type': 'array', 'prefixItems': [{'type': 'number'}, {'type': 'string'}], 'minItems': "
     "2, 'examples': [[100, 'mA']]}]}"},
    {"output",
     "{'type': 'array', 'prefixItems': [{'type': 'number', 'exclusiveMinimum': 0}, {'type': 'string'}, {'type': 'number'}, "
     "{'$ref': '#/$defs/unit'}], 'minItems': 4, 'maxItems': 4, 'examples': [[65, 'uGy/mAs', 100, 'cm']]}"},
    {"filter",
     "{'type': 'array', 'prefixItems': [{'type': ['string', 'integer']}, {'type': 'number'}, {'$ref': '#/$defs/unit'}], "
     "'minItems': 2, 'maxItems': 3, 'examples': [['Al', 2.5, 'mm']]}"},
    {"class",
     "{'type': 'array', 'prefixItems': [{'type': 'number'}, {'$ref': '#/$defs/material'}], 'minItems': 2, 'maxItems': 2, "
     "'examples': [[-1000, 'Air']]}"},
    {"rectangle",
     "{'type': 'array', 'prefixItems': [{'type': 'array', 'items': {'type': 'number'}, 'minItems': 2, 'maxItems': 2}, {'type': 'array', 'items': {'type': 'number'}, 'minItems': 2, 'maxItems': 2}, {'$ref': "
     "'#/$defs/unit'}], 'minItems': 3, 'maxItems': 3, 'examples': [[[-50, 50], [-40, 60], 'mm']]}"},
    {"places", "pair integer 1..256"},
    {"spot",
     "{'type': 'array', 'prefixItems': [{'type': 'string', 'examples': ['Line', 'Rectangle', 'Cube', 'Disc', 'Sphere', "
     "'Gaussian', 'FocalSpot']}, {'type': 'number', 'minimum': 0}], 'minItems': 3, 'maxItems': 4, "
     "'examples': [['Disc', 1, 'mm'], ['Gaussian', 0.6, 0.6, 'mm']]}"},
    {"transformation",
     "{'type': 'array', 'prefixItems': [{'type': 'string', 'examples': ['Rotation', 'Translation', 'Scaling', "
     "'Matrix']}], 'minItems': 2, 'maxItems': 5, 'examples': [['Rotation', 90, 0, 0, 1], "
     "['Translation', 0, 0, 10, 'mm'], ['Scaling', 1, 1, 2]]}"},
    {"material",
     "{'anyOf': [{'type': 'string'}, {'type': 'array', 'prefixItems': [{'type': 'string', 'examples': ['Element', "
     "'Compound', 'Mixture', 'HU', 'mu', 'Solution', 'Table']}, {'type': ['number', 'string', 'array']}], 'minItems': 2, "
     "'maxItems': 4}], 'examples': ['Water', ['Compound', 'H2O'], ['mu', 0.2], ['HU', 52]]}"},
};
enum { NAMED = sizeof named / sizeof *named };

static json_t *schema_of(const char *form);

static json_t *reference_to(const char *name) {
    char text[96];
    snprintf(text, sizeof text, "#/$defs/%s", name);
    return json_pack("{s:s}", "$ref", text);
}

static json_t *from_quoted(const char *quoted) {
    char text[1024];
    size_t length = 0;
    for (; quoted[length] && length + 1 < sizeof text; length++)
        text[length] = quoted[length] == '\'' ? '"' : quoted[length];
    text[length] = '\0';
    return json_loads(text, 0, NULL);
}

/* A regular expression of all spellings of a name: case, blanks, hyphens and underscores do not count. */
static void spell(const char *name, char *pattern, size_t size) {
    size_t used = (size_t)snprintf(pattern, size, "^[ _-]*");
    for (; *name && used + 16 < size; name++) {
        if (*name == ' ' || *name == '-' || *name == '_') continue;
        if (isalpha((unsigned char)*name))
            used += (size_t)snprintf(pattern + used, size - used, "[%c%c][ _-]*",
                                     tolower((unsigned char)*name), toupper((unsigned char)*name));
        else
            used += (size_t)snprintf(pattern + used, size - used, "[%c][ _-]*", *name);
    }
    snprintf(pattern + used, size - used, "$");
}

/* "a, b, c": one of them as it stands, for editors, or in any other spelling. */
static json_t *of_words(const char *words) {
    json_t *known = json_array(), *any = json_array();
    while (*words) {
        const size_t length = strcspn(words, ",");
        char word[64], pattern[512];
        snprintf(word, sizeof word, "%.*s", (int)length, words);
        spell(word, pattern, sizeof pattern);
        json_array_append_new(known, json_string(word));
        json_array_append_new(any, json_pack("{s:s,s:s}", "type", "string", "pattern", pattern));
        words += length + (words[length] == ',');
        words += strspn(words, " ");
    }
    json_array_insert_new(any, 0, json_pack("{s:o}", "enum", known));
    return json_pack("{s:o}", "anyOf", any);
}

/* "0<..1", "1..", "..<1" or nothing. */
static json_t *of_number(const char *type, const char *range) {
    json_t *schema = json_pack("{s:s}", "type", type);
    const char *dots = strstr(range, "..");
    char *end = NULL;
    if (!dots) return schema;
    const double low = strtod(range, &end);
    const char *const least = *end == '<' ? "exclusiveMinimum" : "minimum";
    if (end != range) json_object_set_new(schema, least, json_real(low));
    const char *const most = dots[2] == '<' ? "exclusiveMaximum" : "maximum",
                      *top = dots + 2 + (dots[2] == '<');
    const double high = strtod(top, &end);
    if (end != top) json_object_set_new(schema, most, json_real(high));
    return schema;
}

/* `count` items of one kind and, if it is not NULL, a last one; count 0: any number of them. */
static json_t *of_array(json_t *item, int64_t count, json_t *last) {
    json_t *schema = json_pack("{s:s}", "type", "array"), *first = json_array();
    if (count == 0) {
        json_decref(first);
        json_object_set_new(schema, "items", item);
        return schema;
    }
    for (int64_t i = 0; i < count; i++) json_array_append(first, item);
    json_decref(item);
    if (last) json_array_append_new(first, last);
    const json_int_t size = (json_int_t)json_array_size(first);
    json_object_set_new(schema, "prefixItems", first);
    json_object_set_new(schema, "minItems", json_integer(size));
    json_object_set_new(schema, "maxItems", json_integer(size));
    return schema;
}

/* The rest of a form behind a word and a blank; NULL: the form does not begin with the word. */
static const char *after(const char *form, const char *word) {
    const size_t length = strlen(word);
    if (strncmp(form, word, length) != 0 || (form[length] && form[length] != ' ')) return NULL;
    return form + length + (form[length] == ' ');
}

/* A form without " | ". */
static json_t *of_one(const char *form) {
    const char *rest;
    json_t *number = json_pack("{s:s}", "type", "number");
    if ((rest = after(form, "numbers"))) return of_array(number, atoi(rest), NULL);
    if ((rest = after(form, "lengths"))) return of_array(number, atoi(rest), reference_to("unit"));
    if ((rest = after(form, "rows"))) return of_array(of_array(number, atoi(rest), NULL), 0, NULL);
    json_decref(number);
    if ((rest = after(form, "number"))) return of_number("number", rest);
    if ((rest = after(form, "integer"))) return of_number("integer", rest);
    if ((rest = after(form, "words"))) return of_words(rest);
    if ((rest = after(form, "pair"))) return of_array(schema_of(rest), 2, NULL);
    if ((rest = after(form, "list"))) return of_array(schema_of(rest), 0, NULL);
    if ((rest = after(form, "map")))
        return json_pack("{s:s,s:o}", "type", "object", "additionalProperties", schema_of(rest));
    if ((rest = after(form, "object"))) return reference_to(rest);
    return reference_to(form);
}

/* A list takes all that follows it. */
static json_t *schema_of(const char *form) {
    const char *bar = after(form, "list") ? NULL : strstr(form, " | ");
    if (!bar) return of_one(form);
    json_t *any = json_array();
    for (; bar; form = bar + 3, bar = after(form, "list") ? NULL : strstr(form, " | ")) {
        char one[256];
        snprintf(one, sizeof one, "%.*s", (int)(bar - form), form);
        json_array_append_new(any, of_one(one));
    }
    json_array_append_new(any, of_one(form));
    return json_pack("{s:o}", "anyOf", any);
}

static const char *form_of(const skg_json_table *table, const skg_json_key *key) {
    for (int64_t i = 0; key->as && i < table->count; i++)
        if (strcmp(table->keys[i].name, key->as) == 0) return table->keys[i].form;
    return key->form;
}

/* Keys as they are written here are properties, which editors complete; every other spelling is a pattern. */
static json_t *of_table(const skg_json_table *table) {
    json_t *properties = json_object(), *patterns = json_object();
    char pattern[512];
    for (int64_t i = 0; i < table->count; i++) {
        const skg_json_key *key = &table->keys[i];
        json_t *schema = schema_of(form_of(table, key));
        spell(key->name, pattern, sizeof pattern);
        json_object_set(patterns, pattern, schema);
        if (key->says) json_object_set_new(schema, "description", json_string(key->says));
        if (key->as) json_object_set_new(schema, "$comment", json_sprintf("another spelling of %s", key->as));
        json_object_set_new(properties, key->name, schema);
    }
    for (int64_t i = 0; i < skg_json_asides.count; i++) {
        spell(skg_json_asides.keys[i].name, pattern, sizeof pattern);
        json_object_set_new(patterns, pattern, json_object());
    }
    return json_pack("{s:s,s:o,s:o,s:b}", "type", "object", "properties", properties, "patternProperties",
                     patterns, "additionalProperties", 0);
}

static json_t *make_schema(void) {
    json_t *definitions = json_object();
    for (int i = 0; i < NAMED; i++)
        json_object_set_new(definitions, named[i].name,
                            named[i].schema[0] == '{' ? from_quoted(named[i].schema)
                                                      : of_one(named[i].schema));
    for (int i = 0; i < TABLES; i++) json_object_set_new(definitions, tables[i]->name, of_table(tables[i]));
    return json_pack("{s:s,s:s,s:s,s:s,s:o}", "$schema", "https://json-schema.org/draft/2020-12/schema",
                     "title", "Scene file of Skiagraph", "description", "Written by `skiagraph schema`.",
                     "$ref", "#/$defs/Scene", "$defs", definitions);
}

skg_status skg_setup_schema_get(char *text, int64_t capacity, int64_t *size) {
    SKG_PLAIN;
    SKG_NEEDS(size);
    json_t *schema = make_schema();
    char *made = schema ? json_dumps(schema, JSON_INDENT(1) | JSON_REAL_PRECISION(17)) : NULL;
    skg_status status = made ? SKG_OK : skg_fail(SKG_ERR_MEMORY, "no memory for the schema of scene files");
    json_decref(schema);
    if (status == SKG_OK) *size = (int64_t)strlen(made) + 1;
    if (status == SKG_OK && text && capacity < *size)
        status = skg_fail(SKG_ERR_ARGUMENT, "capacity is %lld; the schema has %lld bytes",
                          (long long)capacity, (long long)*size);
    else if (status == SKG_OK && text)
        memcpy(text, made, (size_t)*size);
    free(made);
    return status;
}
