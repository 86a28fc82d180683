/* Chooses the parts that are named in a view. */
#include "view/picture.h"

#include "common/say.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Maximum number of parts that are named. */
enum { NAMED_MAX = 20 };

/* Columns of the small pictures that show which part is seen where. */
enum { SMALL = 480 };

/* Maximum number of parts without a whole pixel that are looked for one by one. */
enum { THIN_MAX = NAMED_MAX };

/* Pixels of a small picture that a dot keeps from the edge of what is seen of its part, if there is room. */
enum { CLEAR = 4 };

/* Channel values of a small picture. Parts are drawn white or black there, and their shades lie on either side. */
enum { DARK = 40, LIT = 60 };

/* An opacity with which a part is in the picture, so that the eye stands where it does, and does not show. */
enum { UNSEEN = 1 };

/* Small pictures of the scene from the same eye. */
typedef struct {
    const cli_session *session;
    skg_look look;
    const uint8_t *own;            /* [parts][4] colours of the large picture */
    uint8_t *colours;              /* [parts][4] */
    uint8_t *rgba, *white, *black; /* pictures that are compared */
    int32_t thin;                  /* parts that were looked for one by one */
    int32_t *seen;                 /* [pixels] the opaque part that is seen there; -1: none */
    int32_t *distance;             /* [pixels] */
    int64_t pixels;
    double scale; /* pixels of the large picture in one of the small one */
} small;

static int draw(const small *s, uint8_t *rgba) {
    const cli_session *session = s->session;
    const skg_status status =
        skg_scene_picture(session->context, session->scene, &session->view, &s->look, rgba);
    return status == SKG_OK ? CLI_DONE : cli_fail(status);
}

static uint8_t brightest(const uint8_t *pixel) {
    const uint8_t two = pixel[0] > pixel[1] ? pixel[0] : pixel[1];
    return two > pixel[2] ? two : pixel[2];
}

static int is_opaque(const small *s, int64_t part) {
    return s->own[4 * part + 3] == 255;
}

/* Draws the opaque parts alone: white if bit `bit` of their number is set, otherwise black. bit: -1: all black, -2: all white. */
static int draw_bit(const small *s, int64_t parts, int bit, uint8_t *rgba) {
    for (int64_t i = 0; i < parts; i++) {
        const int is_white = bit == -2 || (bit >= 0 && (i >> bit & 1));
        memset(s->colours + 4 * i, is_white ? 255 : 0, 3);
        s->colours[4 * i + 3] = is_opaque(s, i) ? 255 : UNSEEN;
    }
    return draw(s, rgba);
}

/* Finds which opaque part is seen in each pixel: what is dark as black and bright as white is one, and the bits of its number
 * follow from a picture each. */
static int find_seen(small *s, int64_t parts) {
    int exit_status = draw_bit(s, parts, -2, s->white);
    if (exit_status == CLI_DONE) exit_status = draw_bit(s, parts, -1, s->black);
    for (int64_t i = 0; i < s->pixels; i++) {
        const int is_part = brightest(s->black + 4 * i) < DARK && brightest(s->white + 4 * i) > LIT;
        s->seen[i] = is_part ? 0 : -1;
    }
    for (int bit = 0; parts >> bit && exit_status == CLI_DONE; bit++) {
        exit_status = draw_bit(s, parts, bit, s->rgba);
        for (int64_t i = 0; i < s->pixels && exit_status == CLI_DONE; i++) {
            const int white = brightest(s->white + 4 * i), own = brightest(s->rgba + 4 * i);
            if (s->seen[i] < 0) continue;
            if (4 * own > 3 * white)
                s->seen[i] |= 1 << bit;
            else if (4 * own > white)
                s->seen[i] = -1; /* an edge between two parts */
        }
    }
    return exit_status;
}

/* Draws the scene without its parts into s->white. */
static int draw_empty(const small *s, int64_t parts) {
    memset(s->colours, 0, 4 * (size_t)parts);
    for (int64_t i = 0; i < parts; i++) s->colours[4 * i + 3] = UNSEEN;
    return draw(s, s->white);
}

/* Marks the pixels that a part covers by 1, others by 0: drawn alone and black, it darkens the empty picture. */
static int find_silhouette(const small *s, int64_t parts, int64_t part, uint8_t *mask) {
    for (int64_t i = 0; i < parts; i++) {
        memset(s->colours + 4 * i, 0, 3);
        s->colours[4 * i + 3] = i == part ? 255 : UNSEEN;
    }
    const int exit_status = draw(s, s->rgba);
    for (int64_t i = 0; i < s->pixels; i++)
        mask[i] = brightest(s->rgba + 4 * i) < DARK && brightest(s->white + 4 * i) > LIT;
    return exit_status;
}

/* City-block distance of each pixel to the nearest one of another value. */
static void find_distances(const small *s, const int32_t *values) {
    const int64_t columns = s->look.columns, rows = s->look.rows;
    for (int pass = 0; pass < 2; pass++)
        for (int64_t n = 0; n < s->pixels; n++) {
            const int64_t i = pass ? s->pixels - 1 - n : n, step = pass ? 1 : -1;
            const int64_t column = i % columns + step, row = i / columns + step;
            const int is_alike = column >= 0 && column < columns && values[i + step] == values[i];
            const int is_alike_too = row >= 0 && row < rows && values[i + step * columns] == values[i];
            const int32_t along = is_alike ? s->distance[i + step] : 0;
            const int32_t across = is_alike_too ? s->distance[i + step * columns] : 0;
            const int32_t least = 1 + (along < across ? along : across);
            s->distance[i] = pass && s->distance[i] < least ? s->distance[i] : least;
        }
}

/* Places the dot of a part where pixels have a value: clear of the edge, as near to the part's centre as that allows. Returns 0
 * if there is no such pixel. */
static int place_dot(const small *s, const int32_t *values, int32_t value, view_part *part) {
    double best = -HUGE_VAL;
    for (int64_t i = 0; i < s->pixels; i++) {
        if (values[i] != value) continue;
        const double at[2] = {((double)(i % s->look.columns) + 0.5) * s->scale - 0.5,
                              ((double)(i / s->look.columns) + 0.5) * s->scale - 0.5};
        const double clear = fmin(s->distance[i], CLEAR) * (double)s->pixels * s->scale;
        const double score = clear - hypot(at[0] - part->at[0], at[1] - part->at[1]);
        if (score > best) best = score, memcpy(part->dot, at, sizeof at);
    }
    return best > -HUGE_VAL;
}

/* The dot of an opaque part that covers no pixel wholly, such as a wire: where it makes the black picture brighter. */
static int place_thin(small *s, view_places *places, int64_t id, int *is_placed) {
    int32_t *values = malloc((size_t)s->pixels * sizeof *values);
    if (!values) return cli_error(CLI_DEVICE, "out of host memory");
    for (int64_t i = 0; i < places->count; i++) {
        memset(s->colours + 4 * i, i == id ? 255 : 0, 3);
        s->colours[4 * i + 3] = is_opaque(s, i) ? 255 : UNSEEN;
    }
    const int exit_status = draw(s, s->rgba);
    for (int64_t i = 0; exit_status == CLI_DONE && i < s->pixels; i++)
        values[i] = brightest(s->rgba + 4 * i) > brightest(s->black + 4 * i) + 16;
    if (exit_status == CLI_DONE) {
        find_distances(s, values);
        *is_placed = place_dot(s, values, 1, places->parts + id);
    }
    free(values);
    s->thin++;
    return exit_status;
}

static int is_within(const small *s, int64_t id, int64_t outer) {
    skg_part part;
    skg_part_init(&part);
    while (skg_scene_part_get(s->session->scene, id, &part) == SKG_OK && part.inside >= 0)
        if ((id = part.inside) == outer) return 1;
    return 0;
}

/* The dot of a translucent part: where nothing opaque is behind or before it, and no translucent part that it holds. */
static int place_translucent(small *s, view_places *places, int64_t id, int *is_placed) {
    uint8_t *mask = malloc((size_t)s->pixels), *inner = malloc((size_t)s->pixels);
    int32_t *values = malloc((size_t)s->pixels * sizeof *values);
    int exit_status = mask && inner && values ? find_silhouette(s, places->count, id, mask)
                                              : cli_error(CLI_DEVICE, "out of host memory");
    for (int64_t i = 0; exit_status == CLI_DONE && i < s->pixels; i++) values[i] = mask[i] && s->seen[i] < 0;
    for (int64_t p = 0; exit_status == CLI_DONE && p < places->count; p++) {
        if (is_opaque(s, p) || s->own[4 * p + 3] == 0 || !is_within(s, p, id)) continue;
        exit_status = find_silhouette(s, places->count, p, inner);
        for (int64_t i = 0; i < s->pixels; i++) values[i] = values[i] && !inner[i];
    }
    if (exit_status == CLI_DONE) {
        find_distances(s, values);
        *is_placed = place_dot(s, values, 1, places->parts + id);
    }
    free(mask);
    free(inner);
    free(values);
    return exit_status;
}

static int by_area(const void *a, const void *b) {
    view_part *const *left = a, *const *right = b;
    return (*left)->area < (*right)->area ? 1 : -((*left)->area > (*right)->area);
}

/* A label without digits and the words left, right, l and r: "rib 5 right" and "rib_l06" are of one kind. */
static void kind_of(const char *label, char *kind, size_t size) {
    size_t used = 0;
    while (*label && used + 1 < size) {
        const size_t word = strcspn(label, " -_.0123456789");
        const int is_side = (word == 1 && strchr("lrLR", *label)) ||
                            (word == 4 && strncmp(label, "left", 4) == 0) ||
                            (word == 5 && strncmp(label, "right", 5) == 0);
        for (size_t i = 0; i < word && !is_side && used + 1 < size; i++) kind[used++] = label[i];
        label += word + (label[word] != '\0');
    }
    kind[used] = '\0';
}

static int is_new_kind(const view_places *places, const view_part *part) {
    char kind[64], other[64];
    kind_of(part->label, kind, sizeof kind);
    for (int64_t k = 0; k < places->named_count; k++) {
        kind_of(places->named[k]->label, other, sizeof other);
        if (kind[0] && strcmp(kind, other) == 0) return 0;
    }
    return 1;
}

/* Names a part if it is seen anywhere. */
static int name(small *s, view_places *places, view_part *part) {
    const int64_t id = part - places->parts;
    int is_placed = 0, exit_status = CLI_DONE;
    if (is_opaque(s, id)) {
        find_distances(s, s->seen);
        is_placed = place_dot(s, s->seen, (int32_t)id, part);
        if (!is_placed && s->thin < THIN_MAX) exit_status = place_thin(s, places, id, &is_placed);
    } else {
        exit_status = place_translucent(s, places, id, &is_placed);
    }
    if (is_placed) places->named[places->named_count++] = part;
    return exit_status;
}

/* All parts that can be seen, if there are few; or else the largest one of each kind. */
static int choose(small *s, view_places *places, view_part **sorted) {
    int exit_status = find_seen(s, places->count);
    if (exit_status == CLI_DONE) exit_status = draw_empty(s, places->count);
    for (int64_t i = 0; i < places->count; i++) sorted[i] = places->parts + i;
    qsort(sorted, (size_t)places->count, sizeof *sorted, by_area);
    for (int64_t i = 0; i < places->count && places->named_count < NAMED_MAX && exit_status == CLI_DONE; i++)
        if (s->own[4 * (sorted[i] - places->parts) + 3] > 0 &&
            (places->count <= NAMED_MAX || is_new_kind(places, sorted[i])))
            exit_status = name(s, places, sorted[i]);
    return exit_status;
}

int view_choose_named(const cli_session *session, const skg_look *look, view_places *places) {
    const size_t count = (size_t)places->count + 1;
    uint8_t *own = malloc(4 * count);
    view_part **sorted = calloc(count, sizeof *sorted);
    small s = {.session = session, .look = *look, .own = own, .colours = malloc(4 * count)};
    s.look.columns = look->columns < SMALL ? look->columns : SMALL;
    s.look.rows = llround((double)look->rows * (double)s.look.columns / (double)look->columns);
    if (s.look.rows < 1) s.look.rows = 1;
    s.scale = (double)look->columns / (double)s.look.columns;
    s.look.colours = s.colours, s.look.image = NULL;
    s.pixels = s.look.columns * s.look.rows;
    s.rgba = malloc(4 * (size_t)s.pixels), s.white = malloc(4 * (size_t)s.pixels);
    s.black = malloc(4 * (size_t)s.pixels);
    s.seen = malloc((size_t)s.pixels * sizeof *s.seen);
    s.distance = malloc((size_t)s.pixels * sizeof *s.distance);
    free(places->named);
    places->named = calloc(NAMED_MAX, sizeof *places->named), places->named_count = 0;
    int exit_status = CLI_DONE;
    if (!own || !sorted || !s.colours || !s.rgba || !s.white || !s.black || !s.seen || !s.distance ||
        !places->named)
        exit_status = cli_error(CLI_DEVICE, "out of host memory for the names of parts");
    const skg_status status = exit_status == CLI_DONE ? skg_look_colours_get(session->scene, own) : SKG_OK;
    if (status != SKG_OK) exit_status = cli_fail(status);
    if (exit_status == CLI_DONE) exit_status = choose(&s, places, sorted);
    free(own);
    free(sorted);
    free(s.colours);
    free(s.rgba);
    free(s.white);
    free(s.black);
    free(s.seen);
    free(s.distance);
    return exit_status;
}
