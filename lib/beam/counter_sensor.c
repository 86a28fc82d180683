/* Histories of photons in the sensor of a detector that counts: where each leaves how much energy. */
#include "beam/counter_sensor.h"
#include "core/maths.h"
#include "material/scattering.h"
#include "material/shells.h"

#include <math.h>

/* Angles of Compton scattering, generations of fluorescence, and choices of a history. */
enum { ANGLES = 64, GENERATIONS = 3, LINES_MAX = 48, CHOICES = 8 + 4 * GENERATIONS };

/* A K line, or a scattered photon: how far it goes, and which lines follow where it is absorbed. */
typedef struct {
    double kev, per_mm, photo; /* the share of photo absorption among interactions */
    int32_t lines, reserved;
    double follows[LINES_MAX]; /* probabilities that have been added up, of lines of lower energy than it */
} flight;

struct skg_sensor {
    const skg_material *material; /* borrowed */
    double mm, pixel_mm[2];
    int32_t line_count, reserved;
    int32_t z[LINES_MAX];
    skg_shell shell[LINES_MAX];                   /* of the line's element */
    double fraction[LINES_MAX], share[LINES_MAX]; /* of the element by mass; of the line among vacancies */
    flight lines[LINES_MAX];
};

struct skg_arrival {
    const skg_sensor *sensor; /* borrowed */
    double efficiency;
    flight photon;
    double cosine[ANGLES + 1], chance[ANGLES + 1]; /* of Compton scattering; added up from 0 to 1 */
    flight scattered[ANGLES];                      /* of the middle of each step */
};

/* Lines that follow absorption at the energy of a flight, over all that absorbs or scatters it. */
static void find_flight(const skg_sensor *s, double kev, flight *f) {
    double sections[SKG_PROCESSES], sum = 0;
    skg_mixed_sections(s->material->count, s->material->parts, kev, sections);
    const double all = sections[SKG_PHOTO] + sections[SKG_COMPTON];
    f->kev = kev, f->per_mm = all * s->material->density / 10;
    f->photo = sections[SKG_PHOTO] / all;
    f->lines = s->line_count;
    for (int l = 0; l < s->line_count; l++) {
        double own[SKG_PROCESSES];
        if (kev >= s->shell[l].edge_kev[0]) {
            skg_element_sections(s->z[l], kev, own);
            sum += s->fraction[l] * own[SKG_PHOTO] * skg_shell_vacancies(&s->shell[l], kev) * s->share[l] /
                   sections[SKG_PHOTO];
        }
        f->follows[l] = sum;
    }
}

static void list_lines(skg_sensor *s) {
    for (int64_t p = 0; p < s->material->count; p++) {
        skg_shell shell;
        if (!skg_shell_find(s->material->parts[p].z, SKG_SHELL_K, &shell)) continue;
        for (int l = 0; l < SKG_K_LINES && s->line_count < LINES_MAX; l++) {
            const int at = s->line_count;
            if (!(shell.row->share[l] > 0) || !(shell.row->line_kev[l] > SKG_LOWEST_KEV)) continue;
            s->z[at] = s->material->parts[p].z, s->shell[at] = shell;
            s->fraction[at] = s->material->parts[p].fraction;
            s->share[at] = shell.row->yield * shell.row->share[l];
            s->lines[at].kev = shell.row->line_kev[l];
            s->line_count++;
        }
    }
    for (int l = 0; l < s->line_count; l++) find_flight(s, s->lines[l].kev, &s->lines[l]);
}

skg_status skg_sensor_create(const skg_material *material, const skg_counting *counting,
                             skg_sensor **sensor) {
    skg_sensor *made = NULL;
    *sensor = NULL;
    SKG_TRY(skg_scattering_check(material));
    SKG_TRY(skg_alloc(1, sizeof *made, "sensor", &made));
    made->material = material, made->mm = counting->thickness_mm;
    made->pixel_mm[0] = counting->pixel_mm[0], made->pixel_mm[1] = counting->pixel_mm[1];
    if (counting->fluorescence) list_lines(made);
    *sensor = made;
    return SKG_OK;
}

void skg_sensor_release(skg_sensor **sensor) {
    skg_free(sensor);
}

/* Klein and Nishina, times the scattering function: steps are even in the sine of half the angle, which is where S rises. */
static void find_scattering(skg_arrival *a, double kev) {
    const skg_sensor *s = a->sensor;
    a->cosine[0] = 1;
    for (int q = 0; q < ANGLES; q++) {
        const double x = (q + 0.5) / ANGLES, cosine = 1 - 2 * x * x;
        const double r = 1 / (1 + kev / SKG_ELECTRON_KEV * (1 - cosine));
        double coherent = 0, incoherent = 0;
        skg_scattering_factors(s->material, kev / SKG_HC_KEV_ANGSTROM * x, &coherent,
                               &incoherent); /* checked before */
        a->cosine[q + 1] = 1 - 2 * pow((q + 1.0) / ANGLES, 2);
        a->chance[q + 1] = a->chance[q] + x * r * r * (r + 1 / r - 1 + cosine * cosine) * incoherent;
        find_flight(s, fmax(r * kev, SKG_LOWEST_KEV), &a->scattered[q]);
    }
    for (int q = 1; q <= ANGLES; q++) a->chance[q] /= a->chance[ANGLES];
}

skg_status skg_arrival_create(const skg_sensor *sensor, double energy_kev, skg_arrival **arrival) {
    SKG_TRY(skg_alloc(1, sizeof **arrival, "sensor", arrival));
    skg_arrival *a = *arrival;
    a->sensor = sensor;
    find_flight(sensor, energy_kev, &a->photon);
    a->efficiency = -expm1(-a->photon.per_mm * sensor->mm);
    find_scattering(a, energy_kev);
    return SKG_OK;
}

void skg_arrival_release(skg_arrival **arrival) {
    skg_free(arrival);
}

double skg_arrival_efficiency(const skg_arrival *arrival) {
    return arrival->efficiency;
}

/* Choice k of history `index`, 0 to 1: point `index` of a lattice of rank 1 whose first 2^10 to 2^20 points are spread well (the vector
 * "lattice-32001-1024-1048576.3600" of R. Cools, F. Y. Kuo and D. Nuyens, SIAM Journal on Scientific Computing 28 (2006) 2162-2188). */
static double choose(int64_t index, int k) {
    static const int64_t vector[CHOICES] = {1,      182667, 469891, 498753, 110745, 446247, 250185,
                                            118627, 245333, 283199, 408519, 391023, 246327, 126539,
                                            399185, 461527, 300343, 69681,  516695, 436179};
    return ((double)(index * vector[k] % SKG_HISTORIES) + 0.5) / SKG_HISTORIES;
}

/* Moves along a direction until the next interaction. Returns 0 if that is outside the sensor. */
static int fly(const skg_sensor *s, const flight *f, const double way[3], double draw, skg_deposit *at) {
    const double path = -log1p(-draw) / f->per_mm;
    at->x += path * way[0], at->y += path * way[1], at->z += path * way[2];
    return at->z > 0 && at->z < s->mm;
}

/* The line that follows absorption; -1: none. */
static int find_line(const flight *f, double draw) {
    for (int l = 0; l < f->lines; l++)
        if (draw < f->follows[l]) return l;
    return -1;
}

/* Photo absorption of a photon, with the fluorescence that follows. k: the next choice */
static int absorb(const skg_sensor *s, const flight *f, double kev, skg_deposit at, int64_t index, int k,
                  int count, skg_deposit *deposits) {
    for (int g = 0; g < GENERATIONS; g++) {
        const int line = find_line(f, choose(index, k));
        if (line < 0) break;
        const double cosine = 1 - 2 * choose(index, k + 1), around = 2 * SKG_PI * choose(index, k + 2),
                     sine = sqrt(1 - cosine * cosine);
        const double way[3] = {sine * cos(around), sine * sin(around), cosine};
        at.kev = kev - s->lines[line].kev;
        deposits[count++] = at;
        kev = s->lines[line].kev, f = &s->lines[line];
        if (!fly(s, f, way, choose(index, k + 3), &at)) return count;
        k += 4;
    }
    at.kev = kev;
    deposits[count++] = at;
    return count;
}

/* The cosine of the angle of Compton scattering that a choice decides, and the step that it lies in. */
static double find_angle(const skg_arrival *a, double draw, int *step) {
    int low = 0, high = ANGLES;
    while (high - low > 1) {
        const int middle = (low + high) / 2;
        if (a->chance[middle] <= draw)
            low = middle;
        else
            high = middle;
    }
    const double part = (draw - a->chance[low]) / fmax(a->chance[high] - a->chance[low], 1e-300);
    *step = low;
    return a->cosine[low] + part * (a->cosine[high] - a->cosine[low]);
}

static double left_after(double kev, double cosine) {
    return kev / (1 + kev / SKG_ELECTRON_KEV * (1 - cosine));
}

/* Compton scattering: the electron's energy stays. The photon may interact once more; if it is scattered again, by an angle as the first
 * one, it leaves. */
static int scatter(const skg_arrival *a, skg_deposit at, int64_t index, skg_deposit *deposits) {
    const skg_sensor *s = a->sensor;
    int step = 0, again = 0;
    const double cosine = find_angle(a, choose(index, 4), &step), around = 2 * SKG_PI * choose(index, 5);
    const double sine = sqrt(fmax(1 - cosine * cosine, 0)), left = left_after(a->photon.kev, cosine);
    const double way[3] = {sine * cos(around), sine * sin(around), cosine};
    const flight *f = &a->scattered[step];
    at.kev = a->photon.kev - left;
    deposits[0] = at;
    if (!fly(s, f, way, choose(index, 6), &at)) return 1;
    if (choose(index, 7) < f->photo) return absorb(s, f, left, at, index, 8, 1, deposits);
    at.kev = left - left_after(left, find_angle(a, choose(index, 8), &again));
    deposits[1] = at;
    return 2;
}

int skg_arrival_follow(const skg_arrival *arrival, int64_t index, skg_deposit deposits[SKG_DEPOSITS_MAX]) {
    const skg_sensor *s = arrival->sensor;
    const skg_deposit at = {choose(index, 1) * s->pixel_mm[0], choose(index, 2) * s->pixel_mm[1],
                            -log1p(-choose(index, 0) * arrival->efficiency) / arrival->photon.per_mm, 0};
    if (choose(index, 3) < arrival->photon.photo)
        return absorb(s, &arrival->photon, arrival->photon.kev, at, index, 4, 0, deposits);
    return scatter(arrival, at, index, deposits);
}
