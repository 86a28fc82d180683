/* Data of the verb register. Functions that return int return an exit status and print the error. */
#ifndef CLI_REGISTER_WORK_H
#define CLI_REGISTER_WORK_H

#include "session/session.h"

#include <skiagraph/registration.h>

#include <jansson.h>

/* A radiograph as its flags name it. */
typedef struct {
    char *path;
    int64_t projection; /* of the Scan; -1: the scene's own view */
    skg_view view;
    int32_t quantity; /* enum skg_quantity */
    double *values, *flat, *mask;
    double flat_field;
} register_image;

/* Result for a body. */
typedef struct {
    const char *label; /* the value of --part */
    skg_registration_result result;
    char verdict[512];
    json_t *directions;
} register_body;

typedef struct {
    const cli_arguments *arguments;
    const char *named_by; /* the flag that names radiographs */
    cli_session session;
    skg_registration_options options;
    int64_t image_count, body_count, part_count;
    register_image *images;
    register_body *bodies;
    double *motions; /* [part_count][16] of each part so far */
    char *moved;     /* [part_count] */
    skg_registration *last;
    int is_stopped;
} register_work;

/* Options from flags. */
int register_read_options(register_work *work);

/* Reads the radiographs, with their views, flat fields and masks. */
int register_read_images(register_work *work);
void register_free_images(int64_t count, register_image *images);

/* The radiograph as the library takes it; nothing is copied. */
void register_radiograph(const register_image *from, skg_radiograph *image);

/* Registers body after body. */
int register_run(register_work *work);

/* Asks for what was found of a body; the caller releases its directions. */
skg_status register_result_get(const skg_registration *registration, register_body *body);

/* "agrees", "structure", "not determined", "failed", "stopped" */
const char *register_status(const register_body *body);

/* The result for a body as JSON; free: enum skg_registration_free. */
json_t *register_body_json(const register_body *body, int32_t free);
json_t *register_json(const register_work *work);
void register_print(const register_work *work);

/* Pictures of a radiograph of the last body: PNG in memory, which the caller frees. */
typedef struct {
    unsigned char *png;
    size_t size;
    double most; /* of a difference: what the full colour means */
} register_png;
enum {
    REGISTER_FIXED,
    REGISTER_MODEL,
    REGISTER_CONTOUR,
    REGISTER_BEFORE,
    REGISTER_AFTER,
    REGISTER_STRUCTURE, /* without a PNG if there is none */
    REGISTER_PICTURES
};
int register_pictures(const register_work *work, int64_t image, register_png pictures[REGISTER_PICTURES]);

/* Writes one page that loads nothing. */
int register_write_page(const register_work *work, const char *path);

#endif
