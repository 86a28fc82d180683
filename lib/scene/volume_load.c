/* Volumes from files: the extension chooses the reader. */
#include "core/text.h"
#include "image/image.h"
#include "scene/volume.h"

#include <math.h>
#include <string.h>

typedef skg_status (*reader)(const char *path, skg_grid *grid);

static const struct {
    const char *extension;
    reader read;
} readers[] = {{".mha", skg_metaimage_read_grid}, {".mhd", skg_metaimage_read_grid},
               {".nrrd", skg_nrrd_read_grid},     {".nhdr", skg_nrrd_read_grid},
               {".nii", skg_nifti_read_grid},     {".nii.gz", skg_nifti_read_grid}};

static skg_status find_reader(const char *path, reader *found) {
    const char *slash = strrchr(path, '/'), *dot = strrchr(slash ? slash : path, '.');
    const size_t length = strlen(path);
    for (size_t i = 0; i < sizeof readers / sizeof *readers; i++) {
        const size_t of = strlen(readers[i].extension);
        if (length > of && skg_same_name(path + length - of, readers[i].extension)) {
            *found = readers[i].read;
            return SKG_OK;
        }
    }
    return skg_fail(
        SKG_ERR_UNSUPPORTED,
        "%s: the extension %s%s is none of a volume that can be read; convert it to .mha, for example by "
        "SimpleITK, or give it as an array in Python",
        path, dot ? dot : "", dot ? "" : "is missing and");
}

skg_status skg_volume_load(const char *path, double unit_mm, const skg_volume_source *source,
                           skg_volume **volume) {
    SKG_PLAIN;
    skg_volume_source ours;
    skg_grid grid;
    reader read = NULL;
    SKG_NEEDS(path);
    SKG_NEEDS(volume);
    *volume = NULL;
    skg_volume_source_init(&ours);
    if (source) SKG_TRY(skg_struct_read(source, "skg_volume_source", &ours, sizeof ours));
    if (!(unit_mm > 0) || !isfinite(unit_mm))
        return skg_fail(SKG_ERR_ARGUMENT, "%s: a unit of %g mm; finite and above 0", path, unit_mm);
    SKG_TRY(find_reader(path, &read));
    SKG_TRY(read(path, &grid));
    for (int k = 0; k < 12; k++) ours.affine[k] = unit_mm * grid.affine[k];
    ours.columns = grid.size[0], ours.rows = grid.size[1], ours.slices = grid.size[2];
    ours.type = grid.type, ours.cells = grid.cells;
    if (!ours.name) ours.name = path;
    skg_status status = skg_volume_create(&ours, volume);
    skg_free(&grid.cells);
    /* The caller gave a file, not its values. */
    return status == SKG_ERR_ARGUMENT ? skg_fail(SKG_ERR_FORMAT, "%s", skg_last_error()) : status;
}
