/* Volumes from files: the extension chooses the reader; a folder is one of DICOM slices. */
#include "core/text.h"
#include "image/image.h"
#include "scene/volume.h"

#include <skiagraph/context.h>

#include <inttypes.h>
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
    if (skg_dicom_is_folder(path)) {
        *found = skg_dicom_read_grid;
        return SKG_OK;
    }
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

/* A unit that the caller names wins. */
static void note_unit(skg_volume *volume, const skg_grid *grid, double unit_mm) {
    const double *of_file = grid->unit_mm;
    char named[3][32], all[128], text[192];
    if (!(unit_mm > 0) || !(of_file[0] > 0) ||
        (of_file[0] == unit_mm && of_file[1] == unit_mm && of_file[2] == unit_mm))
        return;
    for (int k = 0; k < 3; k++) skg_unit_describe(of_file[k], named[k], sizeof named[k]);
    if (of_file[1] == of_file[0] && of_file[2] == of_file[0])
        snprintf(all, sizeof all, "%s", named[0]);
    else
        snprintf(all, sizeof all, "%s, %s and %s", named[0], named[1], named[2]);
    skg_unit_contradict(unit_mm, all, text, sizeof text);
    skg_volume_say(volume, SKG_LOG_NOTE, "%s", text);
}

static void note(skg_volume *volume, const skg_grid *grid, double unit_mm) {
    const double *a = volume->affine;
    if (volume->values == SKG_VOLUME_HU && *grid->no_hounsfield)
        skg_volume_say(
            volume, SKG_LOG_WARNING,
            "its %s, and its numbers are taken as Hounsfield numbers; give a CT image, or say what they are (density, mu)",
            grid->no_hounsfield);
    note_unit(volume, grid, unit_mm);
    if (grid->no_spacing)
        skg_volume_say(
            volume, SKG_LOG_WARNING,
            "its header does not say how large its cells are, which are taken as %g x %g x %g mm; write it there (NRRD: "
            "space directions; MetaImage: ElementSpacing), or name a unit that is their side",
            fabs(a[0]), fabs(a[5]), fabs(a[10]));
    if (grid->no_order)
        skg_volume_say(
            volume, SKG_LOG_WARNING,
            "its header has no endian, which NRRD demands of numbers of several bytes; little endian is taken; write "
            "\"endian: little\" or \"endian: big\" there");
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
    if (!(unit_mm >= 0) || !isfinite(unit_mm))
        return skg_fail(SKG_ERR_ARGUMENT,
                        "%s: a unit of %g mm; give one that is finite and above 0, or 0 for the file's", path,
                        unit_mm);
    SKG_TRY(find_reader(path, &read));
    SKG_TRY(read(path, &grid));
    for (int k = 0; k < 12; k++) {
        const double of_file = grid.unit_mm[k / 4] > 0 ? grid.unit_mm[k / 4] : 1;
        ours.affine[k] = (unit_mm > 0 ? unit_mm : of_file) * grid.affine[k];
    }
    ours.columns = grid.size[0], ours.rows = grid.size[1], ours.slices = grid.size[2];
    ours.type = grid.type, ours.cells = grid.cells;
    if (!ours.name) ours.name = path;
    skg_status status = skg_volume_create(&ours, volume);
    if (status == SKG_OK) note(*volume, &grid, unit_mm);
    skg_free(&grid.cells);
    /* The caller gave a file, not its values. */
    return status == SKG_ERR_ARGUMENT ? skg_fail(SKG_ERR_FORMAT, "%s", skg_last_error()) : status;
}

skg_status skg_volume_remark_get(const skg_volume *volume, int64_t index, int32_t *level,
                                 const char **sentence) {
    SKG_NEEDS(volume);
    SKG_NEEDS(level);
    SKG_NEEDS(sentence);
    if (index < 0 || index >= volume->remark_count)
        return skg_fail(SKG_ERR_ARGUMENT, "%s: remark %" PRId64 " of %" PRId32, volume->name, index,
                        volume->remark_count);
    *level = volume->remarks[index].level;
    *sentence = volume->remarks[index].text;
    return SKG_OK;
}
