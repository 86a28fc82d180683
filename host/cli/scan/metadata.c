/* The metadata file of a scan in the layout of CTSimU. */
#define _XOPEN_SOURCE 700 /* realpath */

#include "scan/steps.h"

#include "common/encode.h"
#include "common/file.h"
#include "common/say.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

/* "scan_%04d.tif"; of a single field "scan_flat.tif". */
static json_t *pattern(const cli_acquisition *a, const char *kind, int64_t count) {
    char name[512];
    snprintf(name, sizeof name, "%s%s%s.tif", a->stem, kind, count == 1 && *kind ? "" : "_%04d");
    return count > 0 ? cli_json_text(name) : json_null();
}

static json_t *fields(const cli_acquisition *a, const char *kind, int64_t count, int64_t frames) {
    return json_pack("{s:I, s:o, s:o, s:b}", "number", (json_int_t)count, "frame_average",
                     count > 0 ? json_integer(frames) : json_null(), "filename", pattern(a, kind, count),
                     "projections_corrected", 0);
}

static double length(const double *v) {
    return sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

static json_t *value(double number, const char *unit) {
    return json_pack("{s:f, s:s}", "value", number, "unit", unit);
}

static json_t *whole(int64_t pixels) {
    return json_pack("{s:I, s:s}", "value", (json_int_t)pixels, "unit", "px");
}

static json_t *projections(const cli_acquisition *a) {
    const skg_view *view = &a->session.view;
    json_t *object = json_object();
    json_object_set_new(object, "filename", pattern(a, "", a->whole_projections));
    json_object_set_new(object, "number", json_integer(a->whole_projections));
    json_object_set_new(object, "frame_average", json_integer(a->readout.frames));
    json_object_set_new(object, "max_intensity", cli_json_number(a->readout.full));
    json_object_set_new(object, "datatype", cli_json_text(a->readout.bits ? "uint16" : "float32"));
    json_object_set_new(object, "byteorder", cli_json_text("little"));
    json_object_set_new(object, "headersize", json_null());
    json_object_set_new(object, "dimensions",
                        json_pack("{s:o, s:o}", "x", whole(view->columns), "y", whole(view->rows)));
    json_object_set_new(object, "pixelsize",
                        json_pack("{s:o, s:o}", "x", value(length(view->column_step), "mm"), "y",
                                  value(length(view->row_step), "mm")));
    json_object_set_new(object, "dark_field", fields(a, "_dark", a->darks, a->record.dark_frames));
    json_object_set_new(object, "flat_field", fields(a, "_flat", a->flats, a->record.flat_frames));
    return object;
}

static json_t *describe(const cli_acquisition *a) {
    char date[16] = "", *full = realpath(a->session.path, NULL);
    const time_t now = time(NULL);
    struct tm day;
    if (gmtime_r(&now, &day)) strftime(date, sizeof date, "%Y-%m-%d", &day);
    json_t *file = json_pack("{s:o, s:s, s:s, s:s, s:s, s:{s:i, s:i}, s:s, s:{s:i, s:i}}", "name",
                             cli_json_text(a->stem), "description", "", "contact", "", "date_created", date,
                             "date_changed", date, "version", "major", 1, "minor", 0, "file_type",
                             "CTSimU Metadata", "file_format_version", "major", 1, "minor", 2);
    json_t *output = json_pack("{s:s, s:s, s:o, s:n}", "system", "skiagraph " SKG_VERSION, "date_measured",
                               date, "projections", projections(a), "tomogram");
    json_t *geometry =
        json_pack("{s:o}", "path_to_CTSimU_JSON", cli_json_text(full ? full : a->session.path));
    free(full);
    return json_pack("{s:o, s:o, s:o, s:n}", "file", file, "output", output, "acquisition_geometry", geometry,
                     "reconstruction");
}

int metadata_write(const cli_acquisition *a) {
    json_t *object = describe(a);
    char *text = object ? json_dumps(object, JSON_INDENT(4)) : NULL;
    char *path = cli_path_in(a->place, "%s_metadata.json", a->stem);
    const int exit_status = text && path ? cli_write_file(path, text, strlen(text))
                                         : cli_error(CLI_DEVICE, "out of host memory for metadata");
    json_decref(object);
    free(text);
    free(path);
    return exit_status;
}
