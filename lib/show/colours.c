/* The colours of parts. */
#include "scene/scene.h"

#include <skiagraph/scene_picture.h>

#include <math.h>

/* Matter of rising density, in g/cm3, and its colour: gas, lung, fat, soft tissue, bone, light and heavy metals. */
static const struct {
    double density, colour[3];
} tissues[] = {{0, {0.62, 0.80, 0.95}},    {0.2, {0.93, 0.66, 0.66}},  {0.85, {0.95, 0.84, 0.52}},
               {0.98, {0.93, 0.74, 0.55}}, {1.04, {0.80, 0.42, 0.38}}, {1.12, {0.72, 0.34, 0.36}},
               {1.25, {0.93, 0.87, 0.74}}, {2.2, {0.96, 0.93, 0.84}},  {2.6, {0.74, 0.78, 0.82}},
               {8, {0.58, 0.62, 0.68}},    {20, {0.85, 0.72, 0.35}}};
enum { TISSUES = sizeof tissues / sizeof *tissues };

/* Parts of the same density differ in brightness by up to this share, so that they can be told apart. */
static const double VARIATION = 0.07;

/* The opacity of a part that holds others. */
enum { TRANSLUCENT = 46, OPAQUE = 255 };

/* The attenuation coefficient of water at an energy where that of tissues follows their density (NIST, XCOM), 1/cm. */
static const double WATER = 0.1929, ENERGY = 70;

/* The density of a material; if it is unknown, that of water with the same attenuation. 0: it attenuates nothing. */
static double density_of(const skg_material *material) {
    double density = 0, per_cm = 0;
    if (skg_material_density_get(material, &density) == SKG_OK && density > 0) return density;
    return skg_material_attenuation_get(material, ENERGY, &per_cm) == SKG_OK ? per_cm / WATER : 0;
}

static void of_density(double density, double colour[3]) {
    int upper = 1;
    while (upper < TISSUES - 1 && tissues[upper].density < density) upper++;
    const double low = tissues[upper - 1].density, high = tissues[upper].density;
    const double share = fmin(fmax((density - low) / (high - low), 0), 1);
    for (int k = 0; k < 3; k++)
        colour[k] =
            tissues[upper - 1].colour[k] + share * (tissues[upper].colour[k] - tissues[upper - 1].colour[k]);
}

/* Hues that are far apart for consecutive numbers: steps of the golden section. */
static void of_number(int64_t number, double colour[3]) {
    const double hue = fmod(0.58 + 0.618033988749895 * (double)number, 1.0);
    for (int k = 0; k < 3; k++) {
        const double wave = fabs(fmod(6 * hue + (k == 0 ? 0 : k == 1 ? 4 : 2), 6.0) - 3) - 1;
        colour[k] = 0.42 + 0.45 * fmin(fmax(wave, 0), 1);
    }
}

/* How many parts lie inside each one, at any depth. The numbers are zero before. */
static void count_inside(const skg_scene *scene, int64_t *inside) {
    for (int64_t i = 0; i < scene->count; i++)
        for (int64_t holder = scene->parts[i].inside; holder >= 0; holder = scene->parts[holder].inside)
            inside[holder]++;
}

skg_status skg_look_colours_get(const skg_scene *scene, uint8_t *colours) {
    SKG_NEEDS(scene);
    SKG_NEEDS(colours);
    int64_t *inside = NULL;
    SKG_TRY(skg_alloc(scene->count, sizeof *inside, "parts inside others", &inside));
    count_inside(scene, inside);
    for (int64_t i = 0; i < scene->count; i++) {
        const double density = density_of(scene->parts[i].material);
        double colour[3];
        if (density > 0)
            of_density(density, colour);
        else
            of_number(i, colour);
        /* the whole scene may be a single part in a part */
        const int holds = inside[i] > 1 || (inside[i] == 1 && scene->parts[i].inside < 0);
        const double brightness = density > 0 ? 1 + VARIATION * sin(2.4 * (double)i) : 1;
        for (int k = 0; k < 3; k++)
            colours[4 * i + k] = (uint8_t)lround(255 * fmin(colour[k] * brightness, 1));
        colours[4 * i + 3] = holds ? TRANSLUCENT : OPAQUE;
    }
    skg_free(&inside);
    return SKG_OK;
}
