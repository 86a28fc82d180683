/* The geometry of a scan as files that reconstruction tools read. */
#include "core/files.h"
#include "core/text.h"
#include "trajectory/writers.h"

#include <string.h>

enum { NOTE_LENGTH = 1024 };

const char *const skg_scan_table_beams[] = {[SKG_PROJECTION_POINT] = "source",
                                            [SKG_PROJECTION_PARALLEL] = "parallel beam: source",
                                            [SKG_PROJECTION_PARALLEL_FROM_INFINITY] =
                                                "parallel beam from infinity: direction"};

static skg_status write_table(const skg_scan *scan, FILE *stream) {
    fprintf(stream, "# %s x y z, detector centre x y z, column step x y z, row step x y z%s (mm)\n",
            skg_scan_table_beams[scan->view.projection], scan->view.radius > 0 ? ", radius" : "");
    for (int64_t k = 0; k < scan->options.projections; k++) {
        skg_view view;
        skg_view_init(&view);
        SKG_TRY(skg_scan_view_get(scan, k, &view));
        const double *rows[] = {view.source, view.centre, view.column_step, view.row_step};
        for (int i = 0; i < SKG_POSE_NUMBERS; i++)
            fprintf(stream, "%s%.17g", i ? ", " : "", rows[i / 3][i % 3]);
        if (view.radius > 0) fprintf(stream, ", %.17g", view.radius); /* as cyl_cone_vec of ASTRA has it */
        fputc('\n', stream);
    }
    return SKG_OK;
}

/* A comment of one line. Two hyphens would end a comment of XML. */
static void write_note(const char *format, const char *note, FILE *stream) {
    char line[NOTE_LENGTH];
    size_t count = 0;
    for (; note[count] && count + 1 < sizeof line; count++)
        line[count] = (unsigned char)note[count] < ' ' || (note[count] == '-' && note[count + 1] == '-')
                          ? '_'
                          : note[count];
    line[count] = '\0';
    fprintf(stream, format, line);
}

/* In the order in which they are tried: a longer ending before one that it ends in. */
static const struct {
    const char *ending;
    skg_status (*write)(const skg_scan *scan, FILE *stream);
    const char *note; /* a comment at the end, as printf wants it; NULL: the format has none */
} formats[] = {{".tigre.py", skg_scan_write_tigre, "# %s\n"},
               {".cil.py", skg_scan_write_cil, "# %s\n"},
               {"transforms.json", skg_scan_write_nerf, NULL},
               {".csv", write_table, "# %s\n"},
               {".xml", skg_scan_write_rtk, "<!-- %s -->\n"}};

skg_status skg_scan_geometry_save(const skg_scan *scan, const char *path) {
    return skg_scan_geometry_save_noted(scan, path, NULL);
}

skg_status skg_scan_geometry_save_noted(const skg_scan *scan, const char *path, const char *note) {
    SKG_PLAIN;
    skg_output_file file;
    size_t f = 0;
    SKG_NEEDS(scan);
    SKG_NEEDS(path);
    for (; f < sizeof formats / sizeof *formats; f++) {
        const size_t length = strlen(path), ending = strlen(formats[f].ending);
        if (length >= ending && skg_same_name(path + length - ending, formats[f].ending)) break;
    }
    if (f == sizeof formats / sizeof *formats)
        return skg_fail(SKG_ERR_ARGUMENT,
                        "%s: a geometry is written to a .csv, or, for RTK, an .xml, for TIGRE, a .tigre.py, "
                        "for CIL, a .cil.py, for NeRF, a transforms.json",
                        path);
    SKG_TRY(skg_output_open(path, &file));
    skg_status status = formats[f].write(scan, file.stream);
    if (status == SKG_OK && note && formats[f].note) write_note(formats[f].note, note, file.stream);
    if (status == SKG_OK) return skg_output_commit(&file);
    skg_output_discard(&file);
    return status;
}
