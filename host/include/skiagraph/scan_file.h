/** @file
 * Files of projections that survive the end of the program that writes them. A file is laid out whole before the
 * first projection is written. Each projection is written in place and then marked as finished. Whoever opens the
 * file again continues with the projections that are missing.
 *
 * @since 0.1.0 */
#ifndef SKIAGRAPH_SCAN_FILE_H
#define SKIAGRAPH_SCAN_FILE_H

#include <skiagraph/scan.h>

#ifdef __cplusplus
extern "C" {
#endif

/** A file of projections that is being written. */
typedef struct skg_scan_file skg_scan_file;

/** Contents of a file of projections to be written. Prepare with skg_scan_file_options_init: float. */
typedef struct {
    /** Set by skg_scan_file_options_init. */
    int32_t size;
    /** enum skg_type of the projections */
    int32_t type;
    /** Retained; numbers of projections, columns and rows, and the geometry. */
    skg_scan *scan;
    /** 64 hexadecimal digits that identify the scan (skg_scan_hash_get); copied. */
    const char *hash;
    /** Name of the quantity, such as "energy"; copied. NULL: "". */
    const char *name;
    /** Unit of the quantity, such as "keV per pixel"; copied. NULL: "". */
    const char *unit;
    /** Value of a pixel that no part weakens, in the unit of the projections: I0, or the grey value where the free beam is strongest;
     * 0: unknown. */
    double flat_field;
    /** Number of source samples of the plan (skg_plan_report.samples), which a continued scan has to use again. */
    int64_t samples;
    /** 1: a file of another scan at this path is replaced. 0 (default): it is refused. */
    int32_t overwrite;
    /** 1: another process has laid out the file and holds its lock; this one only writes projections. */
    int32_t helper;
    /** Number of flat fields that an HDF5 file has room for; 1 by default. */
    int64_t flats;
    /** Number of dark fields, as above; 1 by default. */
    int64_t darks;
    /** First projection of the file, which then is a part of the scan. */
    int64_t from;
    /** Number of its projections; 0: all from `from` on. */
    int64_t count;
    /** First words of the files of a folder: STEM_0000.tif, STEM_flat_0000.tif and STEM_dark.tif; copied. NULL: projection-00000.tif,
     * flat-00000.tif and dark-00000.tif. */
    const char *stem;
    /** Value of a pixel that no radiation reaches, in the unit of the projections; 0 by default. */
    double dark;
    /** 1: flat fields have other values than flat_field, or pixels differ, so that -ln(I/I0) needs skg_scan_file_fields_write. */
    int32_t flat_varies;
    /** 1: likewise of dark fields and `dark`. */
    int32_t dark_varies;
} skg_scan_file_options;

SKG_INIT(skg_scan_file_options)

/** Checks that a path names a kind of file that can be written: an extension of skg_scan_file_open, or a folder.
 * Errors: SKG_ERR_ARGUMENT (extension), SKG_ERR_UNSUPPORTED (.h5 in a build without HDF5). */
SKG_API skg_status skg_scan_file_path_check(const char *path);

/** Gets the number of source samples with which the file at a path was begun.
 *
 *     hash      of the scan
 *     samples   result: 0 if there is no file of this scan */
SKG_API skg_status skg_scan_file_samples_get(const char *path, const char *hash, int64_t *samples);

/** Lays out a file, or opens one of the same scan that is there.
 *
 *     path     .mha: MetaImage, one slice per projection
 *              .raw: the same values without a header, which stands beside it as .mhd
 *              .tif, .tiff: BigTIFF, one page per projection
 *              .h5, .hdf5: HDF5 in the layout of Data Exchange, in builds with HDF5; .nxs: the same, as NXtomo of NeXus,
 *              too
 *              no extension, or a closing /: a folder with one TIFF file per projection
 *     file     result; the caller releases it
 *     errors   SKG_ERR_OUTPUT: another process writes the file (the sentence names it), a file of another scan is
 *              there, the disk is full
 *
 * While it is written, NAME.lock beside the file names who writes it, and NAME.progress holds which projections are
 * finished, with their checksums (except for HDF5, where /process/done and /process/checksum do, and for folders). Both
 * disappear when the file is finished.
 *
 * One writer: a file has one writer at a time, in this process or in another one; a second one is refused. The lock goes with
 * its process, however that ends, and does not pass to the child of a fork. Parts of the output that a killed writer has left
 * under temporary names (NAME.part-...) are removed. Projections of an unfinished file are read and compared with their
 * checksums; damaged ones count as missing (skg_scan_file_damaged_count). */
SKG_API skg_status skg_scan_file_open(const char *path, const skg_scan_file_options *options,
                                      skg_scan_file **file);

/** Closes a file and gives up its lock. Projections that were written stay. */
SKG_API void skg_scan_file_release(skg_scan_file **file);

/** Number of projections that a file has. */
SKG_API skg_status skg_scan_file_done_count(const skg_scan_file *file, int64_t *count);

/** Whether a file has a projection.
 *
 *     done   result: 1 or 0 */
SKG_API skg_status skg_scan_file_done_get(const skg_scan_file *file, int64_t index, int32_t *done);

/** Reads every projection that a file has and compares it with the CRC-32C that was written with it. Those that do not fit
 * are marked as missing, so that they are computed again. skg_scan_file_open does so with every file that is not finished
 * (helper 0); the flat and dark fields have no checksums.
 *
 *     errors   SKG_ERR_UNSUPPORTED: the file has no checksums, which are in the .h5, or in the NAME.progress of an
 *              unfinished .mha, .raw or .tif; SKG_ERR_FILE; SKG_ERR_OUTPUT */
SKG_API skg_status skg_scan_file_verify(skg_scan_file *file);

/** Number of projections that were found damaged since the file was opened. */
SKG_API skg_status skg_scan_file_damaged_count(const skg_scan_file *file, int64_t *count);

/** Writes the flat and dark fields: into an HDF5 file, as files in a folder, and of a .mha, .raw or .tif as a stack beside it,
 * NAME-flats and NAME-darks with its extension. Fields of a folder or beside a stack that are there are replaced, and removed
 * where the number is 0.
 *
 *     flats    number of flat fields; of HDF5 as in the options of the file
 *     white    [flats][row][column]; NULL if flats is 0
 *     darks    number of dark fields; of HDF5 as in the options of the file
 *     dark     [darks][row][column]; NULL if darks is 0
 *     errors   SKG_ERR_OUTPUT, SKG_ERR_ARGUMENT (number) */
SKG_API skg_status skg_scan_file_fields_write(skg_scan_file *file, int64_t flats, const void *white,
                                              int64_t darks, const void *dark);

/** Gets where the flat or dark fields of an output are: the dataset in an .h5 (/exchange/data_white), the first file in a folder without
 * a stem (flat-00000.tif), or the name of the stack beside a stack (scan-flats.mha).
 *
 *     path     of the output
 *     dark     1: the dark fields; 0: the flat fields
 *     name     result: [size] bytes
 *     errors   SKG_ERR_ARGUMENT (extension, size) */
SKG_API skg_status skg_scan_fields_name_get(const char *path, int32_t dark, char *name, int64_t size);

/** Writes projections, and marks them as finished once the disk has them.
 *
 *     count     number of projections
 *     indices   [count] their numbers in the scan
 *     images    [count][row][column] of the file's type
 *     phases    [count] phase of the breath for the geometry of HDF5; NULL: none
 *     errors    SKG_ERR_OUTPUT; projections that were not marked have to be written again */
SKG_API skg_status skg_scan_file_write(skg_scan_file *file, int64_t count, const int64_t *indices,
                                       const void *images, const double *phases);

/** Reads a projection that is finished, and compares it with its checksum if it has one.
 *
 *     index    its number in the scan
 *     image    result: [row][column] of the file's type
 *     errors   SKG_ERR_ARGUMENT (index, not finished), SKG_ERR_FILE (damaged); SKG_ERR_UNSUPPORTED for folders */
SKG_API skg_status skg_scan_file_read(const skg_scan_file *file, int64_t index, void *image);

/** Copies the projections that a part of the scan has and a file does not.
 *
 *     part     finished or not; of the same type and number of source samples
 *     errors   SKG_ERR_ARGUMENT if the part is of another type or lies outside of the file, SKG_ERR_OUTPUT;
 *              SKG_ERR_UNSUPPORTED for folders */
SKG_API skg_status skg_scan_file_join(skg_scan_file *file, const skg_scan_file *part);

/** Copies projections of another file, and its flat and dark fields if it has as many.
 *
 *     file      has the projections of skg_scan_create_subset
 *     from      of the same type
 *     count     number of projections of `file`
 *     indices   [count] their numbers in `from`, where they are finished
 *     phases    [count] phase of the breath; NULL: none
 *     errors    SKG_ERR_ARGUMENT, SKG_ERR_OUTPUT; SKG_ERR_UNSUPPORTED for folders */
SKG_API skg_status skg_scan_file_copy(skg_scan_file *file, const skg_scan_file *from, int64_t count,
                                      const int64_t *indices, const double *phases);

/** Ends a file that has every projection: what only an unfinished file needs is removed. Does nothing if
 * projections are missing. */
SKG_API skg_status skg_scan_file_finish(skg_scan_file *file);

/** How a finished .h5 is packed. Prepare with skg_scan_pack_options_init: all bits of the values, compression of level 4. */
typedef struct {
    /** Set by skg_scan_pack_options_init. */
    int32_t size;
    /** Level of zlib: 0 (none) to 9 */
    int32_t level;
    /** 1: values become grey values of 16 bits, 60000 where the mean flat field is strongest; larger ones end at 65535. */
    int32_t grey16;
    /** 0 */
    int32_t reserved;
} skg_scan_pack_options;

SKG_INIT(skg_scan_pack_options)

/** Writes a finished .h5 again, in chunks that are compressed: the last pass over a scan. The new file holds all that the old one
 * does, and is read by the same programs; it cannot be continued.
 *
 *     from      an .h5 that has all of its projections
 *     to        appears whole or not at all; a file that is there is replaced
 *     options   NULL: the defaults
 *     errors    SKG_ERR_FILE, SKG_ERR_FORMAT (no scan, projections are missing, grey values of attenuations), SKG_ERR_OUTPUT,
 *               SKG_ERR_ARGUMENT (level; `to` is `from`); SKG_ERR_UNSUPPORTED in builds without HDF5 */
SKG_API skg_status skg_scan_file_pack(const char *from, const char *to, const skg_scan_pack_options *options);

#ifdef __cplusplus
}
#endif
#endif
