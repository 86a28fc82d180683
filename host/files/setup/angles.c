/* Sides of a body from which it is imaged, as words of the clinic: "AP", "LAO 30 CRAN 20". */
#include "core/core.h"
#include "core/maths.h"
#include "core/text.h"
#include "setup/sections.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

enum { WORD_MAX = 8 };

/* An angle is positive towards the left side or the head. Where it says where the detector stands, 0 is in front of the body. */
typedef struct {
    double primary_deg, secondary_deg;
    int has_primary, has_secondary;
} angulation;

static skg_status fail(const char *name, const char *why) {
    return skg_fail(
        SKG_ERR_ARGUMENT,
        "\"%s\" %s; give front, side, top, AP, PA, LAT, or angles such as \"LAO 30 CRAN 20\" (LAO or RAO 0 to 180, CRAN or CAUD "
        "0 to 90 degrees)",
        name, why);
}

/* One word and its number; NaN: it has none. */
static skg_status add(const char *name, const char *word, double degrees, angulation *a) {
    const int left = strcasecmp(word, "LAO") == 0, right = strcasecmp(word, "RAO") == 0;
    const int head = strcasecmp(word, "CRAN") == 0 || strcasecmp(word, "CRA") == 0,
              feet = strcasecmp(word, "CAUD") == 0 || strcasecmp(word, "CAU") == 0;
    if (!left && !right && !head && !feet) return fail(name, "is no side");
    if (isnan(degrees)) return fail(name, "has a word without its angle");
    if (left + right ? a->has_primary : a->has_secondary) return fail(name, "has two angles of one kind");
    if (!(degrees >= 0 && degrees <= (left + right ? 180 : 90)))
        return fail(name, "has an angle out of its range");
    if (left + right)
        a->primary_deg = left ? degrees : -degrees, a->has_primary = 1;
    else
        a->secondary_deg = head ? degrees : -degrees, a->has_secondary = 1;
    return SKG_OK;
}

static skg_status parse(const char *name, angulation *a) {
    const char *at = name;
    while (*(at += strspn(at, " ,"))) {
        char word[WORD_MAX], *end = NULL;
        const size_t length = strspn(at, "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz");
        if (length == 0 || length >= sizeof word) return fail(name, "is no side");
        memcpy(word, at, length);
        word[length] = '\0';
        at += length;
        const double degrees = strtod(at, &end);
        SKG_TRY(add(name, word, end == at ? (double)NAN : degrees, a));
        at = end;
    }
    return a->has_primary || a->has_secondary ? SKG_OK : fail(name, "is no side");
}

skg_status skg_side_get(const char *name, double *direction, int32_t *from_detector) {
    /* x to the left, y to the back, z to the head: where the source stands. */
    static const struct {
        const char *name;
        double direction[3];
        int32_t from_detector;
    } sides[] = {{"front", {0, -1, 0}, 0}, {"side", {1, 0, 0}, 0}, {"top", {0, 0, 1}, 0},
                 {"AP", {0, -1, 0}, 0},    {"PA", {0, 1, 0}, 1},   {"LAT", {-1, 0, 0}, 1}};
    angulation a = {0};
    SKG_PLAIN;
    SKG_NEEDS(name);
    SKG_NEEDS(direction);
    SKG_NEEDS(from_detector);
    for (size_t i = 0; i < sizeof sides / sizeof *sides; i++)
        if (strcasecmp(name, sides[i].name) == 0) {
            memcpy(direction, sides[i].direction, sizeof sides[i].direction);
            *from_detector = sides[i].from_detector;
            return SKG_OK;
        }
    SKG_TRY(parse(name, &a));
    const double p = a.primary_deg * (SKG_PI / 180), s = a.secondary_deg * (SKG_PI / 180);
    direction[0] = -sin(p) * cos(s), direction[1] = cos(p) * cos(s), direction[2] = -sin(s);
    *from_detector = fabs(a.primary_deg) <= 90;
    return SKG_OK;
}
