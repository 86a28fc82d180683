/* The geometry of a scan as files that reconstruction tools read. */
#include "core/files.h"
#include "core/text.h"
#include "trajectory/writers.h"

#include <string.h>

static skg_status write_table(const skg_scan *scan, FILE *stream) {
    fprintf(stream, "# source x y z, detector centre x y z, column step x y z, row step x y z (mm)\n");
    for (int64_t k = 0; k < scan->options.projections; k++) {
        skg_view view;
        skg_view_init(&view);
        SKG_TRY(skg_scan_view_get(scan, k, &view));
        const double *rows[] = {view.source, view.centre, view.column_step, view.row_step};
        for (int i = 0; i < SKG_POSE_NUMBERS; i++)
            fprintf(stream, "%s%.17g", i ? ", " : "", rows[i / 3][i % 3]);
        fputc('\n', stream);
    }
    return SKG_OK;
}

/* In the order in which they are tried: a longer ending before one that it ends in. */
static const struct {
    const char *ending;
    skg_status (*write)(const skg_scan *scan, FILE *stream);
} formats[] = {{".tigre.py", skg_scan_write_tigre},
               {".cil.py", skg_scan_write_cil},
               {"transforms.json", skg_scan_write_nerf},
               {".csv", write_table},
               {".xml", skg_scan_write_rtk}};

skg_status skg_scan_geometry_save(const skg_scan *scan, const char *path) {
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
    if (status == SKG_OK) return skg_output_commit(&file);
    skg_output_discard(&file);
    return status;
}
