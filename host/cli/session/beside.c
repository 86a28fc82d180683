/* Pictures beside an image, each by a flag with the name of its file: what was scattered, its error, the mean, and the variance of the noise. */
#include "session/beside.h"

#include "common/interrupt.h"
#include "common/say.h"

#include <stdio.h>
#include <stdlib.h>

/* share: in ratios to the flat field the values are shares of it, whatever the image shows of them. */
static const struct {
    const char *flag;
    const char *name; /* NULL: the image's own */
    int32_t kind, share;
} rows[CLI_BESIDE_COUNT] = {
    [CLI_BESIDE_SCATTER] = {"--scatter-image", "scatter", SKG_OUTPUT_SCATTER, 1},
    [CLI_BESIDE_SIGMA] = {"--scatter-sigma", "standard error of the scatter", SKG_OUTPUT_SCATTER_SIGMA, 1},
    [CLI_BESIDE_MEAN] = {"--mean", NULL, SKG_OUTPUT_MEAN, 0},
    [CLI_BESIDE_VARIANCE] = {"--variance", "variance", SKG_OUTPUT_VARIANCE, 0}};

void cli_beside_read(const cli_arguments *arguments, cli_beside *beside) {
    for (int i = 0; i < CLI_BESIDE_COUNT; i++) beside->paths[i] = cli_value(arguments, rows[i].flag);
}

int cli_beside_allocate(const cli_session *session, int32_t type, cli_beside *beside) {
    int64_t channels = session->options.bands > 0 ? session->options.bands : 1;
    if (session->options.counter) skg_counter_thresholds_get(session->options.counter, &channels);
    const size_t pixels = (size_t)(session->view.columns * session->view.rows * channels);
    for (int i = 0; i < CLI_BESIDE_COUNT; i++) {
        if (!beside->paths[i]) continue;
        beside->planes[i] = calloc(pixels, type == SKG_TYPE_FLOAT64 ? 8 : 4);
        if (!beside->planes[i]) return cli_error(CLI_DEVICE, "out of host memory for %s", rows[i].flag);
    }
    return CLI_DONE;
}

void cli_beside_free(cli_beside *beside) {
    for (int i = 0; i < CLI_BESIDE_COUNT; i++) free(beside->planes[i]);
    *beside = (cli_beside){0};
}

skg_status cli_beside_frame(skg_plan *plan, const skg_output *output, const void *user) {
    const cli_beside *beside = user;
    skg_output outputs[1 + CLI_BESIDE_COUNT] = {*output};
    skg_job *job = NULL;
    int count = 1;
    for (int i = 0; i < CLI_BESIDE_COUNT; i++) {
        if (!beside->planes[i]) continue;
        outputs[count] = *output;
        outputs[count].kind = rows[i].kind;
        outputs[count++].data = beside->planes[i];
    }
    const skg_status status = skg_plan_submit(plan, 1, NULL, count, outputs, &job);
    return status == SKG_OK ? skg_job_wait(&job) : status;
}

/* Names a picture that is not shown as the image is. unit: room for its unit */
static void name_picture(int number, skg_picture *picture, char *unit, size_t size) {
    const int is_ratio =
        picture->quantity == SKG_QUANTITY_ATTENUATION || picture->quantity == SKG_QUANTITY_TRANSMISSION;
    picture->name = rows[number].name;
    if (picture->channels == 1) picture->channel_names = NULL; /* they would name the picture */
    if (number == CLI_BESIDE_VARIANCE) {
        snprintf(unit, size, "(%s)^2", picture->unit ? picture->unit : "");
        picture->unit = unit;
    }
    if (is_ratio) picture->quantity = SKG_QUANTITY_TRANSMISSION;
    if (is_ratio && rows[number].share) picture->unit = "I/I0";
    picture->display = SKG_DISPLAY_TRANSMISSION; /* with no flat field: grey levels follow the values */
    picture->flat_field = picture->low = picture->high = 0;
}

int cli_beside_write(const cli_beside *beside, const skg_picture *image) {
    int failure = CLI_DONE;
    for (int i = 0; i < CLI_BESIDE_COUNT; i++) {
        if (!beside->planes[i]) continue;
        skg_picture picture = *image;
        char unit[64];
        picture.data = beside->planes[i];
        if (rows[i].name) name_picture(i, &picture, unit, sizeof unit);
        const skg_status status = skg_picture_save(&picture, beside->paths[i]);
        if (status == SKG_OK)
            cli_keep("the last output written is %s", beside->paths[i]);
        else if (failure == CLI_DONE)
            failure = status == SKG_ERR_UNSUPPORTED ? cli_fail(status), CLI_OUTPUT : cli_fail(status);
    }
    return failure;
}
