/* A scan for failing_test: run, files, packed copy, reading back. */
#include "hard/failing_scan.h"

#include <skiagraph/scan_reader.h>
#include <skiagraph/scan_run.h>

#include <stdio.h>

enum { PROJECTIONS = 4, PIXELS = 24 * 18 };

static const char hash[] = "00112233445566778899aabbccddeeff00112233445566778899aabbccddeeff";

#define TRY(call)                                                                                            \
    do {                                                                                                     \
        skg_status try_status = (call);                                                                      \
        if (try_status < 0) return try_status;                                                               \
    } while (0)

/* Two projections from the beginning, the others added. */
static skg_status write_batches(skg_scan_run *run, skg_scan_file *file) {
    static const int64_t late[] = {2, 3};
    skg_scan_batch batch;
    skg_scan_batch_init(&batch);
    TRY(skg_scan_run_add(run, 2, late));
    for (;;) {
        TRY(skg_scan_run_next(run, &batch));
        if (batch.count == 0) return SKG_OK;
        TRY(skg_scan_file_write(file, batch.count, batch.indices, batch.images, batch.phases));
    }
}

static skg_status fill(skg_plan *plan, const skg_scene *scene, skg_scan *scan, skg_scan_file *file) {
    static const float dark[PIXELS];
    static const int64_t first[] = {0, 1};
    static float white[PIXELS];
    skg_scan_run_options options;
    skg_scan_run *run = NULL;
    skg_scan_run_options_init(&options);
    options.only = first;
    options.only_count = 2;
    options.batch = 1;
    options.subframes = 2;
    options.file = file;
    TRY(skg_scan_flat_fields_render(plan, scene, scan, NULL, 1, white));
    TRY(skg_scan_file_fields_write(file, 1, white, 1, dark));
    TRY(skg_scan_run_create(plan, scan, &options, &run));
    const skg_status status = write_batches(run, file);
    skg_scan_run_release(&run);
    return status < 0 ? status : skg_scan_file_finish(file);
}

static skg_status write_file(const char *path, skg_plan *plan, const skg_scene *scene, skg_scan *scan) {
    skg_scan_file_options options;
    skg_scan_file *file = NULL;
    skg_scan_file_options_init(&options);
    options.scan = scan;
    options.hash = hash;
    options.name = "energy";
    options.unit = "keV per pixel";
    options.samples = 1;
    TRY(skg_scan_file_open(path, &options, &file));
    const skg_status status = fill(plan, scene, scan, file);
    skg_scan_file_release(&file);
    return status;
}

static skg_status read_packed(const char *path, float *image) {
    skg_scan_reader *reader = NULL;
    TRY(skg_scan_reader_open(path, &reader));
    const skg_status status = skg_scan_reader_attenuation_get(reader, PROJECTIONS - 1, image);
    skg_scan_reader_release(&reader);
    return status;
}

static skg_status pack(const char *folder, float *image) {
    char from[128], to[128];
    skg_scan_pack_options options;
    skg_scan_pack_options_init(&options);
    options.grey16 = 1;
    snprintf(from, sizeof from, "%s/scan.h5", folder);
    snprintf(to, sizeof to, "%s/packed.h5", folder);
    const skg_status status = skg_scan_file_pack(from, to, &options);
    FILE *there = fopen(to, "rb");
    if (!there) return status;
    fclose(there);
    TRY(read_packed(to, image)); /* whole, whatever became of the call */
    return status;
}

static skg_status write_all(const char *folder, skg_plan *plan, const skg_scene *scene, skg_scan *scan,
                            float *image) {
    static const char *const names[] = {"geometry.csv", "scan.mha", "scan.tif", "scan.h5"};
    char path[128];
    snprintf(path, sizeof path, "%s/%s", folder, names[0]);
    TRY(skg_scan_geometry_save(scan, path));
    for (int n = 1; n < 4; n++) {
        snprintf(path, sizeof path, "%s/%s", folder, names[n]);
        if (skg_scan_file_path_check(path) == SKG_ERR_UNSUPPORTED) return SKG_OK; /* a build without HDF5 */
        TRY(write_file(path, plan, scene, scan));
    }
    return pack(folder, image);
}

skg_status failing_scan(const char *folder, skg_plan *plan, const skg_scene *scene, const skg_view *view,
                        float *image) {
    skg_scan_options options;
    skg_scan *scan = NULL;
    skg_scan_options_init(&options);
    options.projections = PROJECTIONS;
    options.step_rad = 0.1;
    options.interval_s = options.exposure_s = 1;
    TRY(skg_scan_create(view, &options, &scan));
    const skg_status status = write_all(folder, plan, scene, scan, image);
    skg_scan_release(&scan);
    return status;
}
