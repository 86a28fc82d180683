/* The radiograph of --fixed: read as `register` reads it, checked by the library, and packed for the pages. */
#include "live/fixed.h"

#include "common/say.h"
#include <math.h>
#include <stdlib.h>

/* Refuses a radiograph that the library refuses: values that are not finite, an image that is the same everywhere. */
static int check(const live_scene *scene, const register_image *fixed) {
    const cli_session *s = &scene->session;
    skg_registration *registration = NULL;
    skg_radiograph image;
    register_radiograph(fixed, &image);
    skg_status status =
        skg_registration_create(s->context, s->scene, s->spectrum, &s->options, NULL, &registration);
    if (status == SKG_OK) status = skg_registration_image_add(registration, &image);
    const int exit_status = status == SKG_OK             ? CLI_DONE
                            : status == SKG_ERR_ARGUMENT ? (cli_fail(status), CLI_INPUT) /* of a file */
                                                         : cli_fail(status);
    skg_registration_release(&registration);
    return exit_status;
}

/* In the form of a frame, whose values and flat field the page turns into attenuations. */
static int pack(const register_image *fixed, live_hub *hub) {
    const int64_t count = fixed->view.columns * fixed->view.rows;
    const int is_ratio = fixed->flat || fixed->quantity == SKG_QUANTITY_TRANSMISSION;
    float *values = malloc((size_t)count * sizeof *values);
    skg_live_letter *letter = NULL;
    double largest = 0, flat_field = 0;
    for (int64_t p = 0; p < count && values; p++) {
        values[p] = (float)(fixed->flat ? fixed->values[p] / fixed->flat[p] : fixed->values[p]);
        largest = fmax(largest, fixed->values[p]);
    }
    if (fixed->quantity != SKG_QUANTITY_ATTENUATION)
        flat_field = is_ratio ? 1 : fixed->flat_field > 0 ? fixed->flat_field : largest;
    const int is_packed =
        values && skg_live_image_write("SKLR", fixed->view.columns, fixed->view.rows, fixed->quantity,
                                       flat_field, values, &letter) == SKG_OK;
    free(values);
    if (!is_packed) return cli_error(CLI_DEVICE, "out of host memory for the radiograph");
    live_hub_radiograph_set(hub, letter);
    return CLI_DONE;
}

int live_fixed_read(live_base *base, const live_scene *scene, live_hub *hub) {
    register_work work = {.arguments = base->arguments, .named_by = "--fixed", .session = scene->session};
    if (!cli_given(base->arguments, "--fixed")) {
        if (cli_given(base->arguments, "--quantity") || cli_given(base->arguments, "--flat"))
            return cli_error(CLI_USAGE, "live: --quantity and --flat are of the radiograph of --fixed FILE");
        return CLI_DONE;
    }
    if (cli_nth_value(base->arguments, "--fixed", 1))
        return cli_error(CLI_USAGE,
                         "live: --fixed is given twice; the page shows one radiograph, the verb register "
                         "takes several");
    int exit_status = cli_refuse_counting(&scene->session, "live --fixed");
    if (exit_status == CLI_DONE) exit_status = register_read_images(&work);
    if (exit_status == CLI_DONE) exit_status = check(scene, work.images);
    if (exit_status == CLI_DONE) exit_status = pack(work.images, hub);
    base->fixed = work.images; /* live_base_free frees it */
    return exit_status;
}
