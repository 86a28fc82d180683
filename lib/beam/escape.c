/* K fluorescence that leaves a layer. */
#include "beam/escape.h"
#include "core/maths.h"
#include "material/material.h"
#include "material/shells.h"

#include <math.h>
#include <stdlib.h>

/* Cells of depth. With 256, shares that leave differ by less than 1e-3 of themselves from closed forms (escape_test.c). */
enum { CELLS = 256 };

/* An element that has a K shell in the tables. */
typedef struct {
    skg_shell shell;
    double fraction;    /* by mass */
    double left[CELLS]; /* of a vacancy in a cell: sum over lines of probability to leave times energy, keV */
    double left_squares[CELLS]; /* ... times its square */
} emitter;

struct skg_escape {
    const skg_material *material; /* borrowed */
    double mm;
    double bounds[CELLS + 1]; /* of cells, mm */
    int64_t count;
    emitter *emitters; /* [count] by rising edge */
};

/* The exponential integral E1 (Abramowitz and Stegun 5.1.11 and 5.1.22): a series, and a continued fraction by the method of
 * Lentz. */
static double integral_1(double x) {
    const double euler = 0.57721566490153286;
    if (x <= 1) {
        double sum = -euler - log(x), term = 1;
        for (int k = 1; k < 30; k++) term *= -x / k, sum -= term / k;
        return sum;
    }
    double b = x + 1, c = 1e300, d = 1 / b, value = d;
    for (int k = 1; k < 200; k++) {
        b += 2;
        d = 1 / (b - (double)k * k * d);
        c = b - (double)k * k / c;
        value *= c * d;
        if (fabs(c * d - 1) < 1e-15) break;
    }
    return value * exp(-x);
}

static double integral_2(double x) {
    if (!(x > 0)) return 1;
    return x < 700 ? exp(-x) - x * integral_1(x) : 0;
}

/* The integral of E2 from x to infinity, E3. */
static double integral_3(double x) {
    return 0.5 * (x < 700 ? exp(-x) - x * integral_2(x) : 0);
}

/* The share of photons from everywhere between two depths that leaves through the surface from which these are counted. */
static double through_surface(double per_mm, double low, double high) {
    return 0.5 * (integral_3(per_mm * low) - integral_3(per_mm * high)) / (per_mm * (high - low));
}

static int by_edge(const void *a, const void *b) {
    const emitter *x = a, *y = b;
    return (x->shell.edge_kev[0] > y->shell.edge_kev[0]) - (x->shell.edge_kev[0] < y->shell.edge_kev[0]);
}

static void find_emitters(skg_escape *escape) {
    const skg_material *material = escape->material;
    for (int64_t p = 0; p < material->count; p++) {
        emitter *e = &escape->emitters[escape->count];
        e->fraction = material->parts[p].fraction;
        escape->count += skg_shell_find(material->parts[p].z, SKG_SHELL_K, &e->shell);
    }
    qsort(escape->emitters, (size_t)escape->count, sizeof *escape->emitters, by_edge);
}

/* The share of the photons that interact which leave a vacancy in the K shell of an element. */
static double vacancies(const emitter *e, double kev, double cm2_g) {
    double sections[SKG_PROCESSES];
    if (!(kev >= e->shell.edge_kev[0])) return 0;
    skg_element_sections(e->shell.row->z, kev, sections);
    return e->fraction * sections[SKG_PHOTO] * skg_shell_vacancies(&e->shell, kev) / cm2_g;
}

/* Adds a line of e, of which all elements with lower edges are known. */
static void add_line(const skg_escape *escape, emitter *e, double kev, double probability) {
    double sections[SKG_PROCESSES];
    skg_mixed_sections(escape->material->count, escape->material->parts, kev, sections);
    const double cm2_g = skg_total_section(sections), per_mm = cm2_g * escape->material->density / 10;
    for (int c = 0; c < CELLS; c++) {
        const double low = escape->bounds[c], high = escape->bounds[c + 1];
        const double leaves = probability * (through_surface(per_mm, low, high) +
                                             through_surface(per_mm, escape->mm - high, escape->mm - low));
        e->left[c] += leaves * kev;
        e->left_squares[c] += leaves * kev * kev;
    }
    for (const emitter *next = escape->emitters; next < e; next++) {
        const double share = probability * vacancies(next, kev, cm2_g);
        if (!(share > 0)) continue;
        for (int c = 0; c < CELLS; c++) {
            const double z = 0.5 * (escape->bounds[c] + escape->bounds[c + 1]);
            double before = 0; /* the share that gets beyond a bound, on the side of the bound */
            for (int to = 0; to <= CELLS; to++) {
                const double beyond = 0.5 * integral_2(per_mm * fabs(escape->bounds[to] - z));
                const double reaches = to <= c ? beyond : 1 - beyond; /* ends before the bound */
                if (to > 0) {
                    e->left[c] += share * (reaches - before) * next->left[to - 1];
                    e->left_squares[c] += share * (reaches - before) * next->left_squares[to - 1];
                }
                before = reaches;
            }
        }
    }
}

skg_status skg_escape_create(const skg_material *material, double mm, skg_escape **escape) {
    skg_escape *made = NULL;
    *escape = NULL;
    if (material->kind != SKG_MATTER_COMPOSITION)
        return skg_fail(SKG_ERR_MATERIAL,
                        "%s: fluorescence escapes from elements, but its composition is not known; give a "
                        "formula or a mixture",
                        material->name);
    SKG_TRY(skg_alloc(1, sizeof *made, "escape", &made));
    const skg_status status = skg_alloc(material->count, sizeof *made->emitters, "escape", &made->emitters);
    if (status != SKG_OK) {
        skg_free(&made);
        return status;
    }
    made->material = material, made->mm = mm;
    for (int b = 0; b <= CELLS; b++) made->bounds[b] = 0.5 * mm * (1 - cos(SKG_PI * b / CELLS));
    find_emitters(made);
    for (emitter *e = made->emitters; e < made->emitters + made->count; e++) {
        const skg_shell_row *row = e->shell.row;
        for (int l = 0; l < SKG_K_LINES; l++)
            if (row->share[l] > 0) add_line(made, e, row->line_kev[l], row->yield * row->share[l]);
    }
    *escape = made;
    return SKG_OK;
}

void skg_escape_release(skg_escape **escape) {
    if (!*escape) return;
    skg_free(&(*escape)->emitters);
    skg_free(escape);
}

void skg_escape_moments(const skg_escape *escape, double energy_kev, double per_mm, double oblique,
                        double *energy, double *square) {
    const double mu = per_mm * oblique, all = -expm1(-mu * escape->mm);
    const double cm2_g = per_mm * 10 / escape->material->density;
    *energy = *square = 0;
    for (const emitter *e = escape->emitters; e < escape->emitters + escape->count; e++) {
        const double share = vacancies(e, energy_kev, cm2_g);
        if (!(share > 0)) continue;
        for (int c = 0; c < CELLS; c++) {
            const double low = escape->bounds[c], high = escape->bounds[c + 1];
            const double here = -exp(-mu * low) * expm1(-mu * (high - low)) / all;
            *energy += share * here * e->left[c];
            *square += share * here * e->left_squares[c];
        }
    }
}

void skg_escape_left(const skg_escape *escape, double energy_kev, int depths, const double *depth_mm,
                     double *energy, double *square) {
    double sections[SKG_PROCESSES];
    skg_mixed_sections(escape->material->count, escape->material->parts, energy_kev, sections);
    const double cm2_g = skg_total_section(sections);
    for (int i = 0; i < depths; i++) energy[i] = square[i] = 0;
    for (const emitter *e = escape->emitters; e < escape->emitters + escape->count; e++) {
        const double share = vacancies(e, energy_kev, cm2_g);
        if (!(share > 0)) continue;
        for (int i = 0; i < depths; i++) {
            const double cosine = 1 - 2 * depth_mm[i] / escape->mm;
            const int cell = (int)(acos(fmin(fmax(cosine, -1), 1)) / SKG_PI * CELLS);
            energy[i] += share * e->left[cell < CELLS ? cell : CELLS - 1];
            square[i] += share * e->left_squares[cell < CELLS ? cell : CELLS - 1];
        }
    }
}
