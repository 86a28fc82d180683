/* The unit of length that a mesh file carries, of the formats that Assimp reads. Assimp itself uses COLLADA's only, and says FBX's. */
#include "mesh/file_unit.h"

#include "core/core.h"
#include "core/text.h"
#include "mesh/archive.h"
#include "mesh/xml.h"

#include <assimp/scene.h>
#include <stdlib.h>
#include <string.h>

/* The heads of files in which units stand: the rest is not read here. */
enum { HEAD = 1 << 20 };

static int is_one_of(const char *dot, const char *const *extensions) {
    for (; *extensions; extensions++)
        if (skg_same_name(dot, *extensions)) return 1;
    return 0;
}

/* A length in metres, in mm; none: a metre; -1: it is no length. */
static double mm_of(const skg_xml *xml, const char *name) {
    char text[64], *end;
    const int found = skg_xml_attribute(xml, name, text, sizeof text);
    if (found == 0) return 1000;
    const double number = found > 0 ? strtod(text, &end) : 0;
    return number > 0 && end != text && *end == '\0' && number < 1e12 ? 1000 * number : -1;
}

/* <unit meter="0.001"/> in the first <asset>; without it, a metre (COLLADA 1.4.1, "asset"). */
static double of_collada(skg_xml *xml) {
    while (skg_xml_next(xml) > 0 && !(xml->closes && skg_xml_is(xml, "asset")))
        if (xml->opens && skg_xml_is(xml, "unit")) return mm_of(xml, "meter");
    return 1000;
}

/* <unit category="length" conversionFactor="0.001"/>; without it, a metre (ISO/IEC 19775-1). */
static double of_x3d(skg_xml *xml) {
    char category[32];
    while (skg_xml_next(xml) > 0 && !(xml->opens && skg_xml_is(xml, "Scene")))
        if (xml->opens && skg_xml_is(xml, "unit") &&
            skg_xml_attribute(xml, "category", category, sizeof category) > 0 &&
            strcmp(category, "length") == 0)
            return mm_of(xml, "conversionFactor");
    return 1000;
}

/* <amf unit="inch">; without it, a millimetre (ISO/ASTM 52915). */
static double of_amf(skg_xml *xml) {
    static const struct {
        const char *name;
        double mm;
    } units[] = {{"millimeter", 1}, {"inch", 25.4}, {"feet", 304.8}, {"meter", 1000}, {"micron", 1e-3}};
    char name[32];
    while (skg_xml_next(xml) > 0)
        if (xml->opens && skg_xml_is(xml, "amf")) {
            if (skg_xml_attribute(xml, "unit", name, sizeof name) <= 0) return 1;
            for (size_t k = 0; k < sizeof units / sizeof *units; k++)
                if (skg_same_name(name, units[k].name)) return units[k].mm;
        }
    return 1;
}

/* The head of a text file, or of the part of an archive that ends as it should. */
static skg_status read_head(const char *path, FILE *stream, int64_t size, const char *part, char **head) {
    if (skg_archive_is(stream)) return skg_archive_read(path, part, 0, head);
    const int64_t most = size < HEAD ? size : HEAD;
    SKG_TRY(skg_alloc(most + 1, 1, path, head));
    if (fseek(stream, 0, SEEK_SET) != 0 || fread(*head, 1, (size_t)most, stream) != (size_t)most)
        **head = '\0';
    return SKG_OK;
}

int skg_mesh_is_collada(const char *path) {
    static const char *const collada[] = {".dae", ".zae", NULL};
    const char *dot = strrchr(path, '.');
    return dot && is_one_of(dot, collada);
}

skg_status skg_mesh_file_unit(const char *path, FILE *stream, int64_t size, int is_named, double *mm) {
    static const char *const metres[] = {".gltf", ".glb", ".vrm", ".x3db", NULL};
    static const char *const x3d[] = {".x3d", ".x3dz", NULL}, *const amf[] = {".amf", NULL};
    const char *dot = strrchr(path, '.');
    char *head = NULL;
    *mm = 0;
    if (!dot) return SKG_OK;
    if (is_one_of(dot, metres)) *mm = 1000;
    const int is_collada = skg_mesh_is_collada(path), is_x3d = is_one_of(dot, x3d);
    if (!is_collada && !is_x3d && !is_one_of(dot, amf)) return SKG_OK;
    SKG_TRY(read_head(path, stream, size, is_collada ? ".dae" : is_x3d ? ".x3d" : ".amf", &head));
    skg_xml xml = {.at = head ? head : ""};
    *mm = is_collada ? of_collada(&xml) : is_x3d ? of_x3d(&xml) : of_amf(&xml);
    skg_free(&head);
    if (*mm > 0) return SKG_OK;
    *mm = 0;
    if (is_named) return SKG_OK;
    return skg_fail(
        SKG_ERR_FORMAT,
        "%s: the %s of its <unit> is no length above 0; correct it, with a point for decimals, or name the "
        "unit (Unit in a scene file, --unit, unit_mm)",
        path, is_collada ? "meter" : "conversionFactor");
}

/* FBX: centimetres per unit. */
double skg_mesh_scene_unit(const struct aiScene *scene) {
    const struct aiMetadata *data = scene->mMetaData;
    for (unsigned i = 0; data && i < data->mNumProperties; i++) {
        const struct aiMetadataEntry *entry = &data->mValues[i];
        double factor = 0;
        if (strcmp(data->mKeys[i].data, "UnitScaleFactor") != 0) continue;
        if (entry->mType == AI_DOUBLE) memcpy(&factor, entry->mData, sizeof factor);
        if (entry->mType == AI_FLOAT) {
            float single;
            memcpy(&single, entry->mData, sizeof single);
            factor = (double)single;
        }
        if (factor > 0 && factor < 1e12) return 10 * factor;
    }
    return 0;
}
