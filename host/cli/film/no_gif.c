/* A build without giflib. */
#include "common/say.h"
#include "film/writer.h"

static const char *const extensions[] = {".gif", NULL};

static int check(const char *path, double fps) {
    (void)fps;
    return cli_error(
        CLI_OUTPUT,
        "%s: this build of skiagraph has no giflib; build it with libgif-dev, or write a .mp4 or .webm",
        path);
}

static int open_film(film_reel *reel) {
    return check(reel->file.path, reel->format.fps);
}

static int add(film_reel *reel, const unsigned char *pixels) {
    (void)pixels;
    return open_film(reel);
}

static void release(film_reel *reel) {
    (void)reel; /* there is nothing */
}

const film_writer film_gif = {extensions, check, open_film, add, open_film, release};
