/* Photons that are followed one by one through the pixels of a sensor. */
#include "counter_photons.h"
#include "material/scattering.h"
#include "material/shells.h"
#include "support/random.h"

#include <math.h>
#include <string.h>

static const double PI = 3.14159265358979323846;

double number(history *h) {
    return draw(&h->seed, 0, 1);
}

/* Turns the photon by an angle. */
static void turn(history *h, double cosine) {
    const double around = 2 * PI * number(h), sine = sqrt(fmax(1 - cosine * cosine, 0));
    const double *w = h->way, across = hypot(w[0], w[1]);
    double u[3] = {1, 0, 0}, v[3];
    if (across > 1e-9) u[0] = -w[1] / across, u[1] = w[0] / across, u[2] = 0;
    v[0] = w[1] * u[2] - w[2] * u[1], v[1] = w[2] * u[0] - w[0] * u[2], v[2] = w[0] * u[1] - w[1] * u[0];
    double to[3];
    for (int k = 0; k < 3; k++) to[k] = cosine * w[k] + sine * (cos(around) * u[k] + sin(around) * v[k]);
    memcpy(h->way, to, sizeof to);
}

/* The share of a cloud along one direction that lies in pixel i. */
static double share(double x, double width, double pitch, int i) {
    if (width == 0) return x >= i * pitch && x < (i + 1) * pitch;
    return 0.5 * (erf(((i + 1) * pitch - x) / (sqrt(2) * width)) - erf((i * pitch - x) / (sqrt(2) * width)));
}

static void leave(history *h, double kev) {
    const sensor *s = h->s;
    const double drift = s->mm - h->at[2];
    const double width =
        sqrt(s->cloud_mm * s->cloud_mm + (s->bias_v > 0 ? 2 * 0.02585199 * drift * s->mm / s->bias_v : 0));
    const int column = (int)floor(h->at[0] / s->pixel_mm), row = (int)floor(h->at[1] / s->pixel_mm);
    for (int j = row - 2 > -REACH ? row - 2 : -REACH; j <= row + 2 && j <= REACH; j++)
        for (int i = column - 2 > -REACH ? column - 2 : -REACH; i <= column + 2 && i <= REACH; i++)
            h->charge[(j + REACH) * SIDE + i + REACH] +=
                kev * share(h->at[0], width, s->pixel_mm, i) * share(h->at[1], width, s->pixel_mm, j);
}

/* Photo absorption: the vacancy's element is drawn by its share, then its line. Returns 0 if the photon ends. */
static int absorb(history *h) {
    double sections[SKG_PROCESSES], own[SKG_PROCESSES];
    skg_mixed_sections(h->material->count, h->material->parts, h->kev, sections);
    double drawn = number(h) * sections[SKG_PHOTO];
    int64_t e = -1;
    do {
        e++;
        skg_element_sections(h->material->parts[e].z, h->kev, own);
        drawn -= own[SKG_PHOTO] * h->material->parts[e].fraction;
    } while (drawn > 0 && e < h->material->count - 1);
    skg_shell shell;
    const int known = skg_shell_find(h->material->parts[e].z, SKG_SHELL_K, &shell);
    if (known && h->kev >= shell.edge_kev[0] && number(h) < skg_shell_vacancies(&shell, h->kev) &&
        number(h) < shell.row->yield) {
        double which = number(h);
        int l = 0;
        for (; l < SKG_K_LINES - 1 && which >= shell.row->share[l]; l++) which -= shell.row->share[l];
        leave(h, h->kev - shell.row->line_kev[l]);
        h->kev = shell.row->line_kev[l];
        h->way[0] = h->way[1] = 0, h->way[2] = 1;
        turn(h, draw(&h->seed, -1, 1));
        return 1;
    }
    leave(h, h->kev);
    return 0;
}

/* Compton or Rayleigh scattering, by drawing angles and refusing them. */
static void scatter(history *h, int compton) {
    double most = 0, none = 0, unused = 0;
    skg_scattering_factors(h->material, 1e3, &none, &most);
    if (!compton) skg_scattering_factors(h->material, 0, &most, &unused);
    for (;;) {
        const double cosine = draw(&h->seed, -1, 1), x = sqrt((1 - cosine) / 2);
        const double r = compton ? 1 / (1 + h->kev / SKG_ELECTRON_KEV * (1 - cosine)) : 1;
        double coherent = 0, incoherent = 0;
        skg_scattering_factors(h->material, h->kev / SKG_HC_KEV_ANGSTROM * x, &coherent, &incoherent);
        const double chance =
            0.5 * r * r * (r + 1 / r - 1 + cosine * cosine) * (compton ? incoherent : coherent) / most;
        if (number(h) >= chance) continue;
        if (compton) leave(h, h->kev * (1 - r));
        h->kev *= r;
        turn(h, cosine);
        return;
    }
}

static void follow(history *h) {
    for (;;) {
        double sections[SKG_PROCESSES];
        skg_mixed_sections(h->material->count, h->material->parts, h->kev, sections);
        const double all = skg_total_section(sections),
                     path = -log1p(-number(h)) * 10 / (all * h->material->density);
        for (int k = 0; k < 3; k++) h->at[k] += path * h->way[k];
        if (h->at[2] < 0 || h->at[2] > h->s->mm) return;
        const double kind = number(h) * all;
        if (kind < sections[SKG_PHOTO]) {
            if (!absorb(h)) return;
        } else {
            scatter(h, kind < sections[SKG_PHOTO] + sections[SKG_COMPTON]);
            if (h->kev < 1.5) return leave(h, h->kev);
        }
    }
}

double normal(history *h) {
    return sqrt(-2 * log(1 - number(h))) * cos(2 * PI * number(h));
}

void follow_photon(history *h) {
    memset(h->charge, 0, sizeof h->charge);
    h->at[0] = number(h) * h->s->pixel_mm, h->at[1] = number(h) * h->s->pixel_mm, h->at[2] = 0;
    h->way[0] = h->way[1] = 0, h->way[2] = 1, h->kev = h->s->kev;
    follow(h);
}

int window_of(const sensor *s, double kev) {
    int w = -1;
    while (w < WINDOWS - 1 && kev >= s->thresholds[w + 1]) w++;
    return w;
}
