/* The thorax as files. */
#include "core/files.h"
#include "core/text.h"
#include "phantom/makers.h"

#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static skg_status path_of(const char *folder, const char *label, const char *extension, char **path) {
    size_t size = strlen(folder) + strlen(label) + strlen(extension) + 2;
    SKG_TRY(skg_alloc((int64_t)size, 1, "path", path));
    snprintf(*path, size, "%s/%s%s", folder, label, extension);
    for (char *c = *path + strlen(folder) + 1; *c; c++)
        if (*c == ' ') *c = '-';
    return SKG_OK;
}

static void write_sample(const skg_thorax *thorax, int64_t i, FILE *f) {
    char file[48];
    snprintf(file, sizeof file, "%s.ply", thorax->part[i].label);
    for (char *c = file; *c; c++)
        if (*c == ' ') *c = '-';
    fprintf(f, "        {\"Label\": \"%s\", \"Path\": \"%s\", \"Unit\": \"mm\", ", thorax->part[i].label,
            file);
    int64_t inside = thorax->part[i].inside;
    if (inside >= 0)
        fprintf(f, "\"Parent\": \"%s\", ", thorax->part[inside].label);
    else
        fprintf(f, "\"Parent\": null, ");
    if (thorax->part[i].material)
        fprintf(f, "\"Material\": \"%s\"", thorax->part[i].material);
    else
        fprintf(f, "\"Material\": [\"HU\", %g]", thorax->part[i].hounsfield);
    if (thorax->part[i].through) fprintf(f, ", \"Through\": true");
    if (thorax->part[i].density > 0) fprintf(f, ", \"Density\": %g", thorax->part[i].density);
    fprintf(f, i + 1 < thorax->parts ? "},\n" : "}\n");
}

/* The source is in front of the patient, the detector behind the back, and rows go from head to foot, so that the
 * patient's right is on the viewer's left. The events: the breath is held at end-expiration (2.4 s is phase 0.6 of
 * "quiet") while the needle is inserted 110 mm deep; then breathing is shallow, and the ducts fill while the needle
 * is drawn back. */
static void write_scene(const skg_thorax *thorax, FILE *f) {
    fprintf(
        f,
        "{\n"
        "    \"$schema\": \"scene.schema.json\",\n"
        "    \"Source\": {\n"
        "        \"Position\": [0, -860, -20, \"mm\"],\n"
        "        \"Shape\": \"PointSource\",\n"
        "        \"Beam\": {\"kVp\": 80, \"Filter\": [[\"Al\", 3.5, \"mm\"], [\"Cu\", 0.1, \"mm\"]]}\n"
        "    },\n"
        "    \"Tolerance\": 0.01,\n"
        "    \"Detector\": {\n"
        "        \"Position\": [0, 140, -20, \"mm\"],\n"
        "        \"UpVector\": [0, 0, -1],\n"
        "        \"RightVector\": [1, 0, 0],\n"
        "        \"NumberOfPixels\": [512, 512],\n"
        "        \"Size\": [480, 480, \"mm\"],\n"
        "        \"Scintillator\": {\"Material\": \"CsI\", \"Thickness\": 600, \"Unit\": \"um\", \"Packing\": 0.8}\n"
        "    },\n"
        "    \"Samples\": [\n");
    for (int64_t i = 0; i < thorax->parts; i++) write_sample(thorax, i, f);
    fprintf(f, "    ],\n"
               "    \"Breathing\": {\n"
               "        \"Pattern\": \"quiet\",\n"
               "        \"Reference\": 0,\n"
               "        \"Events\": [\n"
               "            {\"Hold\": [2.4, 6.4]},\n"
               "            {\"Weight\": [[2.4, 1], [6.4, 0.3]]},\n"
               "            {\"Needle\": [[2.6, -20], [6.2, 110], [8, 110], [11.5, -20]]},\n"
               "            {\"Contrast\": \"bile ducts\", \"Share\": [[6.4, 0], [9, 1]]},\n"
               "            {\"Contrast\": \"common bile duct\", \"Share\": [[7.5, 0], [10.5, 1]]}\n"
               "        ]\n"
               "    }\n}\n");
}

/* Writes a file of the folder, and says in *is_new whether there was none before. part: its number; the number of parts: the scene. */
static skg_status save_file(const skg_thorax *thorax, int64_t part, const char *folder, char **path,
                            int *is_new) {
    struct stat there;
    skg_output_file file;
    const int is_scene = part == thorax->parts;
    *is_new = 0;
    SKG_TRY(
        path_of(folder, is_scene ? "thorax" : thorax->part[part].label, is_scene ? ".json" : ".ply", path));
    const int was_there = stat(*path, &there) == 0;
    if (is_scene) {
        SKG_TRY(skg_output_open(*path, &file));
        write_scene(thorax, file.stream);
        SKG_TRY(skg_output_commit(&file));
    } else {
        SKG_TRY(skg_mesh_save(thorax->part[part].mesh, *path));
    }
    *is_new = !was_there;
    return SKG_OK;
}

/* A save that fails removes its files, except those that replaced older ones. */
skg_status skg_thorax_save(const skg_thorax *thorax, const char *folder) {
    SKG_PLAIN;
    SKG_NEEDS(thorax);
    SKG_NEEDS(folder);
    char **paths = NULL;
    int *is_new = NULL;
    const int64_t files = thorax->parts + 1;
    skg_status status = skg_alloc(files, sizeof *paths, "paths", &paths);
    if (status == SKG_OK) status = skg_alloc(files, sizeof *is_new, "paths", &is_new);
    for (int64_t i = 0; i < files && status == SKG_OK; i++)
        status = save_file(thorax, i, folder, &paths[i], &is_new[i]);
    for (int64_t i = 0; paths && is_new && i < files; i++) {
        if (status != SKG_OK && is_new[i]) unlink(paths[i]);
        skg_free(&paths[i]);
    }
    skg_free(&is_new);
    skg_free(&paths);
    return status;
}
