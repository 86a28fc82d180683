/* The page in which a scene can be turned. */
#include "view/pages.h"

#include "common/encode.h"
#include "common/file.h"
#include "common/say.h"
#include "core/maths.h"

#include <skiagraph/live.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

extern const char view_page_text[]; /* page/page.html with its scripts, as built in */

/* Binary data of the page besides its JSON: numbers in the order of the processor, which is that of the browsers: the lowest byte first.
 * Every block begins at a multiple of 4. */
typedef struct {
    unsigned char *bytes;
    size_t count, capacity;
} blob;

/* Room for a block; NULL if memory is exhausted. */
static void *add_block(blob *to, size_t size) {
    const size_t begin = (to->count + 3) / 4 * 4, end = begin + size;
    if (end > to->capacity) {
        const size_t capacity = 2 * end;
        unsigned char *more = realloc(to->bytes, capacity);
        if (!more) return NULL;
        to->bytes = more;
        to->capacity = capacity;
    }
    memset(to->bytes + to->count, 0, begin - to->count);
    to->count = end;
    return to->bytes + begin;
}

static size_t place_of(const blob *of, const void *block) {
    return (size_t)((const unsigned char *)block - of->bytes);
}

/* The largest unit of changes of 8 bits, mm. The error is half of it, and up to all of it at the ends of the part's range; parts that jump further
 * than 126 of it have changes of 16 bits. */
static const double UNIT_MAX = 0.1;

/* A part's positions as a page has them: those of the first frame as 16 bits between the least and the largest of all frames, and of each
 * later frame the changes from the one before: 8 bits of a unit of its own along each axis, or 16 bits, whose sums wrap around. */
typedef struct {
    double low[3], step[3]; /* mm; of 16 bits */
    int unit[3];            /* steps */
    int has_jumps;          /* 1: changes of 16 bits */
    uint16_t *first;        /* [vertices][3] */
    int8_t *changes;        /* [frames - 1][vertices][3] */
    uint16_t *jumps;        /* likewise */
} places_packed;

static int packed_at(const view_shape *shape, const places_packed *p, int64_t i) {
    const int k = (int)(i % 3);
    return p->step[k] > 0 ? (int)lround(((double)shape->positions[i] - p->low[k]) / p->step[k]) : 0;
}

static void find_steps(const view_shape *shape, int64_t frames, places_packed *p) {
    const int64_t frame = 3 * shape->surface.vertices;
    double high[3];
    int most[3] = {0};
    for (int k = 0; k < 3; k++) p->low[k] = HUGE_VAL, high[k] = -HUGE_VAL;
    for (int64_t i = 0; i < frames * frame; i++) {
        p->low[i % 3] = fmin(p->low[i % 3], (double)shape->positions[i]);
        high[i % 3] = fmax(high[i % 3], (double)shape->positions[i]);
    }
    for (int k = 0; k < 3; k++) {
        if (frame == 0) p->low[k] = high[k] = 0;
        p->step[k] = (high[k] - p->low[k]) / UINT16_MAX;
    }
    for (int64_t i = frame; i < frames * frame; i++) {
        const int change = abs(packed_at(shape, p, i) - packed_at(shape, p, i - frame));
        most[i % 3] = change > most[i % 3] ? change : most[i % 3];
    }
    /* One less than the largest number: what was rounded off in the frame before comes on top. */
    p->has_jumps = 0;
    for (int k = 0; k < 3; k++) {
        p->unit[k] = most[k] / (INT8_MAX - 1) + 1;
        p->has_jumps |= p->unit[k] > 1 && p->unit[k] * p->step[k] > UNIT_MAX;
    }
}

static void add_jumps(const view_shape *shape, int64_t frames, places_packed *p) {
    const int64_t frame = 3 * shape->surface.vertices;
    for (int64_t i = 0; i < frames * frame; i++) {
        const int now = packed_at(shape, p, i);
        if (i < frame)
            p->first[i] = (uint16_t)now;
        else
            p->jumps[i - frame] = (uint16_t)(now - packed_at(shape, p, i - frame));
    }
}

/* Changes are from what a reader has of the frame before, so that what is rounded off does not add up. */
static void add_changes(const view_shape *shape, int64_t frames, places_packed *p) {
    const int64_t frame = 3 * shape->surface.vertices;
    for (int64_t i = 0; i < frame; i++) {
        const int unit = p->unit[i % 3];
        int now = p->first[i] = (uint16_t)packed_at(shape, p, i);
        for (int64_t f = 1; f < frames; f++) {
            int change = (int)lround((packed_at(shape, p, i + f * frame) - now) / (double)unit);
            if (now + change * unit < 0) change++;
            if (now + change * unit > UINT16_MAX) change--;
            now += change * unit;
            p->changes[i + (f - 1) * frame] = (int8_t)change;
        }
    }
}

static int add_positions(const view_shape *shape, int64_t frames, json_t *object, blob *to) {
    const int64_t frame = 3 * shape->surface.vertices;
    places_packed p;
    find_steps(shape, frames, &p);
    const size_t first = (size_t)frame * sizeof *p.first, changes = (size_t)(frame * (frames - 1));
    unsigned char *block = add_block(to, first + (p.has_jumps ? sizeof *p.jumps : 1) * changes);
    if (!block) return 0;
    p.first = (uint16_t *)(void *)block;
    p.jumps = (uint16_t *)(void *)(block + first);
    p.changes = (int8_t *)(block + first);
    (p.has_jumps ? add_jumps : add_changes)(shape, frames, &p);
    json_object_set_new(object, "jumps", json_boolean(p.has_jumps));
    json_object_set_new(object, "positions", json_integer((json_int_t)place_of(to, block)));
    json_object_set_new(object, "low", cli_json_numbers(p.low, 3));
    json_object_set_new(object, "step", cli_json_numbers(p.step, 3));
    json_object_set_new(object, "unit", json_pack("[i,i,i]", p.unit[0], p.unit[1], p.unit[2]));
    return 1;
}

/* 16 bits for each corner, or 32 if there are more vertices. */
static void *add_corners(const view_surface *surface, int wide, blob *to) {
    const int64_t count = 3 * surface->triangles;
    if (wide) {
        uint32_t *block = add_block(to, (size_t)count * sizeof *block);
        for (int64_t i = 0; block && i < count; i++) block[i] = (uint32_t)surface->corners[i];
        return block;
    }
    uint16_t *block = add_block(to, (size_t)count * sizeof *block);
    for (int64_t i = 0; block && i < count; i++) block[i] = (uint16_t)surface->corners[i];
    return block;
}

static int fail_memory(void) {
    return cli_error(CLI_DEVICE, "out of host memory for the page");
}

static json_t *colour_json(const uint8_t *colour) {
    json_t *array = json_array();
    for (int k = 0; k < 4; k++) json_array_append_new(array, json_integer(colour[k]));
    return array;
}

static int part_json(const view_page *page, int64_t id, const uint8_t *colour, blob *to, json_t **made) {
    const view_shape *shape = page->shapes->shapes + id;
    const int64_t frames = shape->moves ? page->shapes->frames : 1;
    const int wide = shape->surface.vertices > UINT16_MAX + 1;
    skg_part part;
    double density = 0;
    const char *material = NULL;
    json_t *object = *made = json_object();
    skg_part_init(&part);
    const skg_status status = skg_scene_part_get(page->session->scene, id, &part);
    if (status != SKG_OK) return cli_fail(status);
    if (!add_positions(shape, frames, object, to)) return fail_memory();
    const void *corners = add_corners(&shape->surface, wide, to);
    if (!corners) return fail_memory();
    json_object_set_new(object, "corners", json_integer((json_int_t)place_of(to, corners)));
    if (skg_material_name_get(part.material, &material) == SKG_OK && material)
        json_object_set_new(object, "material", cli_json_text(material));
    skg_material_density_get(part.material, &density);
    json_object_set_new(object, "label", cli_json_text(part.label));
    json_object_set_new(object, "density", cli_json_number(density));
    json_object_set_new(object, "inside", json_integer(part.inside));
    json_object_set_new(object, "colour", colour_json(colour));
    json_object_set_new(object, "shown", json_integer(shape->surface.triangles));
    json_object_set_new(object, "of", json_integer(shape->surface.of));
    json_object_set_new(object, "vertices", json_integer(shape->surface.vertices));
    json_object_set_new(object, "frames", json_integer(frames));
    json_object_set_new(object, "wide", json_boolean(wide));
    return CLI_DONE;
}

static int parts_json(const view_page *page, blob *to, json_t **made) {
    uint8_t *colours = malloc((size_t)page->shapes->count * 4 + 1);
    *made = json_array();
    if (!colours) return fail_memory();
    const skg_status status = skg_look_colours_get(page->session->scene, colours);
    int exit_status = status == SKG_OK ? CLI_DONE : cli_fail(status);
    for (int64_t i = 0; i < page->shapes->count && exit_status == CLI_DONE; i++) {
        json_t *part = NULL;
        exit_status = part_json(page, i, colours + 4 * i, to, &part);
        json_array_append_new(*made, part);
    }
    free(colours);
    return exit_status;
}

/* Source, beam and detector, of a source at infinity in front of the parts. NULL with an error printed. */
static json_t *view_json(const view_page *page) {
    const uint8_t *text = NULL;
    skg_live_letter *letter = NULL;
    double box[6];
    memcpy(box, page->places->low, 3 * sizeof *box);
    memcpy(box + 3, page->places->high, 3 * sizeof *box);
    skg_status status = skg_live_view_write(&page->session->view, page->look->collimation, box, &letter);
    if (status == SKG_OK) status = skg_live_letter_get(letter, NULL, &text, NULL);
    json_t *object = status == SKG_OK ? json_loads((const char *)text, 0, NULL) : (cli_fail(status), NULL);
    skg_live_letter_release(&letter);
    return object;
}

static json_t *distances_json(const view_page *page) {
    const skg_view *view = &page->session->view;
    json_t *object = json_object();
    json_object_set_new(object, "source_detector", cli_json_number(page->places->source_detector));
    json_object_set_new(object, "source_object", cli_json_number(page->places->source_object));
    json_object_set_new(object, "magnification", cli_json_number(page->places->magnification));
    json_object_set_new(object, "width",
                        cli_json_number((double)view->columns * skg_length(view->column_step)));
    json_object_set_new(object, "height", cli_json_number((double)view->rows * skg_length(view->row_step)));
    return object;
}

static int image_json(const view_page *page, blob *to, json_t **made) {
    const int64_t count = page->image_columns * page->image_rows * page->image_frames;
    *made = json_null();
    if (!page->image) return CLI_DONE;
    unsigned char *block = add_block(to, (size_t)count);
    if (!block) return fail_memory();
    memcpy(block, page->image, (size_t)count);
    *made = json_object();
    json_object_set_new(*made, "at", json_integer((json_int_t)place_of(to, block)));
    json_object_set_new(*made, "columns", json_integer(page->image_columns));
    json_object_set_new(*made, "rows", json_integer(page->image_rows));
    json_object_set_new(*made, "frames", json_integer(page->image_frames));
    return CLI_DONE;
}

static json_t *motion_json(const view_page *page) {
    json_t *object = json_object();
    if (page->shapes->frames < 2) {
        json_decref(object);
        return json_null();
    }
    json_object_set_new(object, "frames", json_integer(page->shapes->frames));
    json_object_set_new(object, "seconds", cli_json_number(page->seconds));
    return object;
}

static int scene_json(const view_page *page, blob *to, json_t *object) {
    const skg_look *look = page->look;
    const char *name = strrchr(page->session->path, '/');
    json_t *box = json_array(), *triangles = json_object(), *view = NULL, *parts = NULL, *image = NULL;
    const int has_from = look->from[0] != 0 || look->from[1] != 0 || look->from[2] != 0;
    int exit_status = parts_json(page, to, &parts);
    json_object_set_new(object, "parts", parts);
    if (exit_status == CLI_DONE) exit_status = image_json(page, to, &image);
    if (exit_status == CLI_DONE && !(view = view_json(page))) exit_status = CLI_DEVICE;
    json_object_set_new(object, "image", image ? image : json_null());
    json_object_set_new(object, "name", cli_json_text(name ? name + 1 : page->session->path));
    json_object_set_new(object, "view", view ? view : json_null());
    json_object_set_new(object, "distances", distances_json(page));
    json_object_set_new(object, "motion", motion_json(page));
    if (page->sensitivity)
        json_object_set_new(object, "sensitivity", cli_sensitivity_json(page->session, page->sensitivity));
    json_array_append_new(box, cli_json_numbers(page->places->low, 3));
    json_array_append_new(box, cli_json_numbers(page->places->high, 3));
    json_object_set_new(object, "box", box);
    json_object_set_new(object, "path",
                        look->path ? cli_json_numbers(look->path, (int)(3 * look->path_count))
                                   : json_array());
    json_object_set_new(object, "from", has_from ? cli_json_numbers(look->from, 3) : json_null());
    json_object_set_new(object, "up", cli_json_numbers(look->up, 3));
    json_object_set_new(object, "parallel", json_boolean(look->orthographic));
    json_object_set_new(triangles, "shown", json_integer(page->shapes->triangles));
    json_object_set_new(triangles, "of", json_integer(page->shapes->of));
    json_object_set_new(object, "triangles", triangles);
    return exit_status;
}

/* Writes the page with the scene and the bytes instead of their marks. */
static int write_page(const char *scene, const char *bytes, const char *path) {
    static const char scene_mark[] = "\"SCENE\"", bytes_mark[] = "BYTES";
    const char *first = strstr(view_page_text, scene_mark);
    const char *second = first ? strstr(first, bytes_mark) : NULL;
    cli_file file;
    if (!second) return cli_error(CLI_OUTPUT, "%s: the built-in page has no place for the scene", path);
    const int exit_status = cli_file_open(path, &file);
    if (exit_status != CLI_DONE) return exit_status;
    const char *const after_first = first + sizeof scene_mark - 1, *const after_second =
                                                                       second + sizeof bytes_mark - 1;
    cli_file_write(&file, view_page_text, (size_t)(first - view_page_text));
    cli_file_write(&file, scene, strlen(scene));
    cli_file_write(&file, after_first, (size_t)(second - after_first));
    cli_file_write(&file, bytes, strlen(bytes));
    cli_file_write(&file, after_second, strlen(after_second));
    return cli_file_commit(&file);
}

int view_page_texts(const view_page *page, char **scene, char **bytes) {
    blob data = {0};
    json_t *object = json_object();
    int exit_status = scene_json(page, &data, object);
    *scene = exit_status == CLI_DONE ? cli_json_for_page(object) : NULL;
    *bytes = exit_status == CLI_DONE ? cli_base64("", data.bytes, data.count) : NULL;
    if (exit_status == CLI_DONE && (!*scene || !*bytes)) exit_status = fail_memory();
    json_decref(object);
    free(data.bytes);
    return exit_status;
}

int view_page_write(const view_page *page, const char *path) {
    char *scene, *bytes;
    int exit_status = view_page_texts(page, &scene, &bytes);
    if (exit_status == CLI_DONE) exit_status = write_page(scene, bytes, path);
    free(scene);
    free(bytes);
    return exit_status;
}
