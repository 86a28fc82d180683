/* 3MF: objects with meshes, objects that are made of others, and the items that are built, also where objects lie in other parts of
 * the archive (the production extension: Bambu Studio, Orca). Each built object is a named piece. */
#include "mesh/read.h"

#include "core/core.h"
#include "core/maths.h"
#include "core/text.h"
#include "mesh/archive.h"
#include "mesh/instances.h"
#include "mesh/relations.h"
#include "mesh/xml.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { DEEPEST = 32, LONGEST = SKG_RELATION_MAX };

typedef struct {
    char id[32];
    int32_t other;  /* 1: it supports others, and is not printed */
    int32_t empty;  /* 1: nothing stands within its tag */
    const char *at; /* behind the tag of the object */
    char name[LONGEST];
} object;

/* A part of the archive that holds objects. */
typedef struct {
    char name[LONGEST];
    char *text;
    double mm;
    object *objects;
    int64_t count, capacity;
} model;

typedef struct {
    const char *path;
    int64_t size;
    model *models;
    int64_t count;
    double root_mm;
    skg_instances parts; /* what is built, and objects of each model */
    skg_mesh_arrays *arrays;
} reader;

static skg_status damaged(const reader *r, const char *what) {
    return skg_fail(SKG_ERR_FORMAT, "%s: no valid 3MF file: %s", r->path, what);
}

/* mm per unit: 3MF Core, 3.4. */
static skg_status read_unit(const reader *r, const skg_xml *xml, double *mm) {
    static const struct {
        const char *name;
        double mm;
    } units[] = {{"micron", 1e-3}, {"millimeter", 1}, {"centimeter", 10},
                 {"inch", 25.4},   {"foot", 304.8},   {"meter", 1000}};
    char name[32];
    const int found = skg_xml_attribute(xml, "unit", name, sizeof name);
    *mm = 1;
    if (found == 0) return SKG_OK;
    for (size_t k = 0; found > 0 && k < sizeof units / sizeof *units; k++)
        if (strcmp(name, units[k].name) == 0) {
            *mm = units[k].mm;
            return SKG_OK;
        }
    return damaged(r, "its unit is none of micron, millimeter, centimeter, inch, foot and meter");
}

/* The model of this name, which is read later if it is new. */
static skg_status find_model(reader *r, const char *name, int64_t *index) {
    for (*index = 0; *index < r->count; ++*index)
        if (strcmp(r->models[*index].name, name) == 0) return SKG_OK;
    SKG_TRY(skg_realloc(r->count + 1, sizeof *r->models, r->path, &r->models));
    model *m = &r->models[r->count++];
    *m = (model){0};
    snprintf(m->name, sizeof m->name, "%s", name);
    return SKG_OK;
}

/* The object that a component or an item names: the index of its model, and its id. */
static skg_status read_reference(reader *r, const skg_xml *xml, int64_t *index, char id[32]) {
    char path[LONGEST];
    const int found = skg_xml_attribute(xml, "path", path, sizeof path);
    if (found < 0 || skg_xml_attribute(xml, "objectid", id, 32) <= 0)
        return damaged(r, "a component or an item names no object");
    return found > 0 ? find_model(r, path, index) : SKG_OK;
}

static skg_status list_object(reader *r, int64_t index, const skg_xml *xml, int64_t *part) {
    char type[32];
    model *m = &r->models[index];
    if (m->count == m->capacity) {
        m->capacity = 2 * m->capacity + 16;
        SKG_TRY(skg_realloc(m->capacity, sizeof *m->objects, r->path, &m->objects));
    }
    object *o = &m->objects[m->count++];
    *o = (object){.at = xml->at, .empty = xml->closes};
    if (skg_xml_attribute(xml, "id", o->id, sizeof o->id) <= 0) return damaged(r, "an object has no id");
    if (skg_xml_attribute(xml, "name", o->name, sizeof o->name) <= 0 || !*o->name)
        snprintf(o->name, sizeof o->name, "object %s", o->id);
    o->other = skg_xml_attribute(xml, "type", type, sizeof type) > 0 &&
               (strcmp(type, "support") == 0 || strcmp(type, "other") == 0);
    SKG_TRY(skg_instances_add(&r->parts, o->id, !o->other, part));
    return skg_instances_name(&r->parts, *part, skg_instances_key((uint64_t)index, o->id));
}

/* Counts the contents of an object of the part: bytes of a vertex or a triangle, and other objects that it places. */
static skg_status count_tag(reader *r, int64_t index, const skg_xml *xml, int64_t part) {
    const int is_item = index == 0 && skg_xml_is(xml, "item");
    char id[32];
    if (part > 0 && skg_xml_is(xml, "vertex")) r->parts.nodes[part].bytes += 3 * sizeof(double);
    if (part > 0 && skg_xml_is(xml, "triangle")) r->parts.nodes[part].bytes += 3 * sizeof(int32_t);
    if (!is_item && (part == 0 || !skg_xml_is(xml, "component"))) return SKG_OK;
    SKG_TRY(read_reference(r, xml, &index, id));
    return skg_instances_place_named(&r->parts, is_item ? 0 : part, skg_instances_key((uint64_t)index, id),
                                     0);
}

/* Lists the objects of a part. part: 0 outside of objects that are printed */
static skg_status list_objects(reader *r, int64_t index) {
    skg_xml xml = {.at = r->models[index].text};
    int found, is_model = 0;
    int64_t part = 0;
    while ((found = skg_xml_next(&xml)) > 0) {
        if (xml.opens && skg_xml_is(&xml, "model")) {
            SKG_TRY(read_unit(r, &xml, &r->models[index].mm));
            is_model = 1;
        }
        if (xml.opens && skg_xml_is(&xml, "object")) {
            SKG_TRY(list_object(r, index, &xml, &part));
            if (r->parts.nodes[part].own == 0) part = 0;
        }
        if (xml.opens) SKG_TRY(count_tag(r, index, &xml, part));
        if (xml.closes && skg_xml_is(&xml, "object")) part = 0;
    }
    if (found < 0 || !is_model) return damaged(r, "the XML of a part is damaged");
    return SKG_OK;
}

static skg_status read_model(reader *r, int64_t index) {
    char name[LONGEST], *text = NULL;
    memcpy(name, r->models[index].name, sizeof name);
    SKG_TRY(*name ? skg_archive_read(r->path, name, 1, &text)
                  : skg_archive_read_model(r->path, (char[SKG_RELATION_MAX]){0}, &text));
    if (!text)
        return skg_fail(SKG_ERR_FORMAT, "%s: its objects name the part \"%s\", which is not there", r->path,
                        name);
    r->models[index].text = text;
    return list_objects(r, index);
}

static int read_numbers(const char *text, int count, double *numbers) {
    char *end;
    for (int k = 0; k < count; k++, text = end) {
        numbers[k] = strtod(text, &end);
        if (end == text) return 0;
    }
    return skg_all_finite(numbers, count);
}

/* The transform of a component or an item: rows of 4 x 3 numbers that multiply (x, y, z, 1) from the right. */
static skg_status read_transform(const reader *r, const skg_xml *xml, const double above[16],
                                 double pose[16]) {
    char text[1024];
    double n[12], own[16];
    const int found = skg_xml_attribute(xml, "transform", text, sizeof text);
    if (found == 0) {
        memcpy(pose, above, 16 * sizeof *pose);
        return SKG_OK;
    }
    if (found < 0 || !read_numbers(text, 12, n)) return damaged(r, "a transform is twelve numbers");
    skg_pose_identity(own);
    for (int row = 0; row < 3; row++)
        for (int k = 0; k < 4; k++) own[4 * row + k] = n[3 * k + row];
    skg_pose_multiply(above, own, pose);
    return SKG_OK;
}

static int number_of(const skg_xml *xml, const char *name, double *number) {
    char text[64];
    char *end;
    if (skg_xml_attribute(xml, name, text, sizeof text) <= 0) return 0;
    *number = strtod(text, &end);
    return end != text && *end == '\0';
}

static skg_status add_vertex(const reader *r, const skg_xml *xml, const double pose[16]) {
    double p[3];
    if (!number_of(xml, "x", &p[0]) || !number_of(xml, "y", &p[1]) || !number_of(xml, "z", &p[2]))
        return damaged(r, "a vertex needs the numbers x, y and z");
    skg_pose_point(pose, p, p);
    return skg_mesh_add_vertex(r->arrays, p);
}

/* A mirrored triangle turns its winding. */
static skg_status add_triangle(const reader *r, const skg_xml *xml, int64_t base, int mirrored) {
    static const char *const names[] = {"v1", "v2", "v3"};
    skg_polygon polygon = {0};
    for (int k = 0; k < 3; k++) {
        double v = 0;
        if (!number_of(xml, names[mirrored ? 2 - k : k], &v) || v < 0 || v != (double)(int64_t)v ||
            base + (int64_t)v >= r->arrays->vertices)
            return damaged(r, "a triangle names a vertex that its mesh has not");
        SKG_TRY(skg_mesh_add_corner(r->arrays, &polygon, base + (int64_t)v));
    }
    return SKG_OK;
}

static skg_status add_object(reader *r, int64_t index, const char *id, const double pose[16], int depth);

static skg_status add_component(reader *r, int64_t index, const skg_xml *xml, const double pose[16],
                                int depth) {
    char id[32];
    double own[16];
    SKG_TRY(read_reference(r, xml, &index, id));
    SKG_TRY(read_transform(r, xml, pose, own));
    return add_object(r, index, id, own, depth + 1);
}

/* Adds what stands within the tag of an object. */
static skg_status add_contents(reader *r, int64_t index, const object *o, const double pose[16], int depth) {
    const int64_t base = r->arrays->vertices;
    const int mirrored = skg_pose_determinant(pose) < 0;
    double placed[16];
    skg_pose_scaling(1, 1, 1, placed);
    for (int k = 0; k < 16; k++)
        placed[k] = pose[k] * (k % 4 < 3 && k < 12 ? r->models[index].mm / r->root_mm : 1);
    skg_xml xml = {.at = o->at};
    while (!o->empty && skg_xml_next(&xml) > 0 && !skg_xml_is(&xml, "object")) {
        if (!xml.opens) continue;
        if (skg_xml_is(&xml, "vertex")) SKG_TRY(add_vertex(r, &xml, placed));
        if (skg_xml_is(&xml, "triangle")) SKG_TRY(add_triangle(r, &xml, base, mirrored));
        if (skg_xml_is(&xml, "component")) SKG_TRY(add_component(r, index, &xml, pose, depth));
    }
    return SKG_OK;
}

static skg_status add_object(reader *r, int64_t index, const char *id, const double pose[16], int depth) {
    const model *m = &r->models[index];
    for (int64_t i = 0; i < m->count; i++) {
        if (strcmp(m->objects[i].id, id) != 0) continue;
        const object o = m->objects[i];
        if (o.other) {
            r->arrays->not_printed++;
            return SKG_OK;
        }
        SKG_TRY(depth == 0 ? skg_mesh_begin_object(r->arrays, o.name)
                           : skg_mesh_begin_group(r->arrays, o.name));
        return add_contents(r, index, &o, pose, depth);
    }
    return skg_fail(SKG_ERR_FORMAT, "%s: it is made of the object %s, which is not there", r->path, id);
}

/* Lists and counts all objects, before the first is added. */
static skg_status read_models(reader *r) {
    int64_t whole = 0, root = 0;
    r->parts = (skg_instances){.path = r->path, .kind = "object", .size = r->size, .deepest = DEEPEST};
    SKG_TRY(skg_instances_add(&r->parts, "build", 0, &whole));
    SKG_TRY(find_model(r, "", &root));
    for (int64_t i = 0; i < r->count; i++) SKG_TRY(read_model(r, i));
    return skg_instances_check(&r->parts);
}

static skg_status read_build(reader *r) {
    const int64_t root = 0;
    double identity[16];
    skg_pose_identity(identity);
    SKG_TRY(read_models(r));
    r->root_mm = r->arrays->file_unit_mm = r->models[root].mm;
    skg_xml xml = {.at = r->models[root].text};
    while (skg_xml_next(&xml) > 0)
        if (xml.opens && skg_xml_is(&xml, "item")) SKG_TRY(add_component(r, root, &xml, identity, -1));
    return SKG_OK;
}

skg_status skg_mesh_read_3mf(FILE *stream, const char *path, int64_t size, skg_mesh_arrays *arrays) {
    reader r = {.path = path, .size = size, .arrays = arrays};
    SKG_TRY(skg_archive_check(path, stream));
    const skg_status status = read_build(&r);
    for (int64_t i = 0; i < r.count; i++) {
        skg_free(&r.models[i].text);
        skg_free(&r.models[i].objects);
    }
    skg_free(&r.models);
    skg_instances_free(&r.parts);
    return status;
}
