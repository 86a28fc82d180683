/* Pages and films of a scene that moves. */
#include "view/pages.h"

#include "common/progress.h"
#include "common/say.h"
#include "film/film.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/* Between its key frames a page moves every vertex in a straight line. */
static const double KEY_FRAMES_PER_SECOND = 5;
enum { KEY_FRAMES_MAX = 100, FRAMES_MAX = 1000000 };

/* A page stays below 5 MB: its geometry has at most 3 MB, which are 4 MB in base 64, and its images 0.6 MB, which are
 * 0.8 MB. */
enum { TRIANGLES_MAX = 100000, BYTES_MAX = 3000000, PIXELS_MAX = 600000, SIDE_MAX = 512 };

/* A triangle has 3 corners of 2 bytes; for each triangle there is half a vertex, of 6 bytes in the first frame and 3 in each later one. */
int64_t view_max_triangles(int64_t frames) {
    const double most = (double)BYTES_MAX / (7.5 + 1.5 * (double)frames);
    return most < TRIANGLES_MAX ? (int64_t)most : TRIANGLES_MAX;
}

/* How many pixels of the detector become one, in each direction. */
static int64_t block_size(const skg_view *view, int64_t frames) {
    int64_t block = 1;
    for (;; block++) {
        const int64_t columns = (view->columns + block - 1) / block, rows = (view->rows + block - 1) / block;
        if (columns <= SIDE_MAX && rows <= SIDE_MAX && columns * rows * frames <= PIXELS_MAX) return block;
    }
}

/* Adds the detector's image as means of blocks. */
static void take_image(const view_work *w, int64_t block, int64_t columns, int64_t rows, uint8_t *to) {
    const skg_view *view = &w->session.view;
    for (int64_t r = 0; r < rows; r++)
        for (int64_t c = 0; c < columns; c++) {
            int64_t sum = 0, count = 0;
            for (int64_t y = r * block; y < (r + 1) * block && y < view->rows; y++)
                for (int64_t x = c * block; x < (c + 1) * block && x < view->columns; x++, count++)
                    sum += w->image[y * view->columns + x];
            to[r * columns + c] = (uint8_t)((sum + count / 2) / count);
        }
}

static int take_frame(view_work *w, int64_t frame, int64_t block, view_shapes *shapes, view_page *page,
                      uint8_t *image) {
    int exit_status = CLI_DONE;
    if (shapes->frames > 1)
        exit_status = view_pose_at(w, (double)frame * w->seconds / (double)shapes->frames);
    if (exit_status == CLI_DONE && shapes->frames > 1) exit_status = view_make_image(w);
    if (exit_status == CLI_DONE) exit_status = view_shapes_take(w->session.scene, frame, shapes);
    if (exit_status == CLI_DONE && w->look.image)
        take_image(w, block, page->image_columns, page->image_rows,
                   image + frame * page->image_columns * page->image_rows);
    return exit_status;
}

static int64_t key_frames(const view_work *w) {
    if (isnan(w->seconds)) return 1;
    const double frames = fmax(2, ceil(w->seconds * KEY_FRAMES_PER_SECOND));
    return frames < KEY_FRAMES_MAX ? (int64_t)frames : KEY_FRAMES_MAX;
}

/* Says how the page differs from the scene, and where it is larger than its manual says. */
static void tell_size(const view_shapes *shapes, const char *path) {
    const int64_t most = view_max_triangles(shapes->frames);
    if (shapes->triangles < shapes->of)
        cli_note("%s: shows %lld of the scene's %lld triangles", path, (long long)shapes->triangles,
                 (long long)shapes->of);
    if (!view_can_thin && shapes->of > most)
        cli_note(
            "%s: shows all %lld triangles, which makes it large; built with libmeshoptimizer-dev, skiagraph shows %lld",
            path, (long long)shapes->of, (long long)most);
    else if (shapes->triangles > most + most / 10)
        cli_note(
            "%s: is large, because its surfaces have too many holes and pieces to be shown by %lld triangles; leave "
            "parts out, or give coarser meshes",
            path, (long long)most);
}

int view_write_page(view_work *w, const char *path) {
    const int64_t frames = key_frames(w), block = block_size(&w->session.view, frames);
    view_shapes shapes;
    view_page page = {.session = &w->session,
                      .look = &w->look,
                      .places = &w->places,
                      .shapes = &shapes,
                      .seconds = w->seconds,
                      .image_columns = (w->session.view.columns + block - 1) / block,
                      .image_rows = (w->session.view.rows + block - 1) / block,
                      .image_frames = frames,
                      .sensitivity = w->sensitive ? &w->sensitivity : NULL};
    uint8_t *image = malloc((size_t)(frames * page.image_columns * page.image_rows));
    cli_progress_begin("making the page, moments", frames);
    int exit_status = view_shapes_make(w->session.scene, frames, view_max_triangles(frames), &shapes);
    if (exit_status == CLI_DONE && !image)
        exit_status = cli_error(CLI_DEVICE, "out of host memory for the page");
    for (int64_t f = 0; f < frames && exit_status == CLI_DONE; f++) {
        exit_status = take_frame(w, f, block, &shapes, &page, image);
        cli_progress_step(f + 1);
    }
    cli_progress_end();
    page.image = w->look.image ? image : NULL;
    if (exit_status == CLI_DONE) exit_status = view_page_write(&page, path);
    if (exit_status == CLI_DONE) tell_size(&shapes, path);
    view_shapes_free(&shapes);
    free(image);
    return exit_status;
}

static int write_frames(view_work *w, int64_t frames, film *opened) {
    const double *low = w->places.low, *high = w->places.high;
    const double bounds[6] = {low[0], low[1], low[2], high[0], high[1], high[2]};
    int exit_status = CLI_DONE;
    w->look.bounds = bounds; /* of the first moment, so that the eye stands still */
    cli_progress_begin("drawing, frames", frames);
    for (int64_t f = 0; f < frames && exit_status == CLI_DONE; f++) {
        exit_status = view_pose_at(w, (double)f / w->fps);
        if (exit_status == CLI_DONE) exit_status = view_make_image(w);
        if (exit_status == CLI_DONE) exit_status = view_draw(w);
        if (exit_status == CLI_DONE) exit_status = film_add(opened, w->rgba);
        cli_progress_step(f + 1);
    }
    w->look.bounds = NULL;
    cli_progress_begin("finishing the film", 0);
    return exit_status;
}

int view_write_film(view_work *w, const char *path) {
    const double frames = fmax(1, floor(w->seconds * w->fps + 0.5));
    char comment[128];
    film *opened = NULL;
    const film_format format = {
        .columns = w->look.columns, .rows = w->look.rows, .channels = 4, .fps = w->fps, .comment = comment};
    if (frames > FRAMES_MAX)
        return cli_error(CLI_USAGE, "%g frames are too many; %d at most", frames, FRAMES_MAX);
    snprintf(comment, sizeof comment, "skiagraph %s: a view of the scene, %.9g frames per second",
             skg_version(), w->fps);
    int exit_status = film_open(path, &format, &opened);
    if (exit_status == CLI_DONE) exit_status = write_frames(w, (int64_t)frames, opened);
    if (exit_status == CLI_DONE) exit_status = film_finish(&opened);
    film_discard(&opened);
    cli_progress_end();
    return exit_status;
}
