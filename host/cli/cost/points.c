/* Makes points, and the reference that they are compared with. */
#include "cost/measuring.h"

#include "common/say.h"

#include <stdlib.h>

int cost_make_reference(cost_study *study, int number) {
    cost_reference *reference = &study->measured.references[number];
    if (number == COST_OF_BREATH) {
        int exit_status = CLI_DONE;
        if (cost_breathe(study, &reference->setting, NULL, &exit_status) >= SKG_OK) return exit_status;
        cost_note(study, "relaxation and hysteresis are not swept: %s", skg_last_error());
        return CLI_DONE;
    }
    reference->image = calloc((size_t)study->pixels, sizeof *reference->image);
    if (!reference->image) return cli_error(CLI_DEVICE, "out of host memory for the image");
    double ms = 0;
    skg_status status = cost_image(study, &reference->setting, reference->image, &ms);
    if (number == COST_OF_RAYS) study->measured.best_pass_ms = ms / cost_passes(&reference->setting);
    return SKG_FAILED(status) ? cli_fail(status) : CLI_DONE;
}

/* Decides by a status of the library whether the sweep keeps a setting: *keep 1: it continues with the image; 0: the setting is left out,
 * because the scene does not allow it (half with a leaky mesh) or memory is short. */
static int judge(cost_study *study, const cost_setting *setting, skg_status status, int *keep) {
    char text[160];
    *keep = !SKG_FAILED(status);
    if (*keep) return CLI_DONE;
    if (status == SKG_ERR_DEVICE || status == SKG_ERR_INTERNAL || status == SKG_ERR_NO_DEVICE)
        return cli_fail(status);
    cost_describe(study, setting, text, sizeof text);
    cost_note(study, "%s left out: %s", text, skg_last_error());
    return CLI_DONE;
}

static int measure_breath(cost_study *study, cost_point *point) {
    int exit_status = CLI_DONE, keep;
    const skg_status status = cost_breathe(study, &point->setting, point, &exit_status);
    if (exit_status == CLI_DONE) exit_status = judge(study, &point->setting, status, &keep);
    if (exit_status == CLI_DONE && keep) point->state = COST_MEASURED;
    return exit_status;
}

/* Compares the image of a shot with the reference of a point. */
static int compare(cost_study *study, cost_point *point, int shot, const double *image) {
    const cost_reference *reference = &study->measured.references[point->reference];
    const int dial = point->dial;
    point->shot = shot;
    point->state = COST_MEASURED;
    const int exit_status = cost_compare(study, 1, image, reference->image, point);
    if (exit_status == CLI_DONE && point->reference != COST_OF_ALL &&
        (dial == COST_PRECISION || dial == COST_SCENE || dial == COST_REPAIR || dial == COST_TRIANGLES))
        cost_compare_lengths(study, &reference->setting, point);
    return exit_status;
}

int cost_measure(cost_study *study, cost_point *point, double *image) {
    int number, keep, exit_status = CLI_DONE;
    point->state = COST_LEFT_OUT;
    if (!study->measured.references[point->reference].image)
        exit_status = cost_make_reference(study, point->reference);
    if (exit_status != CLI_DONE || !study->measured.references[point->reference].image) return exit_status;
    if (point->reference == COST_OF_BREATH) return measure_breath(study, point);
    const skg_status status = cost_shoot(study, &point->setting, image, &number);
    exit_status = judge(study, &point->setting, status, &keep);
    if (exit_status == CLI_DONE && keep)
        exit_status = cost_compare_shot(study, image, &study->measured.shots[number]);
    if (exit_status == CLI_DONE && keep) exit_status = compare(study, point, number, image);
    /* Other points that are waiting for the same image. */
    for (int i = 0; i < study->measured.count && exit_status == CLI_DONE && keep; i++) {
        cost_point *other = &study->measured.points[i];
        if (other->state == COST_PLANNED && study->measured.references[other->reference].image &&
            other->reference != COST_OF_BREATH && cost_is_same(study, &other->setting, &point->setting))
            exit_status = compare(study, other, number, image);
    }
    return exit_status;
}
