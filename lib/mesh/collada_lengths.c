/* Holds the lengths that arrays and accessors of a COLLADA file announce against their numbers: Assimp takes memory for what an
 * array announces, and reads behind its end where an accessor announces more. */
#include "mesh/collada_lengths.h"

#include "mesh/instances.h"
#include "mesh/xml.h"

#include <stdlib.h>
#include <string.h>

enum { LONGEST = 1024 }; /* of a name */

typedef struct {
    uint64_t key;
    double count;
} array;

typedef struct {
    const char *path;
    array *arrays;
    int64_t count, capacity;
} arrays;

static int is_array(const skg_xml *xml) {
    return skg_xml_is(xml, "float_array") || skg_xml_is(xml, "int_array") || skg_xml_is(xml, "Name_array") ||
           skg_xml_is(xml, "IDREF_array") || skg_xml_is(xml, "bool_array");
}

/* A number of an element that is none or more; missing: what it is then. */
static double number_of(const skg_xml *xml, const char *name, double missing) {
    char text[64];
    if (skg_xml_attribute(xml, name, text, sizeof text) <= 0) return missing;
    const double number = strtod(text, NULL);
    return number > 0 ? number : 0;
}

/* A value takes a character, and another one parts it from the next. */
static skg_status add_array(arrays *all, const skg_xml *xml) {
    char id[LONGEST] = "";
    const double count = number_of(xml, "count", 0), room = xml->closes ? 0 : (double)strcspn(xml->at, "<");
    skg_xml_attribute(xml, "id", id, sizeof id);
    if (2 * count > room + 1)
        return skg_fail(
            SKG_ERR_FORMAT,
            "%s: no valid COLLADA file: the array \"%s\" has %.15g values by its count, and %.15g characters; save "
            "the file anew with the program that made it",
            all->path, id, count, room);
    if (all->count == all->capacity) {
        all->capacity = 2 * all->capacity + 16;
        SKG_TRY(skg_realloc(all->capacity, sizeof *all->arrays, all->path, &all->arrays));
    }
    all->arrays[all->count++] = (array){skg_instances_key(0, id), count};
    return SKG_OK;
}

static int by_key(const void *a, const void *b) {
    const array *one = a, *two = b;
    if (one->key != two->key) return one->key < two->key ? -1 : 1;
    return (one->count > two->count) - (one->count < two->count);
}

/* Of arrays of one name the shortest counts. */
static skg_status check_accessor(const arrays *all, const skg_xml *xml) {
    char id[LONGEST] = "";
    if (skg_xml_attribute(xml, "source", id, sizeof id) <= 0) return SKG_OK;
    const char *name = id + (*id == '#');
    const uint64_t key = skg_instances_key(0, name);
    const double count = number_of(xml, "count", 0), stride = number_of(xml, "stride", 1);
    const double needs = count > 0 ? number_of(xml, "offset", 0) + count * stride : 0;
    int64_t low = 0, high = all->count;
    while (low < high) {
        const int64_t middle = (low + high) / 2;
        if (all->arrays[middle].key < key)
            low = middle + 1;
        else
            high = middle;
    }
    if (low == all->count || all->arrays[low].key != key || needs <= all->arrays[low].count) return SKG_OK;
    return skg_fail(
        SKG_ERR_FORMAT,
        "%s: no valid COLLADA file: an accessor needs %.15g values of the array \"%s\", which has %.15g; "
        "save the file anew with the program that made it",
        all->path, needs, name, all->arrays[low].count);
}

static skg_status check(arrays *all, const char *text) {
    skg_xml xml = {.at = text};
    while (skg_xml_next(&xml) > 0)
        if (xml.opens && is_array(&xml)) SKG_TRY(add_array(all, &xml));
    if (all->count > 0) qsort(all->arrays, (size_t)all->count, sizeof *all->arrays, by_key);
    xml = (skg_xml){.at = text};
    while (skg_xml_next(&xml) > 0)
        if (xml.opens && skg_xml_is(&xml, "accessor")) SKG_TRY(check_accessor(all, &xml));
    return SKG_OK;
}

skg_status skg_mesh_check_collada_lengths(const char *path, const char *text) {
    arrays all = {.path = path};
    const skg_status status = check(&all, text);
    skg_free(&all.arrays);
    return status;
}
