/* Levenberg's and Marquardt's search at one level of the pyramid. */
#include "registration/types.h"

#include "core/log.h"

#include <string.h>

/* Longest step, mm; shifts, or what a turn moves the rim by. */
static const double longest = 15;

typedef struct {
    float **images; /* of the state */
    float **tried;
    double *derivatives; /* of one radiograph */
    double *step, *scaled, *damped;
    reg_equations equations;
    reg_state trial;
} searching;

skg_status reg_images_create(const skg_registration *r, const reg_level *level, float ***images) {
    SKG_TRY(skg_alloc(r->image_count, sizeof **images, "images of a registration", images));
    for (int64_t i = 0; i < r->image_count; i++)
        SKG_TRY(skg_alloc(level->images[i].rows * level->images[i].columns, sizeof ***images,
                          "images of a registration", &(*images)[i]));
    return SKG_OK;
}

void reg_images_free(const skg_registration *r, float ***images) {
    for (int64_t i = 0; *images && i < r->image_count; i++) skg_free(&(*images)[i]);
    skg_free(images);
}

static skg_status begin(const skg_registration *r, const reg_level *level, searching *s) {
    const int64_t count = reg_count(r);
    int64_t most = 0;
    for (int64_t i = 0; i < r->image_count; i++) {
        const int64_t size = level->images[i].rows * level->images[i].columns;
        most = size > most ? size : most;
    }
    SKG_TRY(reg_images_create(r, level, &s->images));
    SKG_TRY(reg_images_create(r, level, &s->tried));
    SKG_TRY(skg_alloc(reg_local_count(r) * most, sizeof *s->derivatives, "derivatives", &s->derivatives));
    SKG_TRY(skg_alloc(count, sizeof *s->step, "step", &s->step));
    SKG_TRY(skg_alloc(count, sizeof *s->scaled, "step", &s->scaled));
    SKG_TRY(skg_alloc(count * count, sizeof *s->damped, "normal equations", &s->damped));
    SKG_TRY(reg_equations_create(r, &s->equations));
    return reg_state_create(r, &s->trial);
}

static void end(const skg_registration *r, searching *s) {
    reg_images_free(r, &s->images);
    reg_images_free(r, &s->tried);
    skg_free(&s->derivatives);
    skg_free(&s->step);
    skg_free(&s->scaled);
    skg_free(&s->damped);
    reg_equations_free(&s->equations);
    reg_state_free(&s->trial);
}

skg_status reg_progress(skg_registration *r) {
    const int64_t levels = r->level_count + r->options.polish;
    return skg_progress_step(r->options.progress, r->path_count, levels * r->options.steps);
}

static skg_status linearize(skg_registration *r, const reg_level *level, const reg_state *state,
                            double damping, searching *s) {
    const int64_t count = reg_count(r);
    reg_equations *e = &s->equations;
    memset(e->matrix, 0, (size_t)(count * count) * sizeof *e->matrix);
    memset(e->gradient, 0, (size_t)count * sizeof *e->gradient);
    e->cost = e->reduction = 0;
    for (int64_t i = 0; i < r->image_count; i++) {
        SKG_TRY(reg_progress(r)); /* Ctrl-C is answered between radiographs */
        SKG_TRY(reg_differentiate(r, level, state, i, s->derivatives));
        reg_equations_add(r, level, state, i, s->images[i], s->derivatives, damping, e);
    }
    /* A pose is damped by mm alike; of a geometry, each number by its own weight. */
    double most = 0;
    for (int64_t k = 0; k < count; k++) most = fmax(most, e->matrix[k * (count + 1)]);
    for (int64_t k = 0; k < count; k++) {
        const double own = e->matrix[k * (count + 1)];
        s->scaled[k] = r->options.free == SKG_REGISTRATION_FREE_POSE ? most : fmax(own, 1e-12 * most);
    }
    return SKG_OK;
}

/* The damped step, and by how much it should lower the loss; 0: there is none. */
static double find_step(const skg_registration *r, double damping, searching *s) {
    const int64_t count = reg_count(r);
    const reg_equations *e = &s->equations;
    double length = 0, change = 0;
    memcpy(s->damped, e->matrix, (size_t)(count * count) * sizeof *s->damped);
    for (int64_t k = 0; k < count; k++) {
        s->damped[k * (count + 1)] += damping * s->scaled[k];
        s->step[k] = -e->gradient[k];
    }
    if (!reg_solve(count, s->damped, 1, s->step)) return 0;
    for (int64_t k = 0; k + 2 < count; k += 3) length = fmax(length, skg_length(s->step + k));
    for (int64_t k = 0; k < count && length > longest; k++) s->step[k] *= longest / length;
    for (int64_t k = 0; k < count; k++) {
        change += 2 * e->gradient[k] * s->step[k];
        for (int64_t l = 0; l < count; l++) change += s->step[k] * e->matrix[k * count + l] * s->step[l];
    }
    return e->reduction - change;
}

static skg_status note(skg_registration *r, const reg_level *level, double loss) {
    SKG_TRY(skg_realloc(r->path_count + 1, sizeof *r->path, "steps of a registration", &r->path));
    r->path[r->path_count++] = (reg_step){level->factor, loss};
    return SKG_OK;
}

/* Largest motion of a step, mm. */
static double step_length(const skg_registration *r, const double *step) {
    double most = 0;
    for (int64_t k = 0; k < reg_count(r); k++) most = fmax(most, fabs(step[k]));
    return most;
}

/* Steps of less than this share of a pixel end a level: of the finest, and of others. An assumption that costs no accuracy: the next level
 * begins where this one ends. */
static double least_step(const skg_registration *r, const reg_level *level) {
    const double pixel = skg_length(r->images[0].view.column_step);
    return (level->factor > 1 ? 0.02 * (double)level->factor : 1e-3) * pixel;
}

/* Steps that lower the loss by less than this share end a level. Of 40,000 pixels of noise, one standard deviation along a direction is
 * 2.5e-5. An assumption as above. */
static double least_gain(const reg_level *level) {
    return level->factor > 1 ? 1e-4 : 1e-5;
}

static skg_status iterate(skg_registration *r, const reg_level *level, reg_state *state, double *loss,
                          searching *s) {
    double damping = 1e-3, growth = 2;
    SKG_TRY(reg_render(r, level, state, s->images));
    SKG_TRY(reg_nuisances_find(r, level, state, s->images));
    *loss = reg_loss(r, level, state, s->images);
    SKG_TRY(note(r, level, *loss));
    SKG_TRY(linearize(r, level, state, 0, s));
    for (int64_t k = 0; k < r->options.steps && damping < 1e9; k++) {
        SKG_TRY(reg_progress(r));
        const double expected = find_step(r, damping, s);
        if (!(expected > 1e-9 * *loss)) return SKG_OK;
        reg_state_copy(r, state, &s->trial);
        reg_state_move(r, s->step, &s->trial);
        reg_nuisances_move(r, &s->equations, s->step, &s->trial);
        SKG_TRY(reg_render(r, level, &s->trial, s->tried));
        double next = reg_loss(r, level, &s->trial, s->tried);
        if (!(next < *loss)) { /* the pose's step may be right, and that of the nuisances too long */
            memcpy(s->trial.nuisances, state->nuisances,
                   (size_t)(r->image_count * REG_NUISANCES) * sizeof *state->nuisances);
            SKG_TRY(reg_nuisances_find(r, level, &s->trial, s->tried));
            next = reg_loss(r, level, &s->trial, s->tried);
        }
        const double gain = (*loss - next) / expected;
        const double length = step_length(r, s->step);
        SKG_TRY(note(r, level, next));
        if (!(next < *loss)) {
            damping *= growth, growth *= 2;
            if (length < least_step(r, level)) return SKG_OK;
            continue;
        }
        float **images = s->images;
        s->images = s->tried, s->tried = images;
        reg_state_copy(r, &s->trial, state);
        const int small = length < least_step(r, level) || *loss - next < least_gain(level) * *loss;
        *loss = next;
        if (small) return SKG_OK;
        damping *= fmax(1.0 / 3, 1 - pow(2 * gain - 1, 3)), growth = 2;
        SKG_TRY(linearize(r, level, state, 0, s));
    }
    return SKG_OK;
}

skg_status reg_search(skg_registration *r, const reg_level *level, reg_state *state, double *loss) {
    searching s = {0};
    skg_status status = begin(r, level, &s);
    if (status == SKG_OK) status = iterate(r, level, state, loss, &s);
    end(r, &s);
    return status;
}
