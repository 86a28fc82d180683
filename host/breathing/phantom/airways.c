/* Trachea and bronchi of the generated thorax. */
#include "phantom/anatomy.h"

#include "core/maths.h"
#include "phantom/makers.h"
#include "phantom/shapes.h"

enum { AIRWAYS = 3 };

/* Trachea and main bronchi of the full and of the simple thorax: ends and radius, mm. */
static const struct {
    const char *label;
    double from[3], to[3], radius;
} table[2][AIRWAYS] = {{{"trachea", {0, -56, 200}, {0, -40, 98}, 8.5},
                        {"bronchus left", {8.5, -39.5, 85.5}, {38, -35, 70}, 5.5},
                        {"bronchus right", {-9, -39.5, 84.5}, {-32, -36, 67}, 6}},
                       {{"trachea", {0, -56, 200}, {0, -40, 102}, 8.5},
                        {"bronchus left", {10, -39, 88}, {21, -37, 77}, 5.5},
                        {"bronchus right", {-10, -39, 87}, {-19, -37, 75}, 6}}};

double skg_airway_distance(int simple, const double point[3]) {
    double least = HUGE_VAL;
    for (int i = 0; i < AIRWAYS; i++) {
        double d[3], p[3];
        skg_add_scaled(table[simple][i].to, -1, table[simple][i].from, d);
        skg_add_scaled(point, -1, table[simple][i].from, p);
        double t = fmin(fmax(skg_dot(p, d) / skg_dot(d, d), 0), 1);
        skg_add_scaled(p, -t, d, p);
        least = fmin(least, skg_length(p) - table[simple][i].radius);
    }
    return least;
}

skg_status skg_thorax_airways(const skg_thorax_plan *plan, int64_t skin, skg_thorax *thorax) {
    const int simple = plan->simple;
    for (int i = 0; i < AIRWAYS; i++) {
        skg_mesh_arrays arrays = {0};
        double line[2][3], r = table[simple][i].radius;
        for (int k = 0; k < 3; k++)
            line[0][k] = table[simple][i].from[k], line[1][k] = table[simple][i].to[k];
        skg_status status = skg_shape_cord(table[simple][i].label, (const double(*)[3])line, 2, r, r, 1,
                                           skg_shape_count(plan->resolution, i == 0 ? 10 : 6, 3),
                                           skg_shape_count(plan->resolution, 12, 6), &arrays);
        if (status == SKG_OK) status = skg_thorax_add(thorax, table[simple][i].label, -1000, skin, &arrays);
        skg_mesh_arrays_free(&arrays);
        SKG_TRY(status);
    }
    return SKG_OK;
}
