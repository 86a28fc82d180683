/* Reports the result of a registration as text and JSON. */
#include "register/work.h"

#include "common/encode.h"
#include "common/say.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>

static const double degree = 3.14159265358979323846 / 180;

const char *register_status(const register_body *body) {
    static const char *const names[] = {"none", "agrees", "structure", "not determined", "failed", "stopped"};
    return names[body->result.verdict];
}

json_t *register_body_json(const register_body *body, int32_t free) {
    const skg_registration_result *r = &body->result;
    json_t *object = json_object(), *determined = json_array();
    for (int k = 0; k < 6; k++) json_array_append_new(determined, json_boolean(r->determined[k]));
    json_object_set_new(object, "label", cli_json_text(body->label));
    if (free == SKG_REGISTRATION_FREE_POSE) {
        json_object_set_new(object, "twist", cli_json_numbers(r->twist, 6));
        json_object_set_new(object, "sigma", cli_json_numbers(r->sigma, 6));
        json_object_set_new(object, "sigma_structure", cli_json_numbers(r->sigma_structure, 6));
        json_object_set_new(object, "determined", json_incref(determined));
        json_object_set_new(object, "middle", cli_json_numbers(r->middle, 3));
        json_object_set_new(object, "radius_mm", cli_json_number(r->radius_mm));
        json_object_set_new(object, "shift_mm", cli_json_number(r->shift_mm));
        json_object_set_new(object, "turn_deg", cli_json_number(r->turn_rad / degree));
    }
    json_decref(determined);
    json_object_set_new(object, "status", json_string(register_status(body)));
    json_object_set_new(object, "verdict", cli_json_text(body->verdict));
    json_object_set_new(object, "loss", cli_json_number(r->loss));
    json_object_set(object, "directions", body->directions);
    return object;
}

static json_t *views_json(const register_work *work) {
    json_t *list = json_array();
    for (int64_t i = 0; i < work->image_count; i++) {
        skg_view view;
        skg_view_init(&view);
        if (skg_registration_view_get(work->last, i, &view) != SKG_OK) continue;
        json_t *object = json_object();
        json_object_set_new(object, "projection",
                            work->images[i].projection < 0 ? json_null()
                                                           : json_integer(work->images[i].projection));
        json_object_set_new(object, "source", cli_json_numbers(view.source, 3));
        json_object_set_new(object, "centre", cli_json_numbers(view.centre, 3));
        json_object_set_new(object, "column_step", cli_json_numbers(view.column_step, 3));
        json_object_set_new(object, "row_step", cli_json_numbers(view.row_step, 3));
        json_array_append_new(list, object);
    }
    return list;
}

json_t *register_json(const register_work *work) {
    const register_body *last = &work->bodies[work->body_count - 1];
    const skg_registration_result *r = &last->result;
    json_t *object = json_object(), *parts = json_array();
    int64_t evaluations = 0, jacobians = 0;
    double seconds = 0;
    for (int64_t b = 0; b < work->body_count; b++) {
        const register_body *body = &work->bodies[b];
        json_array_append_new(parts, register_body_json(body, work->options.free));
        evaluations += body->result.images, jacobians += body->result.jacobians;
        seconds += body->result.seconds;
    }
    json_object_set_new(object, "status", json_string(register_status(last)));
    json_object_set_new(object, "verdict", cli_json_text(last->verdict));
    json_object_set_new(object, "parts", parts);
    json_object_set_new(object, "views", views_json(work));
    const struct {
        const char *name;
        double value;
    } numbers[] = {{"loss", r->loss},
                   {"loss_start", r->loss_start},
                   {"residual", r->residual},
                   {"noise", r->noise},
                   {"explained", r->explained},
                   {"agreement", r->agreement},
                   {"energy_kev", r->energy_kev}};
    for (size_t k = 0; k < sizeof numbers / sizeof *numbers; k++)
        json_object_set_new(object, numbers[k].name, cli_json_number(numbers[k].value));
    json_t *worst = json_object();
    json_object_set_new(worst, "view", json_integer(r->worst_image));
    json_object_set_new(worst, "row", json_integer(r->worst_row));
    json_object_set_new(worst, "column", json_integer(r->worst_column));
    json_object_set_new(object, "worst", worst);
    json_object_set_new(object, "evaluations", json_integer(evaluations));
    json_object_set_new(object, "jacobians", json_integer(jacobians));
    json_object_set_new(object, "seconds", cli_json_number(seconds));
    return object;
}

static void print_pose(const register_body *body) {
    static const char *const names[] = {"shift x, mm", "shift y, mm", "shift z, mm",
                                        "turn x, deg", "turn y, deg", "turn z, deg"};
    const skg_registration_result *r = &body->result;
    cli_print("%s: moved by %.4g mm, turned by %.4g degrees\n", body->label, r->shift_mm,
              r->turn_rad / degree);
    printf("%-14s %18s %18s\n", "", "sigma, noise alone", "with structure");
    for (int k = 0; k < 6; k++) {
        const double unit = k < 3 ? 1 : 1 / degree;
        printf("%-14s %18.2g %18.2g%s\n", names[k], r->sigma[k] * unit, r->sigma_structure[k] * unit,
               r->determined[k] ? "" : "  not determined");
    }
}

void register_print(const register_work *work) {
    for (int64_t b = 0; b < work->body_count; b++) {
        const register_body *body = &work->bodies[b];
        const skg_registration_result *r = &body->result;
        json_t *one;
        size_t index;
        if (work->options.free == SKG_REGISTRATION_FREE_POSE) print_pose(body);
        printf("%-44s %10s %14s\n", "least certain directions", "noise", "with structure");
        json_array_foreach(body->directions, index, one) if (index < 6)
            printf("%-44s %7.2g mm %11.2g mm\n", json_string_value(json_object_get(one, "name")),
                   json_number_value(json_object_get(one, "sigma_mm")),
                   json_number_value(json_object_get(one, "sigma_structure_mm")));
        printf("loss %.4g, at the start %.4g; %" PRId64 " images and %" PRId64
               " sets of derivatives in %.3g s\n",
               r->loss, r->loss_start, r->images, r->jacobians, r->seconds);
        cli_print("%s\n", body->verdict);
    }
}
