/* The group /entry of NXtomo (manual.nexusformat.org, application definition NXtomo) in an HDF5 file of projections. The images are those of
 * /exchange: a virtual dataset shows dark fields, flat fields and projections as one. */
#include "core/maths.h"
#include "scan/hdf5_files.h"
#include "trajectory/types.h"

#include <math.h>
#include <string.h>

/* Values of image_key. */
enum { KEY_PROJECTION = 0, KEY_FLAT = 1, KEY_DARK = 2 };

static hid_t make_group(hid_t parent, const char *name, const char *class) {
    const hid_t group = H5Gcreate2(parent, name, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    if (group >= 0 && skg_hdf5_put_text(group, "NX_class", class)) return group;
    if (group >= 0) H5Gclose(group);
    return -1;
}

/* A dataset that is a text. */
static int put_string(hid_t parent, const char *name, const char *text) {
    const hid_t type = H5Tcopy(H5T_C_S1), space = H5Screate(H5S_SCALAR), how = H5Pcreate(H5P_DATASET_CREATE);
    H5Tset_size(type, strlen(text) + 1);
    H5Pset_obj_track_times(how, 0); /* the bytes of a scan do not depend on the clock */
    const hid_t set = H5Dcreate2(parent, name, type, space, H5P_DEFAULT, how, H5P_DEFAULT);
    const int done = set >= 0 && H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, text) >= 0;
    if (set >= 0) H5Dclose(set);
    H5Pclose(how);
    H5Sclose(space);
    H5Tclose(type);
    return done;
}

static int put_mm(hid_t parent, const char *name, double mm) {
    const hsize_t one = 1;
    return !isfinite(mm) || skg_hdf5_put_set(parent, name, H5T_NATIVE_DOUBLE, 1, &one, &mm, "mm");
}

/* Images `first` and on of the whole are the dataset of this name. */
static int show(hid_t how, hid_t whole, const char *name, hsize_t first, hsize_t count,
                const skg_view *view) {
    const hsize_t start[3] = {first, 0, 0}, size[3] = {count, (hsize_t)view->rows, (hsize_t)view->columns};
    if (count == 0) return 1;
    const hid_t part = H5Screate_simple(3, size, NULL);
    const int done = H5Sselect_hyperslab(whole, H5S_SELECT_SET, start, NULL, size, NULL) >= 0 &&
                     H5Pset_virtual(how, whole, ".", name, part) >= 0;
    H5Sclose(part);
    return done;
}

static int put_images(hid_t parent, const skg_scan_file *file) {
    const hsize_t darks = (hsize_t)file->options.darks, flats = (hsize_t)file->options.flats;
    const hsize_t n = (hsize_t)file->projections;
    const hsize_t size[3] = {darks + flats + n, (hsize_t)file->view.rows, (hsize_t)file->view.columns};
    const hid_t space = H5Screate_simple(3, size, NULL), whole = H5Scopy(space),
                how = H5Pcreate(H5P_DATASET_CREATE);
    int done = H5Pset_obj_track_times(how, 0) >= 0 &&
               show(how, whole, "/exchange/data_dark", 0, darks, &file->view) &&
               show(how, whole, "/exchange/data_white", darks, flats, &file->view) &&
               show(how, whole, "/exchange/data", darks + flats, n, &file->view);
    const hid_t set =
        done ? H5Dcreate2(parent, "data", skg_hdf5_element_type(file), space, H5P_DEFAULT, how, H5P_DEFAULT)
             : -1;
    done = set >= 0 && skg_hdf5_put_text(set, "units", file->options.unit);
    if (set >= 0) H5Dclose(set);
    H5Pclose(how);
    H5Sclose(whole);
    H5Sclose(space);
    return done;
}

/* Keys and angles of all images; a field has the angle of the first projection. */
static int put_keys(hid_t detector, hid_t sample, const skg_scan_file *file, const double *theta) {
    const int64_t darks = file->options.darks, fields = darks + file->options.flats;
    const int64_t count = fields + file->projections;
    const hsize_t size = (hsize_t)count;
    int32_t *keys = NULL;
    double *angles = NULL;
    int done = 0;
    if (skg_alloc(count, sizeof *keys, "image keys", &keys) == SKG_OK &&
        skg_alloc(count, sizeof *angles, "angles", &angles) == SKG_OK) {
        for (int64_t i = 0; i < count; i++) {
            keys[i] = i < darks ? KEY_DARK : i < fields ? KEY_FLAT : KEY_PROJECTION;
            angles[i] = theta[i < fields ? 0 : i - fields];
        }
        done = skg_hdf5_put_set(detector, "image_key", H5T_NATIVE_INT32, 1, &size, keys, NULL) &&
               skg_hdf5_put_set(sample, "rotation_angle", H5T_NATIVE_DOUBLE, 1, &size, angles, "degree");
    }
    skg_free(&keys);
    skg_free(&angles);
    return done;
}

/* Where the first view has the centre of rotation. NAN: not known, of a table of poses and with a source at infinity. */
typedef struct {
    double source_mm, detector_mm; /* from the axis, along the detector's normal */
    double column;                 /* of its shadow */
} place;

static place find_place(const skg_scan_file *file) {
    const skg_scan_options *o = &file->options.scan->options;
    const skg_view *view = &file->view;
    place found = {(double)NAN, (double)NAN, (double)NAN};
    double normal[3], to_centre[3], to_axis[3], shadow[3];
    if (skg_scan_is_table(file->options.scan) && o->step_rad == 0) return found;
    skg_cross(view->column_step, view->row_step, normal);
    const double length = skg_length(normal);
    for (int k = 0; k < 3; k++) {
        to_centre[k] = view->centre[k] - view->source[k];
        to_axis[k] = o->centre[k] - view->source[k];
    }
    const double whole = skg_dot(to_centre, normal) / length, part = skg_dot(to_axis, normal) / length;
    const int is_point = view->projection == SKG_PROJECTION_POINT;
    if (view->projection == SKG_PROJECTION_PARALLEL_FROM_INFINITY || whole == 0 || part == 0) return found;
    found.source_mm = fabs(part);
    found.detector_mm = fabs(whole - part);
    for (int k = 0; k < 3; k++)
        shadow[k] = is_point ? whole / part * to_axis[k] - to_centre[k]
                             : to_axis[k] + (1 - part / whole) * to_centre[k] - to_centre[k];
    found.column = skg_dot(shadow, view->column_step) / skg_dot(view->column_step, view->column_step) +
                   0.5 * (double)(view->columns - 1);
    return found;
}

static int put_instrument(hid_t entry, const skg_scan_file *file, hid_t *detector) {
    const place at = find_place(file);
    const hsize_t one = 1;
    const hid_t instrument = make_group(entry, "instrument", "NXinstrument");
    const hid_t source = instrument >= 0 ? make_group(instrument, "source", "NXsource") : -1;
    *detector = instrument >= 0 ? make_group(instrument, "detector", "NXdetector") : -1;
    const int done = source >= 0 && *detector >= 0 && put_string(source, "name", "skiagraph") &&
                     put_string(source, "type", "Fixed Tube X-ray") && put_string(source, "probe", "x-ray") &&
                     put_mm(source, "distance", -at.source_mm) && put_images(*detector, file) &&
                     put_mm(*detector, "x_pixel_size", skg_length(file->view.column_step)) &&
                     put_mm(*detector, "y_pixel_size", skg_length(file->view.row_step)) &&
                     put_mm(*detector, "distance", at.detector_mm) &&
                     (!isfinite(at.column) || skg_hdf5_put_set(*detector, "x_rotation_axis_pixel_position",
                                                               H5T_NATIVE_DOUBLE, 1, &one, &at.column, NULL));
    if (source >= 0) H5Gclose(source);
    if (instrument >= 0) H5Gclose(instrument);
    return done;
}

/* Writes the group that viewers plot by default. */
static int put_default(hid_t entry) {
    const hid_t data = make_group(entry, "data", "NXdata");
    const int done =
        data >= 0 && skg_hdf5_put_text(data, "signal", "data") &&
        H5Lcreate_soft("/entry/instrument/detector/data", data, "data", H5P_DEFAULT, H5P_DEFAULT) >= 0 &&
        H5Lcreate_soft("/entry/instrument/detector/image_key", data, "image_key", H5P_DEFAULT, H5P_DEFAULT) >=
            0 &&
        H5Lcreate_soft("/entry/sample/rotation_angle", data, "rotation_angle", H5P_DEFAULT, H5P_DEFAULT) >= 0;
    if (data >= 0) H5Gclose(data);
    return done;
}

int skg_hdf5_put_nexus(hid_t root, const skg_scan_file *file, const double *theta) {
    const hid_t entry = make_group(root, "entry", "NXentry");
    const hid_t sample = entry >= 0 ? make_group(entry, "sample", "NXsample") : -1;
    hid_t detector = -1;
    const int done = sample >= 0 && skg_hdf5_put_text(root, "default", "entry") &&
                     skg_hdf5_put_text(entry, "default", "data") &&
                     put_string(entry, "definition", "NXtomo") &&
                     put_string(entry, "title", file->options.name) && put_string(sample, "name", "scene") &&
                     put_instrument(entry, file, &detector) && put_keys(detector, sample, file, theta) &&
                     put_default(entry);
    if (detector >= 0) H5Gclose(detector);
    if (sample >= 0) H5Gclose(sample);
    if (entry >= 0) H5Gclose(entry);
    return done;
}
