/* A file of projections, and what its formats have in common. Private.
 *
 * A file is found unfinished or finished, never half laid out: the header and the room for all projections are made
 * under a temporary name. In NAME.progress stand 256 bytes of text, a byte for each projection: 1 once the disk has it,
 * and, from the next multiple of 4 on, the checksum of each. HDF5 keeps both inside. */
#ifndef SKG_SCAN_FORMAT_H
#define SKG_SCAN_FORMAT_H

#include "core/core.h"
#include "core/digest.h"

#include <skiagraph/scan_file.h>

typedef struct skg_scan_format skg_scan_format;

struct skg_scan_file {
    const skg_scan_format *format;
    skg_scan_file_options options; /* texts are copies */
    skg_view view;                 /* of the first projection */
    int64_t first;                 /* number of its first projection in the scan */
    int64_t projections;           /* of the file */
    int64_t bytes;                 /* of a projection */
    char *path, *lock_path, *progress_path;
    int lock, data, progress;    /* descriptors; -1: none */
    int direct;                  /* of the data past the page cache; -1: none */
    void *copies_block, *copies; /* for memory that is not aligned; NULL: not needed yet */
    int64_t data_at;             /* place of projection 0; the others follow without gaps */
    int64_t done_at;             /* place of the byte of projection 0 in `progress` */
    int64_t checksum_at;         /* place of the checksum of projection 0 in `progress`; 0: none */
    int64_t phase_at;            /* place of the phases, which are doubles; 0: none */
    int64_t white_at, dark_at;   /* place of flat and dark fields; 0: none */
    char *done;                  /* [projections] */
    int64_t done_count;
    uint32_t *checksums; /* [projections] CRC-32C of those that are done */
    int64_t damaged;     /* projections that did not fit their checksum */
};

/* Identity of the scan of a file. */
typedef struct {
    char hash[SKG_DIGEST_TEXT]; /* "": no scan of ours */
    int64_t samples;
} skg_scan_identity;

/* A kind of file. Functions that are NULL are not needed. */
struct skg_scan_format {
    const char *extensions[4]; /* the last one is NULL */
    /* Writes the file without its projections to `temporary`, and what stands beside it. */
    skg_status (*lay_out)(skg_scan_file *file, const char *temporary);
    /* Finds data_at and data_step of a file that is there, and checks its length. */
    skg_status (*locate)(skg_scan_file *file);
    /* Reads who wrote the file; an empty hash if nobody did. */
    skg_status (*identify)(const char *path, skg_scan_identity *identity);
    /* Instead of writing in place. */
    skg_status (*write)(skg_scan_file *file, int64_t index, const void *image, double phase);
    /* Writes flat and dark fields instead of white_at and dark_at. */
    skg_status (*write_fields)(skg_scan_file *file, int64_t flats, const void *white, int64_t darks,
                               const void *dark);
    /* Finds what is done where there is no NAME.progress. */
    skg_status (*find_done)(skg_scan_file *file);
    /* Removes the file for one that replaces it; NULL: it is one file. */
    skg_status (*remove)(skg_scan_file *file);
    int has_progress_inside; /* 1: the bytes of NAME.progress stand in the file, and locate finds done_at */
    int fields_beside;       /* 1: flat and dark fields are stacks of their own, NAME-flats and NAME-darks */
    int is_missing;          /* 1: this build cannot write it */
};

extern const skg_scan_format skg_scan_format_mha, skg_scan_format_raw, skg_scan_format_tiff,
    skg_scan_format_folder, skg_scan_format_hdf5;

skg_status skg_scan_find_format(const char *path, const skg_scan_format **format);

/* A path without a slash at its end. A symbolic link to an output of the same extension is that output: lock, progress and
 * temporary names are beside its target. */
skg_status skg_scan_copy_path(const char *path, char **copy);

/* path with an ending; the caller frees it. */
skg_status skg_scan_path_with(const char *path, const char *ending, char **result);

/* "ScanHash = ...\nScanSamples = ...\n", and the other way from the first 4 KiB of a file. */
void skg_scan_write_identity(const skg_scan_file *file, char *text, size_t size);
skg_status skg_scan_read_identity(const char *path, skg_scan_identity *identity);

/* The lines of a header that turn values into attenuations: "FlatField = ...\nDark = ...\n", and whether fields vary. */
enum { SKG_SCAN_LEVELS_LENGTH = 160 };
void skg_scan_write_levels(const skg_scan_file *file, char text[SKG_SCAN_LEVELS_LENGTH]);

/* Fails if a file does not have a projection of the scan. */
skg_status skg_scan_file_check_index(const skg_scan_file *file, int64_t index);

/* "flat" or "dark"; and, with these, "scan-flats.mha" for "scan.mha", which the caller frees. */
const char *skg_scan_field_kind(int32_t dark);
skg_status skg_scan_path_beside(const char *path, const char *kind, char **result);

/* Removes a stack of the format of a file if it is one of ours. */
skg_status skg_scan_stack_remove(const skg_scan_file *file, char *path);

/* Removes the fields beside a stack, which are those of another scan. */
skg_status skg_scan_fields_remove(skg_scan_file *file);

/* Reads all bytes at a place. */
skg_status skg_scan_read_at(const skg_scan_file *file, void *to, int64_t count, int64_t at);

/* The checksums of a file that is open: read, written for projection `at` of the file, and compared (1: it fits, or there is
 * none). */
void skg_scan_checksums_read(skg_scan_file *file);
skg_status skg_scan_checksum_write(skg_scan_file *file, int64_t at, const void *image);
int skg_scan_checksum_fits(const skg_scan_file *file, int64_t at, const void *image);

/* Writes all bytes at a place. */
skg_status skg_scan_write_at(const char *path, int descriptor, const void *bytes, int64_t count, int64_t at);

/* Opens `direct` where the file system allows it, and writes projections by it. */
void skg_scan_open_direct(skg_scan_file *file);
skg_status skg_scan_write_large(skg_scan_file *file, const void *bytes, int64_t count, int64_t at);

/* Makes a file of `total` bytes that begins with a header, and sees to it that the disk has room. */
skg_status skg_scan_lay_out(const char *path, const void *header, int64_t count, int64_t total);

/* Sees to it that the disk has room for the whole length of a file, and has what it holds. */
skg_status skg_scan_reserve(const char *path);

/* Fails if a file has another length. */
skg_status skg_scan_check_length(const char *path, int64_t total);

/* Removes the unfinished files of a scan that a killed writer has left; the caller has its lock. */
void skg_scan_remove_stale(const skg_scan_file *file);

/* Takes the lock of `path`, or says who has it. */
skg_status skg_scan_lock(const char *path, int *descriptor);
void skg_scan_unlock(const char *path, int *descriptor);

#endif
