/* Losses of a registration and their normal equations, from Gram matrices of columns over the pixels. */
#include "registration/types.h"

#include <string.h>

void reg_basis(int64_t rows, int64_t columns, int64_t row, int64_t column, double *basis) {
    const double y = (2 * (double)row + 1) / (double)rows - 1,
                 x = (2 * (double)column + 1) / (double)columns - 1;
    const double values[REG_BASIS] = {1,
                                      x,
                                      y,
                                      x * x,
                                      x * y,
                                      y * y,
                                      x * x * x,
                                      x * x * y,
                                      x * y * y,
                                      y * y * y,
                                      x * x * x * x,
                                      x * x * x * y,
                                      x * x * y * y,
                                      x * y * y * y,
                                      y * y * y * y};
    memcpy(basis, values, sizeof values);
}

/* The model at a pixel, and what it changes with the exponent (slope) and with the added transmission (1 / total). */
typedef struct {
    double value, slope, inverse;
} modelled;

static modelled model_at(double exponent, double added) {
    const double passed = exp(-exponent), total = passed + added + REG_FLOOR;
    /* Polynomials that take more than there is: no slope leads further that way. */
    if (!(total > 0.1 * REG_FLOOR)) return (modelled){-log(0.1 * REG_FLOOR), 0, 0};
    return (modelled){-log(total), passed / total, 1 / total};
}

/* Columns of a Gram matrix at one level in one radiograph. */
typedef struct {
    const reg_shrunk *shrunk;
    const float *body;
    const double *derivatives, *nuisances;
    int64_t local;
    int32_t loss, body_gain;
} columns_of;

/* Columns of a pixel: derivatives, for least squares those by the nuisances, and the difference; otherwise model, radiograph, 1. */
static int64_t column_count(const columns_of *c) {
    return c->local + (c->loss == SKG_REGISTRATION_LOSS_LSQ ? REG_NUISANCES + 1 : 3);
}

/* The gain of the body's contrast. */
static double gain_of(const columns_of *c) {
    return c->loss == SKG_REGISTRATION_LOSS_LSQ && c->body_gain ? 1 + c->nuisances[REG_BASIS + REG_BODY_OWN]
                                                                : 1;
}

static void shares_at(const columns_of *c, int64_t pixel, double *shares) {
    for (int k = 0; k < REG_SHARES; k++) shares[k] = c->shrunk->gains ? c->shrunk->shares[k][pixel] : 0;
    shares[REG_BODY_OWN] = c->body_gain ? (double)c->body[pixel] - shares[REG_BODY_OWN] : 0;
}

static void columns_at(const columns_of *c, int64_t pixel, double *values) {
    const reg_shrunk *s = c->shrunk;
    const int64_t size = s->rows * s->columns;
    const double gain = gain_of(c);
    double exponent = (double)c->body[pixel] + s->rest[pixel], added = 0, basis[REG_BASIS],
           shares[REG_SHARES];
    if (c->loss == SKG_REGISTRATION_LOSS_LSQ) {
        shares_at(c, pixel, shares);
        reg_basis(s->rows, s->columns, pixel / s->columns, pixel % s->columns, basis);
        for (int64_t k = s->terms; k < REG_BASIS; k++) basis[k] = 0;
        for (int k = 0; k < REG_BASIS; k++) {
            exponent += c->nuisances[k] * basis[k];
            added += c->nuisances[REG_ADDED + k] * basis[k];
        }
        for (int k = 0; k < REG_SHARES; k++) exponent += c->nuisances[REG_BASIS + k] * shares[k];
    }
    const modelled m = model_at(exponent, added);
    for (int64_t k = 0; k < c->local; k++) {
        const double slope = c->derivatives ? c->derivatives[k * size + pixel] : 0;
        *values++ = m.slope > 0 ? m.slope * gain * slope : 0;
    }
    if (c->loss == SKG_REGISTRATION_LOSS_LSQ) {
        for (int k = 0; k < REG_BASIS; k++) {
            values[k] = m.slope * basis[k];
            values[REG_ADDED + k] = -m.inverse * basis[k];
        }
        for (int k = 0; k < REG_SHARES; k++) values[REG_BASIS + k] = m.slope * shares[k];
        values[REG_NUISANCES] = m.value - s->fixed[pixel];
        return;
    }
    values[0] = m.value, values[1] = s->fixed[pixel], values[2] = 1;
}

static void add_product(int64_t count, const double *values, double gram[REG_GRAM][REG_GRAM]) {
    for (int64_t a = 0; a < count; a++)
        for (int64_t b = 0; b <= a; b++) gram[a][b] += values[a] * values[b];
}

static void mirror(int64_t count, double gram[REG_GRAM][REG_GRAM]) {
    for (int64_t a = 0; a < count; a++)
        for (int64_t b = 0; b < a; b++) gram[b][a] = gram[a][b];
}

/* step: 0: of the pixels themselves; otherwise of the differences of pixels that are one column (1) or row (columns) apart. */
static void make_gram(const columns_of *c, int64_t step, double gram[REG_GRAM][REG_GRAM]) {
    const reg_shrunk *s = c->shrunk;
    const int64_t size = s->rows * s->columns, count = column_count(c);
    double values[REG_GRAM], next[REG_GRAM];
    memset(gram, 0, sizeof(double[REG_GRAM][REG_GRAM]));
    for (int64_t p = 0; p < size; p++) {
        if (!(s->mask[p] > 0)) continue;
        if (step > 0 &&
            (p + step >= size || !(s->mask[p + step] > 0) || (step == 1 && (p + 1) % s->columns == 0)))
            continue;
        columns_at(c, p, values);
        if (step > 0) {
            columns_at(c, p + step, next);
            for (int64_t k = 0; k < count - 1; k++) values[k] = next[k] - values[k];
        }
        add_product(count, values, gram);
    }
    mirror(count, gram);
}

skg_status reg_equations_create(const skg_registration *r, reg_equations *e) {
    const int64_t count = reg_count(r);
    SKG_TRY(skg_alloc(count * count, sizeof *e->matrix, "normal equations", &e->matrix));
    SKG_TRY(skg_alloc(count, sizeof *e->gradient, "normal equations", &e->gradient));
    return skg_alloc(r->image_count * (REG_LOCAL + 1) * REG_NUISANCES, sizeof *e->coupling,
                     "normal equations", &e->coupling);
}

void reg_equations_free(reg_equations *e) {
    skg_free(&e->matrix);
    skg_free(&e->gradient);
    skg_free(&e->coupling);
}

static int64_t counted(const skg_registration *r, const reg_level *level) {
    int64_t count = 0;
    for (int64_t i = 0; i < r->image_count; i++)
        for (int64_t p = 0; p < level->images[i].rows * level->images[i].columns; p++)
            count += level->images[i].mask[p] > 0;
    return count > 0 ? count : 1;
}

/* Eliminates the nuisances of a radiograph and adds what remains. gram: derivatives, nuisances, difference. */
static void add_squares(const skg_registration *r, int64_t image, int64_t local, double scale, double damping,
                        double gram[REG_GRAM][REG_GRAM], reg_equations *e) {
    double own[REG_NUISANCES * REG_NUISANCES], *x = e->coupling + image * (REG_LOCAL + 1) * REG_NUISANCES;
    const int64_t count = reg_count(r), first = reg_first(r, image), last = local + REG_NUISANCES;
    for (int a = 0; a < REG_NUISANCES; a++)
        for (int b = 0; b < REG_NUISANCES; b++) own[a * REG_NUISANCES + b] = gram[local + a][local + b];
    /* Polynomials of both kinds are nearly the same where the transmission is: a rounding error more keeps them apart. */
    for (int a = 0; a < REG_NUISANCES; a++) {
        double *diagonal = &own[a * (REG_NUISANCES + 1)];
        *diagonal = *diagonal > 0 ? *diagonal * (1 + 1e-8 + damping) : 1; /* 0: nothing is at rest */
    }
    for (int64_t k = 0; k <= local; k++)
        for (int a = 0; a < REG_NUISANCES; a++)
            x[k * REG_NUISANCES + a] = gram[local + a][k < local ? k : last];
    if (!reg_solve(REG_NUISANCES, own, local + 1, x))
        memset(x, 0, (size_t)((local + 1) * REG_NUISANCES) * sizeof *x);
    for (int64_t k = 0; k <= local; k++)
        for (int64_t l = 0; l <= local; l++) {
            double sum = gram[k < local ? k : last][l < local ? l : last];
            const double whole = sum;
            for (int a = 0; a < REG_NUISANCES; a++)
                sum -= gram[local + a][k < local ? k : last] * x[l * REG_NUISANCES + a];
            if (k < local && l < local) e->matrix[(first + k) * count + first + l] += scale * sum;
            if (k < local && l == local) e->gradient[first + k] += scale * sum;
            if (k == local && l == local) {
                e->cost += scale * whole;
                e->reduction += scale * (whole - sum);
            }
        }
}

/* Adds half the square of the distance between the two normalised columns: 1 - their correlation. */
static void add_correlation(const skg_registration *r, int64_t image, int64_t local, double scale,
                            double gram[REG_GRAM][REG_GRAM], reg_equations *e) {
    const int64_t m = local, f = local + 1, one = local + 2, count = reg_count(r),
                  first = reg_first(r, image);
    const double n = gram[one][one] > 0 ? gram[one][one] : 1;
    double centred[REG_GRAM][REG_GRAM];
    for (int64_t a = 0; a <= f; a++)
        for (int64_t b = 0; b <= f; b++) centred[a][b] = gram[a][b] - gram[a][one] * gram[b][one] / n;
    const double mm = centred[m][m], ff = centred[f][f];
    if (!(mm > 0 && ff > 0)) {
        e->cost += scale;
        return;
    }
    const double correlation = centred[m][f] / sqrt(mm * ff);
    e->cost += scale * (1 - correlation);
    for (int64_t a = 0; a < local; a++) {
        e->gradient[first + a] -=
            0.5 * scale * (centred[a][f] / sqrt(mm * ff) - centred[a][m] * correlation / mm);
        for (int64_t b = 0; b < local; b++)
            e->matrix[(first + a) * count + first + b] +=
                0.5 * scale * (centred[a][b] - centred[a][m] * centred[b][m] / mm) / mm;
    }
}

static void add_image(const skg_registration *r, const reg_level *level, const reg_state *state,
                      int64_t image, const float *body, const double *derivatives, int64_t local,
                      double damping, reg_equations *e) {
    const columns_of c = {.shrunk = &level->images[image],
                          .body = body,
                          .derivatives = derivatives,
                          .nuisances = state->nuisances + image * REG_NUISANCES,
                          .body_gain = state->body_gain,
                          .local = local,
                          .loss = r->loss};
    double gram[REG_GRAM][REG_GRAM];
    if (r->loss == SKG_REGISTRATION_LOSS_LSQ) {
        make_gram(&c, 0, gram);
        add_squares(r, image, local, 1 / (double)counted(r, level), damping, gram, e);
        return;
    }
    const int gradients = r->loss == SKG_REGISTRATION_LOSS_GRADIENT_NCC;
    for (int way = 0; way < 1 + gradients; way++) {
        make_gram(&c, !gradients ? 0 : way == 0 ? 1 : c.shrunk->columns, gram);
        add_correlation(r, image, local, 1 / (double)((1 + gradients) * r->image_count), gram, e);
    }
}

void reg_equations_add(const skg_registration *r, const reg_level *level, const reg_state *state,
                       int64_t image, const float *body, const double *derivatives, double damping,
                       reg_equations *equations) {
    add_image(r, level, state, image, body, derivatives, derivatives ? reg_local_count(r) : 0, damping,
              equations);
}

/* Sums of squares alone need no Gram matrix. */
static double squares(const skg_registration *r, const reg_level *level, const reg_state *state,
                      int64_t image, const float *body) {
    const columns_of c = {.shrunk = &level->images[image],
                          .body = body,
                          .nuisances = state->nuisances + image * REG_NUISANCES,
                          .body_gain = state->body_gain,
                          .loss = r->loss};
    double values[REG_GRAM], sum = 0;
    for (int64_t p = 0; p < c.shrunk->rows * c.shrunk->columns; p++) {
        if (!(c.shrunk->mask[p] > 0)) continue;
        columns_at(&c, p, values);
        sum += values[REG_NUISANCES] * values[REG_NUISANCES];
    }
    return sum;
}

double reg_loss(const skg_registration *r, const reg_level *level, const reg_state *state,
                float *const *images) {
    reg_equations sums = {0};
    double sum = 0;
    for (int64_t i = 0; i < r->image_count; i++) {
        if (r->loss == SKG_REGISTRATION_LOSS_LSQ)
            sum += squares(r, level, state, i, images[i]);
        else
            add_image(r, level, state, i, images[i], NULL, 0, 0, &sums);
    }
    return r->loss == SKG_REGISTRATION_LOSS_LSQ ? sum / (double)counted(r, level) : sums.cost;
}

void reg_nuisances_move(const skg_registration *r, const reg_equations *equations, const double *step,
                        reg_state *state) {
    const int64_t local = reg_local_count(r);
    if (r->loss != SKG_REGISTRATION_LOSS_LSQ) return;
    for (int64_t i = 0; i < r->image_count; i++) {
        const double *x = equations->coupling + i * (REG_LOCAL + 1) * REG_NUISANCES;
        double *to = state->nuisances + i * REG_NUISANCES;
        for (int a = 0; a < REG_NUISANCES; a++) {
            to[a] -= x[local * REG_NUISANCES + a];
            for (int64_t k = 0; k < local; k++) to[a] -= x[k * REG_NUISANCES + a] * step[reg_first(r, i) + k];
        }
    }
}

skg_status reg_nuisances_find(const skg_registration *r, const reg_level *level, reg_state *state,
                              float *const *images) {
    enum { TURNS = 8 };
    reg_equations e = {0};
    reg_state trial = {0};
    skg_status status = SKG_OK;
    double loss = reg_loss(r, level, state, images), damping = 0;
    if (r->loss != SKG_REGISTRATION_LOSS_LSQ) return SKG_OK;
    SKG_TRY_CLEANUP(reg_equations_create(r, &e));
    SKG_TRY_CLEANUP(reg_state_create(r, &trial));
    for (int turn = 0; turn < TURNS; turn++) {
        reg_state_copy(r, state, &trial);
        for (int64_t i = 0; i < r->image_count; i++) {
            const double *x = e.coupling + i * (REG_LOCAL + 1) * REG_NUISANCES;
            e.cost = e.reduction = 0;
            add_image(r, level, state, i, images[i], NULL, 0, damping, &e);
            for (int a = 0; a < REG_NUISANCES; a++) trial.nuisances[i * REG_NUISANCES + a] -= x[a];
        }
        const double next = reg_loss(r, level, &trial, images);
        damping = next < loss ? damping / 10 : fmax(10 * damping, 1e-3);
        if (!(next < loss)) continue;
        const int small = loss - next < 1e-6 * loss;
        loss = next;
        reg_state_copy(r, &trial, state);
        if (small) break;
    }
cleanup:
    reg_equations_free(&e);
    reg_state_free(&trial);
    return status;
}

void reg_model(const skg_registration *r, const reg_level *level, const reg_state *state, int64_t image,
               const float *body, double *model) {
    const columns_of c = {.shrunk = &level->images[image],
                          .body = body,
                          .nuisances = state->nuisances + image * REG_NUISANCES,
                          .body_gain = state->body_gain,
                          .loss = SKG_REGISTRATION_LOSS_LSQ};
    double values[REG_GRAM];
    (void)r;
    for (int64_t p = 0; p < c.shrunk->rows * c.shrunk->columns; p++) {
        columns_at(&c, p, values);
        model[p] = values[REG_NUISANCES] + c.shrunk->fixed[p];
    }
}

void reg_contrast(const reg_level *level, const reg_state *state, int64_t image, const float *body,
                  const double *contrast, double sums[3]) {
    const columns_of c = {.shrunk = &level->images[image],
                          .body = body,
                          .derivatives = contrast,
                          .nuisances = state->nuisances + image * REG_NUISANCES,
                          .body_gain = state->body_gain,
                          .local = 1,
                          .loss = SKG_REGISTRATION_LOSS_LSQ};
    double gram[REG_GRAM][REG_GRAM], own[REG_NUISANCES * REG_NUISANCES], x[2 * REG_NUISANCES];
    const int last = 1 + REG_NUISANCES, own_gain = 1 + REG_BASIS + REG_BODY_OWN, which[2] = {0, last};
    make_gram(&c, 0, gram);
    for (int a = 0; a < REG_GRAM; a++) gram[own_gain][a] = gram[a][own_gain] = 0;
    for (int a = 0; a < REG_NUISANCES; a++) {
        for (int b = 0; b < REG_NUISANCES; b++) own[a * REG_NUISANCES + b] = gram[1 + a][1 + b];
        double *diagonal = &own[a * (REG_NUISANCES + 1)];
        *diagonal = *diagonal > 0 ? *diagonal * (1 + 1e-8) : 1; /* as add_squares */
        for (int k = 0; k < 2; k++) x[k * REG_NUISANCES + a] = gram[1 + a][which[k]];
    }
    if (!reg_solve(REG_NUISANCES, own, 2, x)) memset(x, 0, sizeof x);
    double left[3];
    for (int k = 0, at = 0; k < 2; k++)
        for (int l = k; l < 2; l++, at++) {
            left[at] = gram[which[k]][which[l]];
            for (int a = 0; a < REG_NUISANCES; a++)
                left[at] -= gram[1 + a][which[k]] * x[l * REG_NUISANCES + a];
        }
    /* A body that shows the other way round does not agree: the difference is from its contrast as it should be. */
    const int turned = gain_of(&c) < 0;
    sums[0] += left[0];
    sums[1] += turned ? 2 * left[0] - left[1] : left[1];
    sums[2] += turned ? 4 * left[0] - 4 * left[1] + left[2] : left[2];
}

void reg_scores(const skg_registration *r, const reg_level *level, const reg_state *state, int64_t image,
                const float *body, const double *derivatives, const reg_equations *equations, double *meat) {
    enum { CELLS = 16 };
    const columns_of c = {.shrunk = &level->images[image],
                          .body = body,
                          .derivatives = derivatives,
                          .nuisances = state->nuisances + image * REG_NUISANCES,
                          .body_gain = state->body_gain,
                          .local = reg_local_count(r),
                          .loss = SKG_REGISTRATION_LOSS_LSQ};
    const reg_shrunk *s = c.shrunk;
    const double *x = equations->coupling + image * (REG_LOCAL + 1) * REG_NUISANCES;
    const int64_t count = reg_count(r), first = reg_first(r, image);
    double sums[CELLS * CELLS][REG_LOCAL] = {{0}}, values[REG_GRAM];
    for (int64_t p = 0; p < s->rows * s->columns; p++) {
        if (!(s->mask[p] > 0)) continue;
        double *sum = sums[p / s->columns * CELLS / s->rows * CELLS + p % s->columns * CELLS / s->columns];
        columns_at(&c, p, values);
        const double left = values[c.local + REG_NUISANCES];
        for (int64_t k = 0; k < c.local; k++) {
            double slope = values[k];
            for (int a = 0; a < REG_NUISANCES; a++) slope -= values[c.local + a] * x[k * REG_NUISANCES + a];
            sum[k] += slope * left;
        }
    }
    for (int64_t cell = 0; cell < CELLS * CELLS; cell++)
        for (int64_t k = 0; k < c.local; k++)
            for (int64_t l = 0; l < c.local; l++)
                meat[(first + k) * count + first + l] += sums[cell][k] * sums[cell][l];
}
