/* Reads the radiographs that flags name, with views, flat fields and masks. */
#include "register/work.h"

#include "common/say.h"
#include "dicom/dicom.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Share by which the pitch of a file may differ from the scene's without a word. */
static const double PITCH_DIFFERS = 0.01;

/* In the order of --quantity. */
static const int32_t register_quantities[] = {SKG_QUANTITY_ENERGY, SKG_QUANTITY_TRANSMISSION,
                                              SKG_QUANTITY_ATTENUATION};

/* Splits FILE@K; a name that has no number behind its last @ is one of a file. */
static int split(const char *value, register_image *image) {
    char *end = NULL;
    image->projection = -1;
    image->path = strdup(value);
    if (!image->path) return cli_error(CLI_DEVICE, "out of host memory");
    char *at = strrchr(image->path, '@');
    const long number = at && at[1] ? strtol(at + 1, &end, 10) : -1;
    if (!at || !end || *end || number < 0) return CLI_DONE;
    *at = '\0';
    image->projection = number;
    return CLI_DONE;
}

/* The view of the scene, or of a projection. */
static int find_view(const register_work *work, register_image *image) {
    skg_scan *scan = NULL;
    int64_t count = 0;
    image->view = work->session.view;
    if (image->projection < 0) return CLI_DONE;
    skg_status status = skg_setup_scan_get(work->session.setup, &scan);
    if (status != SKG_OK)
        return cli_error(CLI_INPUT,
                         "%s %s@%" PRId64
                         ": the scene has no Scan that gives the view of a projection; leave @%" PRId64
                         " out, or add the key Scan",
                         work->named_by, image->path, image->projection, image->projection);
    status = skg_scan_projection_count(scan, &count);
    if (status != SKG_OK) return cli_fail(status);
    if (image->projection >= count)
        return cli_error(CLI_INPUT, "%s %s@%" PRId64 ": the Scan has %" PRId64 " projections, counted from 0",
                         work->named_by, image->path, image->projection, count);
    status = skg_scan_view_get(scan, image->projection, &image->view);
    return status == SKG_OK ? CLI_DONE : cli_fail(status);
}

/* values: NULL: only what the file holds. */
static int read_file(const char *path, int64_t page, skg_picture_contents *contents, double *values) {
    if (cli_dicom_is(path)) return cli_dicom_read(path, page, contents, values);
    const skg_status status =
        values ? skg_picture_load(path, page, values) : skg_picture_contents_get(path, contents);
    return status == SKG_OK ? CLI_DONE : cli_fail(status);
}

static double step_of(const double step[3]) {
    return sqrt(step[0] * step[0] + step[1] * step[1] + step[2] * step[2]);
}

/* Radiographs of another pitch than the scene says are found at another magnification: the commonest mistake with files of scanners. */
static void check_pitch(const char *path, const skg_picture_contents *contents, const skg_view *view) {
    const double across = step_of(view->column_step), down = step_of(view->row_step);
    const double *its = contents->spacing_mm;
    if (!(its[0] > 0) || !(its[1] > 0)) return;
    if (fabs(its[0] / across - 1) < PITCH_DIFFERS && fabs(its[1] / down - 1) < PITCH_DIFFERS) return;
    cli_warn(
        "%s: says that its pixels are %.4g x %.4g mm, and those of the scene's detector are %.4g x %.4g mm, which are "
        "used; set Detector.Size, if the file is right",
        path, its[0], its[1], across, down);
}

/* Reads an image that has to have the size of the view. page: of a file that has several; otherwise its only one. */
static int read_values(const char *path, const skg_view *view, int64_t page, double **values,
                       int32_t *quantity) {
    skg_picture_contents contents;
    skg_picture_contents_init(&contents);
    const int exit_status = read_file(path, 0, &contents, NULL);
    if (exit_status != CLI_DONE) return exit_status;
    if (contents.columns != view->columns || contents.rows != view->rows)
        return cli_error(CLI_INPUT,
                         "%s: has %" PRId64 " x %" PRId64 " pixels, and its view has %" PRId64 " x %" PRId64
                         "; set Detector.NumberOfPixels and Size of the scene, or give another file",
                         path, contents.columns, contents.rows, view->columns, view->rows);
    check_pitch(path, &contents, view);
    if (contents.pages > 1 && page < 0)
        return cli_error(CLI_INPUT,
                         "%s: has %" PRId64 " pages; say by @K which one, and thus which projection", path,
                         contents.pages);
    *values = malloc((size_t)(view->columns * view->rows) * sizeof **values);
    if (!*values) return cli_error(CLI_DEVICE, "out of host memory");
    if (quantity) *quantity = contents.quantity;
    return read_file(path, contents.pages > 1 ? page : 0, &contents, *values);
}

static int count_values(const cli_arguments *arguments, const char *flag) {
    int count = 0;
    while (cli_nth_value(arguments, flag, count)) count++;
    return count;
}

/* The value of a flag that is given once for all radiographs, or once for each; NULL: not given. */
static int value_for(const register_work *work, const char *flag, int64_t image, const char **value) {
    const int count = count_values(work->arguments, flag);
    *value = NULL;
    if (count > 1 && count != work->image_count)
        return cli_error(CLI_USAGE,
                         "%s is given %d times for %" PRId64 " radiographs; give it once, or once for each",
                         flag, count, work->image_count);
    if (count > 0) *value = cli_nth_value(work->arguments, flag, count > 1 ? (int)image : 0);
    return CLI_DONE;
}

static int read_beside(const register_work *work, int64_t index, register_image *image) {
    const char *flat = NULL, *mask = NULL;
    char *end = NULL;
    int exit_status = value_for(work, "--flat", index, &flat);
    if (exit_status == CLI_DONE) exit_status = value_for(work, "--mask", index, &mask);
    if (exit_status == CLI_DONE && flat) {
        image->flat_field = strtod(flat, &end);
        if (end == flat || *end) {
            image->flat_field = 0;
            exit_status = read_values(flat, &image->view, image->projection, &image->flat, NULL);
        } else if (!(image->flat_field > 0)) {
            exit_status = cli_error(CLI_USAGE, "--flat %s: a flat field is above 0", flat);
        }
    }
    if (exit_status == CLI_DONE && mask)
        exit_status = read_values(mask, &image->view, image->projection, &image->mask, NULL);
    return exit_status;
}

static int read_image(const register_work *work, int64_t index, const char *value, register_image *image) {
    int32_t said = -1, chosen = -1;
    int exit_status = split(value, image);
    if (exit_status == CLI_DONE) exit_status = find_view(work, image);
    if (exit_status == CLI_DONE)
        exit_status = read_values(image->path, &image->view, image->projection, &image->values, &said);
    if (exit_status == CLI_DONE) exit_status = cli_choice(work->arguments, "--quantity", &chosen);
    image->quantity = chosen >= 0 ? register_quantities[chosen] : said >= 0 ? said : SKG_QUANTITY_ENERGY;
    if (exit_status == CLI_DONE) exit_status = read_beside(work, index, image);
    const int is_ratio =
        image->quantity == SKG_QUANTITY_TRANSMISSION || image->quantity == SKG_QUANTITY_ATTENUATION;
    if (exit_status == CLI_DONE && !is_ratio && !image->flat && !(image->flat_field > 0))
        cli_note("%s: no --flat is given; its largest intensity stands for it", image->path);
    return exit_status;
}

int register_read_images(register_work *work) {
    const int count = count_values(work->arguments, work->named_by);
    int exit_status = CLI_DONE;
    if (count == 0) return cli_error(CLI_USAGE, "register: give at least one radiograph: --image FILE.mha");
    work->images = calloc((size_t)count, sizeof *work->images);
    if (!work->images) return cli_error(CLI_DEVICE, "out of host memory");
    work->image_count = count;
    for (int i = 0; i < count && exit_status == CLI_DONE; i++)
        exit_status =
            read_image(work, i, cli_nth_value(work->arguments, work->named_by, i), &work->images[i]);
    return exit_status;
}

void register_free_images(int64_t count, register_image *images) {
    for (int64_t i = 0; i < count && images; i++) {
        free(images[i].path);
        free(images[i].values);
        free(images[i].flat);
        free(images[i].mask);
    }
    free(images);
}

void register_radiograph(const register_image *from, skg_radiograph *image) {
    skg_radiograph_init(image);
    image->view = &from->view;
    image->values = from->values, image->flat = from->flat, image->mask = from->mask;
    image->flat_field = from->flat_field;
    image->quantity = from->quantity;
    image->name = from->path;
}
