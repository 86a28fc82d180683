/* Frames of a breath as a film. */
#include "breathe/outputs.h"

#include "common/progress.h"
#include "common/say.h"
#include "film/film.h"

#include <stdio.h>
#include <stdlib.h>

/* A frame goes to the film while the device computes the next one. */
static int write_frames(fluoroscopy *f, const sequence *s, film *film_of_f, unsigned char *greys) {
    skg_job *job = NULL;
    int exit_status = CLI_DONE;
    for (int64_t i = 0; i <= s->frames && exit_status == CLI_DONE; i++) {
        if (i < s->frames) exit_status = sequence_pose(f, s, i);
        if (i < s->frames && exit_status == CLI_DONE)
            exit_status = fluoroscopy_start_image(f, (int)(i % 2), &job);
        if (i < s->frames && exit_status == CLI_DONE && s->meshes)
            exit_status = meshes_write(f, s->meshes, i);
        if (i > 0 && exit_status == CLI_DONE) {
            fluoroscopy_greys(f, (int)((i - 1) % 2), greys);
            exit_status = film_add(film_of_f, greys);
            cli_progress_step(i);
        }
        if (!job) continue;
        const int waited = fluoroscopy_wait_image(f, &job);
        if (exit_status == CLI_DONE) exit_status = waited;
        if (exit_status == CLI_DONE) fluoroscopy_hold(f, (int)(i % 2));
    }
    return exit_status;
}

int write_film(fluoroscopy *f, const sequence *s) {
    char comment[256];
    film *opened = NULL;
    const film_format format = {.columns = f->session.view.columns,
                                .rows = f->session.view.rows,
                                .channels = 1,
                                .fps = s->fps,
                                .comment = comment};
    unsigned char *greys = malloc((size_t)f->pixels);
    if (!greys) return cli_error(CLI_DEVICE, "out of host memory for %s", s->place);
    snprintf(comment, sizeof comment,
             "skiagraph %s: -ln(I/I0) from %.9g (black) to %.9g (white), %.9g frames per second",
             skg_version(), f->low, f->high, s->fps);
    int exit_status = film_open(s->place, &format, &opened);
    if (exit_status == CLI_DONE) {
        cli_progress_begin("writing, frames", s->frames);
        exit_status = write_frames(f, s, opened, greys);
        cli_progress_begin("finishing the film", 0);
    }
    if (exit_status == CLI_DONE) exit_status = film_finish(&opened);
    film_discard(&opened);
    cli_progress_end();
    free(greys);
    return exit_status;
}
