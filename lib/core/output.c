/* Files that appear whole or not at all. */
#include "core/files.h"

#include "core/text.h"

#include <errno.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

skg_status skg_output_fail(const char *path, int reason, const char *otherwise) {
    const char *mend = "";
    if (reason == ENOENT || reason == ENOTDIR) mend = "; make its folder first";
    if (reason == EACCES || reason == EPERM || reason == EROFS)
        mend = "; choose a folder that you may write to";
    if (reason == ENOSPC || reason == EDQUOT || reason == EFBIG) mend = "; make room or choose another disk";
    return skg_fail(SKG_ERR_OUTPUT, "%s: cannot be written: %s%s", path,
                    reason ? strerror(reason) : otherwise, mend);
}

skg_status skg_output_part_fail(const char *path, const char *temporary, int reason) {
    if (reason != EEXIST) return skg_output_fail(path, reason, "");
    return skg_fail(SKG_ERR_OUTPUT,
                    "%s: cannot be written: unfinished files of this name are in the way, such as %s; remove "
                    "them",
                    path, temporary);
}

skg_status skg_output_open(const char *path, skg_output_file *file) {
    *file = (skg_output_file){0};
    skg_status status = SKG_OK;
    int descriptor = -1;
    struct stat there;
    /* The rename would replace a device such as /dev/null by a file. */
    if (stat(path, &there) == 0 && !S_ISREG(there.st_mode))
        return skg_output_fail(path, 0,
                               S_ISDIR(there.st_mode) ? "it is a folder; add a file name"
                                                      : "it is a device, not a file; name a file");
    SKG_TRY_CLEANUP(skg_copy_text(path, &file->path));
    SKG_TRY_CLEANUP(skg_alloc((int64_t)strlen(path) + SKG_PART_ENDING, 1, "file name", &file->temporary));
    descriptor = skg_part_open(path, file->temporary);
    if (descriptor < 0) {
        status = skg_output_part_fail(path, file->temporary, errno);
        skg_free(&file->temporary); /* not ours to remove */
        goto cleanup;
    }
    file->stream = fdopen(descriptor, "w+b"); /* read too: libtiff goes back to earlier directories */
    if (file->stream) return SKG_OK;
    status = skg_output_fail(path, errno, "");
    close(descriptor);
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
        status = skg_output_fail(file->path, reason, "not everything was taken");
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
