/* The text of a program: files that are built in, or of a folder for development, and options. */
#include "core/files.h"
#include "device/programs.h"

#include <stdio.h>
#include <string.h>
#include <unistd.h>

static const skg_kernel_source *find_built_in(const char *name) {
    for (int i = 0; i < skg_kernel_source_count; i++)
        if (strcmp(skg_kernel_sources[i].name, name) == 0) return &skg_kernel_sources[i];
    return NULL;
}

/* A file of the folder for kernels: in the folder of its stage, as in kernels/, or else there. */
static skg_status read_file(const char *dir, const char *name, char **text) {
    const skg_kernel_source *source = find_built_in(name);
    char path[2048];
    if (snprintf(path, sizeof path, "%s/%s/%s", dir, source ? source->folder : ".", name) >= (int)sizeof path)
        return skg_fail(SKG_ERR_FILE, "%s/%s: the path is too long", dir, name);
    if (access(path, R_OK) != 0) snprintf(path, sizeof path, "%s/%s", dir, name);
    FILE *file = NULL;
    size_t length = 0;
    skg_status status = skg_input_open(path, SKG_INPUT_TEXT, &file, NULL);
    if (status != SKG_OK)
        return skg_fail(status, "%s (kernels are read from here on demand)", skg_last_error());
    status = skg_input_read(file, path, SKG_INPUT_TEXT, text, &length);
    fclose(file);
    return status;
}

static skg_status find_file(const skg_device *device, int32_t file, skg_program_text *text) {
    const char *name = text->names[file];
    if (!device->kernel_dir) {
        const skg_kernel_source *source = find_built_in(name);
        if (!source) return skg_fail(SKG_ERR_INTERNAL, "no kernel file %s is built in", name);
        text->texts[file] = source->text;
        memcpy(text->digests[file], source->digest, SKG_DIGEST_TEXT);
        return SKG_OK;
    }
    SKG_TRY(read_file(device->kernel_dir, name, &text->read[file]));
    const skg_digest digest = skg_digest_of(text->read[file], strlen(text->read[file]));
    text->texts[file] = text->read[file];
    skg_digest_text(&digest, text->digests[file]);
    return SKG_OK;
}

skg_status skg_program_text_find(const skg_device *device, int32_t files, const char *const *names,
                                 const char *options, const char *what, skg_program_text *text) {
    text->files = 0;
    if (files > SKG_PROGRAM_FILES) return skg_fail(SKG_ERR_INTERNAL, "%s: too many kernel files", what);
    text->files = files;
    text->names = names;
    memset(text->read, 0, sizeof text->read);
    for (int32_t i = 0; i < files; i++) SKG_TRY(find_file(device, i, text));
    /* With correctly rounded division, images are equal bit for bit on different devices. */
    if (snprintf(text->options, sizeof text->options, "-cl-std=CL1.2%s%s %s",
                 device->info.correct_division ? " -cl-fp32-correctly-rounded-divide-sqrt" : "",
                 device->clang ? "" : " -D SKG_NO_BUILTINS", options) >= (int)sizeof text->options)
        return skg_fail(SKG_ERR_INTERNAL, "%s: the options are too long", what);
    return SKG_OK;
}

void skg_program_text_release(skg_program_text *text) {
    for (int32_t i = 0; i < text->files; i++) skg_free(&text->read[i]);
}

skg_status skg_program_text_create(const skg_device *device, const skg_program_text *text,
                                   cl_program *program) {
    enum {
        STRINGS = 3
    }; /* of a file: a #line directive, which makes build logs name it; its text; a new line */
    char lines[SKG_PROGRAM_FILES][128];
    const char *strings[STRINGS * SKG_PROGRAM_FILES];
    cl_int code = CL_SUCCESS;
    for (int32_t i = 0; i < text->files; i++) {
        snprintf(lines[i], sizeof lines[i], "#line 1 \"%s\"\n", text->names[i]);
        strings[STRINGS * i] = lines[i];
        strings[STRINGS * i + 1] = text->texts[i];
        strings[STRINGS * i + 2] = "\n";
    }
    *program = clCreateProgramWithSource(device->cl, (cl_uint)(STRINGS * text->files), strings, NULL, &code);
    if (code == CL_SUCCESS) return SKG_OK;
    *program = NULL;
    return skg_cl_fail(code, "clCreateProgramWithSource", __FILE__, __LINE__);
}
