/* Films: a sequence of frames in one file, .gif by giflib, .mp4 and .webm by the program ffmpeg. */
#include "film/film.h"

#include "common/say.h"
#include "film/writer.h"

#include <stdlib.h>
#include <string.h>

struct film {
    film_reel reel;
    const film_writer *writer;
    char *comment;
};

static const film_writer *find_writer(const char *path) {
    static const film_writer *const writers[] = {&film_gif, &film_encoded};
    for (size_t w = 0; w < sizeof writers / sizeof *writers; w++)
        for (const char *const *extension = writers[w]->extensions; *extension; extension++)
            if (cli_has_extension(path, *extension)) return writers[w];
    return NULL;
}

int film_is(const char *path) {
    return find_writer(path) != NULL;
}

int film_check(const char *path, double fps) {
    const int exit_status = find_writer(path)->check(path, fps);
    return exit_status == CLI_DONE ? cli_file_check(path) : exit_status;
}

int film_open(const char *path, const film_format *format, film **opened) {
    const size_t length = strlen(format->comment) + 1;
    film *new = calloc(1, sizeof *new);
    *opened = NULL;
    if (new) new->comment = malloc(length);
    if (!new || !new->comment) {
        free(new);
        return cli_error(CLI_DEVICE, "out of host memory for %s", path);
    }
    new->writer = find_writer(path);
    new->reel.format = *format;
    new->reel.format.comment = memcpy(new->comment, format->comment, length);
    int exit_status = cli_file_open(path, &new->reel.file);
    if (exit_status == CLI_DONE) exit_status = new->writer->open(&new->reel);
    *opened = new;
    if (exit_status != CLI_DONE) film_discard(opened);
    return exit_status;
}

int film_add(film *open, const unsigned char *pixels) {
    const int exit_status = open->writer->add(&open->reel, pixels);
    if (exit_status == CLI_DONE) open->reel.frames++;
    return exit_status;
}

int film_finish(film **open) {
    film_reel *reel = &(*open)->reel;
    int exit_status = (*open)->writer->finish(reel);
    if (exit_status == CLI_DONE) exit_status = cli_file_commit(&reel->file);
    film_discard(open);
    return exit_status;
}

void film_discard(film **open) {
    if (!*open) return;
    (*open)->writer->release(&(*open)->reel);
    cli_file_discard(&(*open)->reel.file);
    free((*open)->comment);
    free(*open);
    *open = NULL;
}
