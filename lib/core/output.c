#include "core/output.h"

#include <errno.h>
#include <string.h>
#include <unistd.h>

skg_status skg_output_open(const char *path, skg_output_file *file) {
    *file = (skg_output_file){0};
    skg_status status = SKG_OK;
    size_t length = strlen(path) + 32;
    SKG_TRY_CLEANUP(skg_copy_text(path, &file->path));
    SKG_TRY_CLEANUP(skg_alloc((int64_t)length, 1, "file name", &file->temporary));
    snprintf(file->temporary, length, "%s.part-%ld", path, (long)getpid());
    file->stream = fopen(file->temporary, "wbx");
    if (!file->stream) {
        status = skg_fail(SKG_ERR_OUTPUT, "%s: cannot be written: %s", path, strerror(errno));
        skg_free(&file->temporary); /* not ours to remove */
        goto cleanup;
    }
    return SKG_OK;
cleanup:
    skg_output_discard(file);
    return status;
}

skg_status skg_output_commit(skg_output_file *file) {
    int failed = fflush(file->stream) != 0 || ferror(file->stream) || fsync(fileno(file->stream)) != 0;
    int reason = errno;
    if (fclose(file->stream) != 0 && !failed) failed = 1, reason = errno;
    file->stream = NULL;
    if (!failed && rename(file->temporary, file->path) != 0) failed = 1, reason = errno;
    skg_status status = SKG_OK;
    if (failed)
        status = skg_fail(SKG_ERR_OUTPUT, "%s: cannot be written: %s", file->path, strerror(reason));
    else
        skg_free(&file->temporary);
    skg_output_discard(file);
    return status;
}

void skg_output_discard(skg_output_file *file) {
    if (file->stream) fclose(file->stream);
    if (file->temporary) unlink(file->temporary);
    skg_free(&file->temporary);
    skg_free(&file->path);
    *file = (skg_output_file){0};
}
