/* Frames in which parts are of other matter than planned: air that thins a lung, contrast that fills a duct.
 */
#include "frame/frame.h"

#include <inttypes.h>
#include <math.h>
#include <string.h>

typedef struct {
    const skg_plan *plan;
    double *density, *share; /* [parts] */
    double *own;             /* [parts + 1][planes] what a mm of each part's matter, and the world's, adds */
    char *known, *listed;    /* [parts] */
} matter;

static const double MOST_DENSITY = 1000;

static skg_status read_one(const skg_frame *given, int64_t k, matter *m) {
    const skg_scene *scene = m->plan->scene;
    const int64_t part = given->override_parts[k];
    const double density = given->density_ratios ? given->density_ratios[k] : 1;
    const double share = given->fill_fractions ? given->fill_fractions[k] : 1;
    if (part < 0 || part >= scene->count)
        return skg_fail(SKG_ERR_ARGUMENT, "a frame gives matter to part %" PRId64 " of %" PRId64, part,
                        scene->count);
    const char *label = scene->parts[part].label;
    if (!(density >= 0 && density <= MOST_DENSITY))
        return skg_fail(SKG_ERR_ARGUMENT, "%s: %g times the density of its material; 0 to %g", label, density,
                        MOST_DENSITY);
    if (!(share >= 0 && share <= 1))
        return skg_fail(SKG_ERR_ARGUMENT, "%s: a share of %g; 0 to 1", label, share);
    for (int64_t p = 0; p < scene->count && share < 1; p++)
        if (scene->parts[p].inside == part)
            return skg_fail(SKG_ERR_UNSUPPORTED, "%s: a share of %g, but %s lies inside it", label, share,
                            scene->parts[p].label);
    m->density[part] = density;
    m->share[part] = share;
    m->listed[part] = 1;
    return SKG_OK;
}

static int64_t parent_of(const matter *m, int64_t part) {
    const int64_t inside = m->plan->scene->parts[part].inside;
    return inside >= 0 ? inside : m->plan->scene->count;
}

/* A part adds what it has more than its parent; so what it has itself is that and all that those around it
 * add. */
static void find_own(matter *m, int64_t part) {
    const skg_model *model = &m->plan->model;
    if (part == m->plan->scene->count || m->known[part]) return;
    const int64_t parent = parent_of(m, part);
    find_own(m, parent);
    double *own = m->own + part * model->planes;
    memcpy(own, m->own + parent * model->planes, (size_t)model->planes * sizeof *own);
    for (int64_t w = model->first_contribution[part]; w < model->first_contribution[part + 1]; w++)
        own[model->contributions[w].plane] += model->contributions[w].weight;
    m->known[part] = 1;
}

static int64_t list_part(const matter *m, int64_t part, skg_contribution *writes) {
    const skg_model *model = &m->plan->model;
    const int64_t parts = m->plan->scene->count, parent = parent_of(m, part);
    int64_t count = model->first_contribution[part + 1] - model->first_contribution[part];
    if (!m->listed[part] && (parent == parts || !m->listed[parent])) {
        memcpy(writes, model->contributions + model->first_contribution[part],
               (size_t)count * sizeof *writes);
        return count;
    }
    const double around = parent == parts ? 1 : m->density[parent];
    count = 0;
    for (int32_t k = 0; k < model->planes; k++) {
        const double weight = m->share[part] * (m->density[part] * m->own[part * model->planes + k] -
                                                around * m->own[parent * model->planes + k]);
        if (weight != 0) writes[count++] = (skg_contribution){.plane = k, .weight = weight};
    }
    return count;
}

skg_status skg_frame_list_matter(const skg_plan *plan, const skg_frame *given, skg_frame_parts *frame) {
    const skg_model *model = &plan->model;
    const int64_t parts = plan->scene->count, planes = model->planes;
    matter m = {.plan = plan};
    skg_status status = SKG_OK;
    if (given->override_count < 0 || !given->override_parts)
        return skg_fail(SKG_ERR_ARGUMENT, "a frame gives matter, but to no ids");
    SKG_TRY_CLEANUP(skg_alloc(2 * parts, sizeof *m.density, "matter of a frame", &m.density));
    SKG_TRY_CLEANUP(skg_alloc(2 * parts, 1, "matter of a frame", &m.known));
    SKG_TRY_CLEANUP(skg_alloc((parts + 1) * planes, sizeof *m.own, "matter of a frame", &m.own));
    SKG_TRY_CLEANUP(skg_alloc(parts * planes, sizeof *frame->writes, "parts of a frame", &frame->writes));
    SKG_TRY_CLEANUP(
        skg_alloc(parts + 1, sizeof *frame->first_write, "parts of a frame", &frame->first_write));
    m.share = m.density + parts, m.listed = m.known + parts;
    for (int64_t p = 0; p < parts; p++) m.density[p] = m.share[p] = 1;
    for (int64_t k = 0; k < given->override_count; k++) SKG_TRY_CLEANUP(read_one(given, k, &m));
    if (model->world_plane >= 0) m.own[parts * planes + model->world_plane] = model->world_weight;
    for (int64_t p = 0; p < parts; p++) find_own(&m, p);
    for (int64_t p = 0; p < parts; p++)
        frame->first_write[p + 1] =
            frame->first_write[p] + list_part(&m, p, frame->writes + frame->first_write[p]);
    frame->all_writes = frame->writes;
    frame->firsts = frame->first_write;
    frame->planes = planes;
cleanup:
    skg_free(&m.density);
    skg_free(&m.known);
    skg_free(&m.own);
    return status;
}
