/* 3MF: objects with meshes, objects that are made of others, and the items that are built, also where objects lie in other parts of
 * the archive (the production extension: Bambu Studio, Orca). Each built object is a named piece. */
#include "mesh/read.h"

#include "core/core.h"
#include "core/maths.h"
#include "core/text.h"
#include "mesh/archive.h"
#include "mesh/relations.h"
#include "mesh/xml.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { DEEPEST = 32, LONGEST = SKG_RELATION_MAX, MOST = 1000000 };

typedef struct {
    char id[32];
    int32_t other;  /* 1: it supports others, and is not printed */
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
    FILE *stream;
    int64_t size;
    model *models;
    int64_t count;
    double root_mm;
    int64_t added; /* objects, of which one may be made of many */
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

/* Lists the objects of a part. */
static skg_status list_objects(const reader *r, model *m) {
    skg_xml xml = {.at = m->text};
    char type[32];
    int found, is_model = 0;
    while ((found = skg_xml_next(&xml)) > 0) {
        if (!xml.opens) continue;
        if (skg_xml_is(&xml, "model")) {
            SKG_TRY(read_unit(r, &xml, &m->mm));
            is_model = 1;
        }
        if (!skg_xml_is(&xml, "object")) continue;
        if (m->count == m->capacity) {
            m->capacity = 2 * m->capacity + 16;
            SKG_TRY(skg_realloc(m->capacity, sizeof *m->objects, r->path, &m->objects));
        }
        object *o = &m->objects[m->count++];
        *o = (object){.at = xml.at};
        if (skg_xml_attribute(&xml, "id", o->id, sizeof o->id) <= 0) return damaged(r, "an object has no id");
        if (skg_xml_attribute(&xml, "name", o->name, sizeof o->name) <= 0 || !*o->name)
            snprintf(o->name, sizeof o->name, "object %s", o->id);
        o->other = skg_xml_attribute(&xml, "type", type, sizeof type) > 0 &&
                   (strcmp(type, "support") == 0 || strcmp(type, "other") == 0);
    }
    if (found < 0 || !is_model) return damaged(r, "the XML of a part is damaged");
    return SKG_OK;
}

/* The part of this name, read if it was not yet. */
static skg_status find_model(reader *r, const char *name, int64_t *index) {
    for (int64_t i = 0; i < r->count; i++)
        if (strcmp(r->models[i].name, name) == 0) {
            *index = i;
            return SKG_OK;
        }
    SKG_TRY(skg_realloc(r->count + 1, sizeof *r->models, r->path, &r->models));
    model *m = &r->models[r->count];
    *m = (model){0};
    snprintf(m->name, sizeof m->name, "%s", name);
    *index = r->count++;
    if (*name)
        SKG_TRY(skg_archive_read(r->path, r->stream, r->size, name, 1, &m->text));
    else
        SKG_TRY(skg_archive_read_model(r->path, r->stream, r->size, (char[SKG_RELATION_MAX]){0}, &m->text));
    if (!m->text)
        return skg_fail(SKG_ERR_FORMAT, "%s: its objects name the part \"%s\", which is not there", r->path,
                        name);
    return list_objects(r, m);
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
    char id[32], path[LONGEST];
    double own[16];
    const int found = skg_xml_attribute(xml, "path", path, sizeof path);
    if (found < 0 || skg_xml_attribute(xml, "objectid", id, sizeof id) <= 0)
        return damaged(r, "a component or an item names no object");
    SKG_TRY(read_transform(r, xml, pose, own));
    if (found > 0) SKG_TRY(find_model(r, path, &index));
    return add_object(r, index, id, own, depth + 1);
}

/* Adds what stands within the tag of an object. The model may move while others are read: it is named by its index. */
static skg_status add_contents(reader *r, int64_t index, const object *o, const double pose[16], int depth) {
    const int64_t base = r->arrays->vertices;
    const int mirrored = skg_pose_determinant(pose) < 0;
    double placed[16];
    skg_pose_scaling(1, 1, 1, placed);
    for (int k = 0; k < 16; k++)
        placed[k] = pose[k] * (k % 4 < 3 && k < 12 ? r->models[index].mm / r->root_mm : 1);
    skg_xml xml = {.at = o->at};
    while (skg_xml_next(&xml) > 0 && !(xml.closes && skg_xml_is(&xml, "object"))) {
        if (!xml.opens) continue;
        if (skg_xml_is(&xml, "vertex")) SKG_TRY(add_vertex(r, &xml, placed));
        if (skg_xml_is(&xml, "triangle")) SKG_TRY(add_triangle(r, &xml, base, mirrored));
        if (skg_xml_is(&xml, "component")) SKG_TRY(add_component(r, index, &xml, pose, depth));
    }
    return SKG_OK;
}

static skg_status add_object(reader *r, int64_t index, const char *id, const double pose[16], int depth) {
    if (depth > DEEPEST || ++r->added > MOST) return damaged(r, "its objects are made of each other");
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

static skg_status read_build(reader *r) {
    int64_t root = 0;
    double identity[16];
    skg_pose_identity(identity);
    SKG_TRY(find_model(r, "", &root));
    r->root_mm = r->arrays->file_unit_mm = r->models[root].mm;
    skg_xml xml = {.at = r->models[root].text};
    while (skg_xml_next(&xml) > 0)
        if (xml.opens && skg_xml_is(&xml, "item")) SKG_TRY(add_component(r, root, &xml, identity, -1));
    return SKG_OK;
}

skg_status skg_mesh_read_3mf(FILE *stream, const char *path, int64_t size, skg_mesh_arrays *arrays) {
    reader r = {.path = path, .stream = stream, .size = size, .arrays = arrays};
    SKG_TRY(skg_archive_check(path, stream, size));
    const skg_status status = read_build(&r);
    for (int64_t i = 0; i < r.count; i++) {
        skg_free(&r.models[i].text);
        skg_free(&r.models[i].objects);
    }
    skg_free(&r.models);
    return status;
}
