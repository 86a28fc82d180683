/* Grey values of projections: their range, type and records. */
#include "scan/steps.h"

#include "common/file.h"
#include "common/say.h"

#include <inttypes.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

/* The name of the scenario's file without its extension. The caller frees it. */
static char *make_stem(const char *path) {
    const char *slash = strrchr(path, '/'), *name = slash ? slash + 1 : path, *dot = strrchr(name, '.');
    return strndup(name, dot && dot > name ? (size_t)(dot - name) : strlen(name));
}

/* Grey values are another scan than energies: the first digits of the hash are turned over. */
static void mark_hash(char *hash) {
    static const char digits[] = "0123456789abcdef";
    for (int i = 0; i < 8; i++) hash[i] = digits[15 - (strchr(digits, hash[i]) - digits)];
}

/* The layout of CTSimU. */
static int has_stem(const cli_acquisition *a) {
    return a->record.ctsimu && a->is_grey;
}

/* An .h5 and the layout of CTSimU have fields; others have them beside, if one asks or if one number for all pixels is not enough. A shard
 * leaves those to the whole. */
static void decide_fields(const cli_arguments *arguments, cli_acquisition *a) {
    const int is_inside = cli_has_extension(a->place, ".h5") || cli_has_extension(a->place, ".hdf5") ||
                          cli_has_extension(a->place, ".nxs") || (has_stem(a) && cli_names_folder(a->place));
    const int asked = a->record.fields || cli_given(arguments, "--flats") || cli_given(arguments, "--darks");
    const int needed = a->file_options.flat_varies || a->file_options.dark_varies;
    a->fields_beside = !is_inside && (asked || needed) && !cli_given(arguments, "--shard");
    a->has_fields = is_inside || a->fields_beside;
}

int grey_decide(const cli_arguments *arguments, cli_acquisition *a) {
    const int asked = cli_given(arguments, "--grey16");
    const int has_quantity = cli_given(arguments, "--quantity");
    skg_scan_record_init(&a->record);
    skg_readout_init(&a->readout);
    skg_status status = skg_setup_record_get(a->session.setup, &a->record);
    if (status == SKG_OK) status = skg_setup_readout_get(a->session.setup, &a->readout);
    if (status != SKG_OK) return cli_fail(status);
    a->is_grey = asked || (a->record.grey_values && !has_quantity);
    if (asked) a->readout.bits = 16;
    if (a->is_grey) mark_hash(a->hash);
    if (a->record.fields && !cli_given(arguments, "--flats")) a->flats = a->record.flats;
    if (a->record.fields && !cli_given(arguments, "--darks")) a->darks = a->record.darks;
    a->options.moving_count = a->record.moving_count;
    a->options.moving_parts = a->record.moving_parts;
    a->options.moving_poses = a->record.moving_poses;
    if (!a->is_grey && a->record.intensities)
        cli_log(SKG_LOG_WARNING,
                "the intensity of the beam changes in grey values only; this scan has another quantity",
                NULL);
    const int exit_status = lag_check(arguments, a);
    if (exit_status != CLI_DONE || !has_stem(a)) return exit_status;
    a->stem = make_stem(a->session.path);
    return a->stem ? CLI_DONE : cli_error(CLI_DEVICE, "out of host memory");
}

static int64_t pixels_of(const cli_acquisition *a) {
    return a->session.view.columns * a->session.view.rows;
}

static int64_t raw_bytes(const cli_acquisition *a) {
    return pixels_of(a) * (a->options.type == SKG_TYPE_FLOAT64 ? 8 : 4);
}

int32_t grey_type(const cli_acquisition *a) {
    if (!a->is_grey) return a->options.type;
    return a->readout.bits ? SKG_TYPE_UINT16 : SKG_TYPE_FLOAT32;
}

int64_t grey_bytes(const cli_acquisition *a) {
    if (!a->is_grey) return raw_bytes(a);
    return pixels_of(a) * (a->readout.bits ? 2 : 4);
}

/* The energy where the free beam is strongest: the greatest of the flat field; with quantum noise, which would make it too great, I0. */
static int find_full(cli_acquisition *a, const skg_channel *channel) {
    void *flat = malloc((size_t)raw_bytes(a));
    if (!flat) return cli_error(CLI_DEVICE, "out of host memory for a flat field");
    skg_status status = skg_scan_flat_fields_render(a->plan, a->session.scene, a->scan, &a->options, 1, flat);
    if (!SKG_FAILED(status)) status = SKG_OK;
    const int is_noisy = a->session.options.noise || a->session.options.electronic_kev > 0;
    a->readout.full_kev = is_noisy ? channel->flat_field : 0;
    for (int64_t i = 0; status == SKG_OK && !is_noisy && i < pixels_of(a); i++) {
        const double kev =
            a->options.type == SKG_TYPE_FLOAT64 ? ((double *)flat)[i] : (double)((float *)flat)[i];
        if (kev > a->readout.full_kev) a->readout.full_kev = kev;
    }
    free(flat);
    return status == SKG_OK ? CLI_DONE : cli_fail(status);
}

/* The grey value of a pixel like all others, without noise. */
static skg_status level_of(const cli_acquisition *a, double kev, double *level) {
    skg_readout plain = a->readout;
    float value = 0;
    plain.bits = 0, plain.snr = 0, plain.noise_count = 0;
    plain.gain = plain.offset = plain.bad_pixels = NULL;
    const skg_status status = skg_readout_image(&plain, 1, SKG_TYPE_FLOAT64, &kev, 1, 0, &value);
    *level = (double)value;
    return status;
}

int grey_prepare(const cli_arguments *arguments, cli_acquisition *a) {
    const skg_readout *r = &a->readout;
    skg_scan_file_options *levels = &a->file_options;
    skg_channel channel;
    skg_channel_init(&channel);
    skg_scan_file_options_init(levels);
    skg_status status = skg_plan_channel_get(a->plan, 0, &channel);
    if (status != SKG_OK) return cli_fail(status);
    levels->flat_field = channel.flat_field;
    levels->dark_varies = a->is_grey && r->offset;
    levels->flat_varies = channel.uneven || levels->dark_varies || (a->is_grey && r->gain);
    decide_fields(arguments, a);
    if (!a->is_grey) return CLI_DONE;
    const int exit_status = find_full(a, &channel);
    if (exit_status != CLI_DONE) return exit_status;
    status = level_of(a, r->full_kev, &levels->flat_field);
    if (status == SKG_OK) status = level_of(a, 0, &levels->dark);
    return status == SKG_OK ? CLI_DONE : cli_fail(status);
}

static uint16_t greatest(const cli_acquisition *a) {
    return (uint16_t)((1 << a->readout.bits) - 1);
}

/* Pixels at the greatest value of their bits, but for bad ones, whose values are given. */
static int64_t count_clipped(const cli_acquisition *a, const void *grey) {
    const uint16_t most = greatest(a), *values = grey;
    const float *bad = a->readout.bad_pixels;
    int64_t count = 0;
    for (int64_t i = 0; a->readout.bits && i < pixels_of(a); i++)
        count += values[i] == most && !(bad && bad[i] >= 0);
    return count;
}

void grey_warn(const cli_acquisition *a) {
    if (a->clipped > 0)
        cli_warn(
            "%" PRId64
            " pixels of the projections are at %d, the greatest grey value of %d bits, and may be cut off there: less "
            "Detector.GreyValues.Full, or \"Bits\": 0, leaves them as they are",
            a->clipped, greatest(a), (int)a->readout.bits);
}

skg_status grey_batch(cli_acquisition *a, const skg_scan_batch *batch, const void **images) {
    *images = batch->images;
    if (!a->is_grey) return SKG_OK;
    if (batch->count > a->grey_capacity) {
        free(a->grey);
        a->grey = malloc((size_t)(batch->count * grey_bytes(a)));
        a->grey_capacity = a->grey ? batch->count : 0;
        if (!a->grey) return SKG_ERR_MEMORY;
    }
    for (int64_t i = 0; i < batch->count; i++) {
        const int64_t index = batch->indices[i];
        const void *energies = (const char *)batch->images + i * raw_bytes(a);
        double share = a->record.intensities ? a->record.intensities[index] : 1;
        skg_status status = SKG_OK;
        if (a->lag) {
            status = skg_lag_apply(a->lag, batch->type, energies, share, a->lagged);
            energies = a->lagged, share = 1;
        }
        void *grey = (char *)a->grey + i * grey_bytes(a);
        if (status == SKG_OK)
            status = skg_readout_image(&a->readout, pixels_of(a), batch->type, energies, share, index, grey);
        if (status != SKG_OK) return status;
        a->clipped += count_clipped(a, grey);
    }
    *images = a->grey;
    return SKG_OK;
}

skg_status grey_fields(const cli_acquisition *a, int is_dark, const void *energies, void *to) {
    skg_readout readout = a->readout;
    const int is_noisy = is_dark ? a->record.dark_noise : a->record.flat_noise;
    const int64_t count = is_dark ? a->darks : a->flats;
    if (!is_noisy) readout.snr = 0, readout.noise_count = 0;
    readout.frames = is_dark ? a->record.dark_frames : a->record.flat_frames;
    for (int64_t f = 0; f < count; f++) {
        /* Their numbers follow those of the projections: first the flat, then the dark fields. */
        const int64_t index = a->whole_projections + f + (is_dark ? a->flats : 0);
        const skg_status status = skg_readout_image(&readout, pixels_of(a), a->options.type,
                                                    (const char *)energies + f * raw_bytes(a), 1, index,
                                                    (char *)to + f * grey_bytes(a));
        if (status != SKG_OK) return status;
    }
    return SKG_OK;
}
