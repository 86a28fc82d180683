/* How Assimp opens files: by our opener, also those that a file refers to. */
#include "mesh/assimp_files.h"

#include "core/files.h"

typedef struct {
    struct aiFile functions; /* first: Assimp gives its address back */
    FILE *stream;
    int64_t size;
} open_file;

static FILE *stream_of(struct aiFile *file) {
    return ((open_file *)(void *)file)->stream;
}

static size_t read(struct aiFile *file, char *to, size_t size, size_t count) {
    return fread(to, size, count, stream_of(file));
}

static size_t write(struct aiFile *file, const char *from, size_t size, size_t count) {
    (void)file, (void)from, (void)size, (void)count;
    return 0;
}

static size_t tell(struct aiFile *file) {
    const long at = ftell(stream_of(file));
    return at < 0 ? 0 : (size_t)at;
}

static size_t size_of(struct aiFile *file) {
    return (size_t)((open_file *)(void *)file)->size;
}

static enum aiReturn seek(struct aiFile *file, size_t offset, enum aiOrigin origin) {
    const int from = origin == aiOrigin_SET ? SEEK_SET : origin == aiOrigin_CUR ? SEEK_CUR : SEEK_END;
    return fseek(stream_of(file), (long)offset, from) == 0 ? aiReturn_SUCCESS : aiReturn_FAILURE;
}

static void flush(struct aiFile *file) {
    (void)file;
}

static struct aiFile *open(struct aiFileIO *files, const char *path, const char *mode) {
    static const struct aiFile functions = {.ReadProc = read,
                                            .WriteProc = write,
                                            .TellProc = tell,
                                            .FileSizeProc = size_of,
                                            .SeekProc = seek,
                                            .FlushProc = flush};
    open_file *file = NULL;
    (void)files;
    if (*mode != 'r' || skg_alloc(1, sizeof *file, path, &file) != SKG_OK) return NULL;
    file->functions = functions;
    if (skg_input_open(path, SKG_INPUT_LARGE, &file->stream, &file->size) != SKG_OK) skg_free(&file);
    return file ? &file->functions : NULL;
}

static void close(struct aiFileIO *files, struct aiFile *closed) {
    open_file *file = (open_file *)(void *)closed;
    (void)files;
    if (!file) return;
    fclose(file->stream);
    skg_free(&file);
}

void skg_assimp_files(struct aiFileIO *files) {
    *files = (struct aiFileIO){.OpenProc = open, .CloseProc = close};
}
