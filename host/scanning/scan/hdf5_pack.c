/* The last pass over a finished scan: the same file again, compressed in chunks. */
#include "core/files.h"
#include "core/text.h"
#include "scan/hdf5_files.h"

#include <skiagraph/scan_file.h>

#include <errno.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/* Grey value of the strongest free beam, as that of a skg_readout. */
static const double full_grey = 60000;

enum { CHUNK_BYTES = 1 << 20 }; /* HDF5's own cache of chunks has this size */

typedef struct {
    const char *from, *to;
    skg_scan_pack_options options;
    hid_t source, result;
    double grey; /* grey values for each unit; 0: values stay as they are */
    void *image; /* of the larger of both types */
} packing;

void skg_scan_pack_options_init_sized(void *options, int32_t size) {
    const skg_scan_pack_options defaults = {.level = 4};
    skg_struct_init(options, size, &defaults, sizeof defaults);
}

static skg_status refuse(const packing *p, const char *what) {
    return skg_fail(SKG_ERR_FORMAT, "%s: %s", p->from, what);
}

/* Fails because HDF5 could not write. */
static skg_status fail(const packing *p) {
    return skg_output_fail(p->to, errno == ENOSPC ? ENOSPC : 0, "HDF5 could not write it");
}

static int size_of(hid_t set, hsize_t size[3]) {
    const hid_t space = H5Dget_space(set);
    const int done =
        H5Sget_simple_extent_ndims(space) == 3 && H5Sget_simple_extent_dims(space, size, NULL) == 3;
    H5Sclose(space);
    return done;
}

/* Image k of a dataset from or to memory of a type. */
static int transfer(hid_t set, hsize_t k, const hsize_t *size, hid_t type, void *image, int is_write) {
    const hsize_t start[3] = {k, 0, 0}, count[3] = {1, size[1], size[2]};
    const hid_t file = H5Dget_space(set), memory = H5Screate_simple(3, count, NULL);
    int done = H5Sselect_hyperslab(file, H5S_SELECT_SET, start, NULL, count, NULL) >= 0;
    if (done)
        done = (is_write ? H5Dwrite(set, type, memory, file, H5P_DEFAULT, image)
                         : H5Dread(set, type, memory, file, H5P_DEFAULT, image)) >= 0;
    H5Sclose(memory);
    H5Sclose(file);
    return done;
}

/* Rows of one projection in each chunk, shuffled and deflated. */
static hid_t make_set(const packing *p, const char *name, hid_t type, const hsize_t *size) {
    const hsize_t row = size[2] * H5Tget_size(type), rows = CHUNK_BYTES / row;
    const hsize_t chunk[3] = {1, rows < 1 ? 1 : rows < size[1] ? rows : size[1], size[2]};
    const hid_t space = H5Screate_simple(3, size, NULL), how = H5Pcreate(H5P_DATASET_CREATE);
    int done = H5Pset_chunk(how, 3, chunk) >= 0 && H5Pset_obj_track_times(how, 0) >= 0;
    if (done && p->options.level > 0)
        done = H5Pset_shuffle(how) >= 0 && H5Pset_deflate(how, (unsigned)p->options.level) >= 0;
    const hid_t set = done ? H5Dcreate2(p->result, name, type, space, H5P_DEFAULT, how, H5P_DEFAULT) : -1;
    H5Pclose(how);
    H5Sclose(space);
    return set;
}

/* Doubles in the memory of an image become grey values there. */
static void make_grey(const packing *p, hsize_t count) {
    const double *values = p->image;
    uint16_t *grey = p->image;
    for (hsize_t i = 0; i < count; i++) {
        const double value = floor(values[i] * p->grey + 0.5);
        grey[i] = (uint16_t)fmin(fmax(value, 0), UINT16_MAX);
    }
}

static int copy_units(const packing *p, hid_t from, hid_t to) {
    char units[64] = "";
    const hid_t type = H5Tcopy(H5T_C_S1), space = H5Screate(H5S_SCALAR);
    const hid_t old = H5Aopen(from, "units", H5P_DEFAULT);
    H5Tset_size(type, sizeof units);
    int done = 1;
    if (old >= 0 && !(p->grey > 0) && H5Aread(old, type, units) >= 0) {
        const hid_t new = H5Acreate2(to, "units", type, space, H5P_DEFAULT, H5P_DEFAULT);
        done = new >= 0 && H5Awrite(new, type, units) >= 0;
        if (new >= 0) H5Aclose(new);
    }
    if (old >= 0) H5Aclose(old);
    H5Sclose(space);
    H5Tclose(type);
    return done;
}

static skg_status copy_images(packing *p, const char *name, hid_t from, hid_t to, const hsize_t *size) {
    const hid_t type = H5Dget_type(to);
    const int is_grey = p->grey > 0;
    skg_status status = SKG_OK;
    for (hsize_t k = 0; k < size[0] && status == SKG_OK; k++) {
        if (!transfer(from, k, size, is_grey ? H5T_NATIVE_DOUBLE : type, p->image, 0))
            status = skg_fail(SKG_ERR_FILE, "%s: image %" PRIu64 " of %s cannot be read", p->from,
                              (uint64_t)k, name);
        if (status == SKG_OK && is_grey) make_grey(p, size[1] * size[2]);
        if (status == SKG_OK && !transfer(to, k, size, type, p->image, 1)) status = fail(p);
    }
    H5Tclose(type);
    return status;
}

/* Projections, flat or dark fields; the latter two need not be there. */
static skg_status pack_set(packing *p, const char *name, int is_needed) {
    hsize_t size[3];
    skg_status status = SKG_OK;
    const hid_t from = H5Dopen2(p->source, name, H5P_DEFAULT);
    if (from < 0) return is_needed ? refuse(p, "it has no dataset /exchange/data") : SKG_OK;
    const hid_t old = H5Dget_type(from);
    hid_t to = -1;
    if (!size_of(from, size)) status = refuse(p, "its images do not have three dimensions");
    if (status == SKG_OK) {
        to = make_set(p, name, p->grey > 0 ? H5T_NATIVE_UINT16 : old, size);
        if (to < 0 || !copy_units(p, from, to)) status = fail(p);
    }
    if (status == SKG_OK) status = copy_images(p, name, from, to, size);
    if (to >= 0) H5Dclose(to);
    H5Tclose(old);
    H5Dclose(from);
    return status;
}

/* The mean flat field, where it is strongest. */
static skg_status find_grey(packing *p) {
    hsize_t size[3];
    double *sum = NULL, top = 0;
    skg_status status = SKG_OK;
    const hid_t white = H5Dopen2(p->source, "exchange/data_white", H5P_DEFAULT);
    if (white < 0 || !size_of(white, size)) {
        if (white >= 0) H5Dclose(white);
        return refuse(p, "it has no flat field, from which grey values are scaled");
    }
    const hsize_t pixels = size[1] * size[2];
    SKG_TRY_CLEANUP(skg_alloc((int64_t)pixels, sizeof *sum, "flat field", &sum));
    for (hsize_t f = 0; f < size[0]; f++) {
        if (!transfer(white, f, size, H5T_NATIVE_DOUBLE, p->image, 0)) {
            status = refuse(p, "a flat field cannot be read");
            goto cleanup;
        }
        for (hsize_t i = 0; i < pixels; i++) sum[i] += ((double *)p->image)[i];
    }
    for (hsize_t i = 0; i < pixels; i++) top = fmax(top, sum[i] / (double)size[0]);
    p->grey = top > 0 ? full_grey / top : 0;
    if (!(top > 0)) status = refuse(p, "its flat field is 0");
cleanup:
    skg_free(&sum);
    H5Dclose(white);
    return status;
}

static int write_attribute(hid_t object, const char *name, hid_t type, const void *value) {
    const hid_t space = H5Screate(H5S_SCALAR);
    const hid_t attribute = H5Acreate2(object, name, type, space, H5P_DEFAULT, H5P_DEFAULT);
    const int done = attribute >= 0 && H5Awrite(attribute, type, value) >= 0;
    if (attribute >= 0) H5Aclose(attribute);
    H5Sclose(space);
    return done;
}

static int write_words(hid_t object, const char *name, const char *words) {
    const hid_t type = H5Tcopy(H5T_C_S1);
    H5Tset_size(type, strlen(words) + 1);
    const int done = write_attribute(object, name, type, words);
    H5Tclose(type);
    return done;
}

static void read_old(const packing *p, char *quantity, size_t length, double *flat) {
    const hid_t type = H5Tcopy(H5T_C_S1);
    H5Tset_size(type, length);
    const hid_t words = H5Aopen_by_name(p->source, "exchange", "quantity", H5P_DEFAULT, H5P_DEFAULT);
    const hid_t number = H5Aopen_by_name(p->source, "exchange", "flat_field", H5P_DEFAULT, H5P_DEFAULT);
    if (words >= 0) H5Aread(words, type, quantity), H5Aclose(words);
    if (number >= 0) H5Aread(number, H5T_NATIVE_DOUBLE, flat), H5Aclose(number);
    H5Tclose(type);
}

/* A projection that is missing. */
static skg_status check_finished(packing *p, int64_t projections) {
    const hid_t done = H5Dopen2(p->source, "process/done", H5P_DEFAULT);
    char *bytes = NULL;
    int is_read = 0;
    skg_status status = SKG_OK;
    if (done < 0) return refuse(p, "it is no scan of skiagraph: /process/done is missing");
    SKG_TRY_CLEANUP(skg_alloc(projections, 1, "progress", &bytes));
    is_read = H5Dread(done, H5T_NATIVE_CHAR, H5S_ALL, H5S_ALL, H5P_DEFAULT, bytes) >= 0;
    if (!is_read || memchr(bytes, 0, (size_t)projections))
        status = refuse(p, "projections are missing; finish the scan first");
cleanup:
    skg_free(&bytes);
    H5Dclose(done);
    return status;
}

/* Checks the scan, and makes memory for an image. */
static skg_status look(packing *p, char *quantity, size_t length, double *flat) {
    hsize_t size[3] = {0};
    const hid_t data = H5Dopen2(p->source, "exchange/data", H5P_DEFAULT);
    const int done = data >= 0 && size_of(data, size);
    if (data >= 0) H5Dclose(data);
    if (!done) return refuse(p, "it has no dataset /exchange/data");
    SKG_TRY(check_finished(p, (int64_t)size[0]));
    SKG_TRY(skg_alloc((int64_t)(size[1] * size[2]), sizeof(double), "projection", &p->image));
    read_old(p, quantity, length, flat);
    if (!p->options.grey16) return SKG_OK;
    if (strncmp(quantity, "attenuation", 11) == 0)
        return refuse(
            p, "attenuations are no grey values; scan energies, or another quantity with a flat field");
    return find_grey(p);
}

static skg_status pack(packing *p) {
    char quantity[64] = "";
    double flat = 0;
    SKG_TRY(look(p, quantity, sizeof quantity, &flat));
    const hid_t group = H5Gcreate2(p->result, "exchange", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    if (group < 0) return fail(p);
    if (p->grey > 0) flat = full_grey;
    const hid_t exchange = H5Gopen2(p->source, "exchange", H5P_DEFAULT);
    const int done = write_words(p->result, "implements", "exchange") &&
                     write_words(group, "quantity", p->grey > 0 ? "grey value" : quantity) &&
                     write_attribute(group, "flat_field", H5T_NATIVE_DOUBLE, &flat);
    errno = 0;
    const int copied = exchange >= 0 && skg_hdf5_copy_set(exchange, group, "theta") &&
                       skg_hdf5_copy_groups(p->source, p->result);
    if (exchange >= 0) H5Gclose(exchange);
    H5Gclose(group);
    if (!copied && errno != ENOSPC)
        return refuse(p, "it is damaged: angles, geometry or progress cannot be copied");
    if (!done || !copied) return fail(p);
    if (p->grey > 0)
        H5Ldelete(p->result, "process/checksum", H5P_DEFAULT); /* it is that of the other values */
    SKG_TRY(pack_set(p, "exchange/data", 1));
    SKG_TRY(pack_set(p, "exchange/data_white", 0));
    return pack_set(p, "exchange/data_dark", 0);
}

/* Memory that HDF5 may hold at the end of a file, bytes: an index of pieces of images, of which there are 64 bytes for each. */
static int64_t held_of(hid_t result) {
    const hid_t set = H5Dopen2(result, "exchange/data", H5P_DEFAULT);
    hsize_t size[3] = {0};
    if (set >= 0) {
        (void)size_of(set, size);
        H5Dclose(set);
    }
    const hsize_t row = size[2] * sizeof(double), pieces = size[0] * (1 + size[1] * row / CHUNK_BYTES);
    return (1 << 20) + 64 * (int64_t)pieces;
}

/* From the source that is open to a file under a temporary name. */
static skg_status pack_to(packing *p, const char *temporary) {
    const hid_t access = H5Pcreate(H5P_FILE_ACCESS);
    H5Pset_libver_bounds(access, H5F_LIBVER_EARLIEST, H5F_LIBVER_LATEST);
    p->result = H5Fcreate(temporary, H5F_ACC_TRUNC, H5P_DEFAULT, access);
    H5Pclose(access);
    if (p->result < 0) return skg_output_fail(p->to, errno, "HDF5 could not make it");
    skg_status status = pack(p);
    if (!skg_hdf5_close(p->result, status == SKG_OK, held_of(p->result)) && status == SKG_OK)
        status = skg_output_fail(p->to, errno, "HDF5 could not finish it");
    return status;
}

static skg_status check(const packing *p) {
    struct stat from, to;
    const int32_t level = p->options.level;
    if (level < 0 || level > 9)
        return skg_fail(SKG_ERR_ARGUMENT, "compression of level %" PRId32 "; give 0 to 9", level);
    if (stat(p->from, &from) == 0 && stat(p->to, &to) == 0 && from.st_ino == to.st_ino &&
        from.st_dev == to.st_dev)
        return skg_fail(SKG_ERR_ARGUMENT, "%s: is the scan itself; name another file", p->to);
    if (level > 0 && H5Zfilter_avail(H5Z_FILTER_DEFLATE) <= 0)
        return skg_fail(SKG_ERR_UNSUPPORTED, "this HDF5 was built without zlib, so it cannot compress");
    return SKG_OK;
}

static skg_status run(packing *p) {
    char *temporary = NULL;
    skg_status status = SKG_OK;
    int descriptor = -1;
    SKG_TRY(check(p));
    SKG_TRY(skg_input_check(p->from, INT64_MAX));
    p->source = H5Fopen(p->from, H5F_ACC_RDONLY, H5P_DEFAULT);
    if (p->source < 0) return skg_hdf5_fail(p->from);
    SKG_TRY_CLEANUP(skg_alloc((int64_t)strlen(p->to) + SKG_PART_ENDING, 1, "file name", &temporary));
    descriptor = skg_part_open(p->to, temporary);
    if (descriptor < 0) {
        status = skg_output_part_fail(p->to, temporary, errno);
        goto cleanup;
    }
    close(descriptor); /* HDF5 opens it by its name */
    status = pack_to(p, temporary);
    if (status == SKG_OK && rename(temporary, p->to) != 0) status = skg_output_fail(p->to, errno, "");
    if (status != SKG_OK) unlink(temporary);
cleanup:
    H5Fclose(p->source);
    skg_free(&temporary);
    return status;
}

skg_status skg_scan_file_pack(const char *from, const char *to, const skg_scan_pack_options *options) {
    SKG_PLAIN;
    packing p = {.from = from, .to = to};
    skg_hdf5_errors before;
    SKG_NEEDS(from);
    SKG_NEEDS(to);
    skg_scan_pack_options_init(&p.options);
    if (options) SKG_TRY(skg_struct_read(options, "skg_scan_pack_options", &p.options, sizeof p.options));
    skg_hdf5_be_silent(&before);
    skg_status status = run(&p);
    skg_hdf5_be_as_before(&before);
    skg_free(&p.image);
    return status;
}
