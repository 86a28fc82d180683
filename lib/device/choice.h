/* Which device is opened: drivers of driver=PATH, what is known of a device, and the choice. Private to lib/device and the self-tests. */
#ifndef SKG_CHOICE_H
#define SKG_CHOICE_H

#include "device/device.h"

/* --- drivers that driver=PATH names (icd.c)
 *
 * They are libraries that are opened without the OpenCL loader. Objects of such a driver (an ICD) begin with a pointer to its
 * functions, as those of every driver, so that the loader's calls work on them. Only the list of platforms, and calls that
 * compare with it, do not know them. */

/* Lists the loader's platforms, then those of drivers that were opened, in the order of opening. So a platform keeps its
 * number. No platform is no failure. */
skg_status skg_platforms_find(skg_platform_list *list);

/* Opens the library at this path, and lists its platforms. It stays loaded until the process ends, because its threads do.
 * To be called after skg_opencl_start. SKG_ERR_NO_DEVICE: it cannot be loaded, is no driver, or has no platform. */
skg_status skg_icd_open(const char *path, skg_platform_list *list);

/* 1: the platform came from skg_icd_open, and the loader does not list it. */
int skg_icd_has(cl_platform_id platform);

/* --- platforms that are not known (trust.c) --- */

/* 1: the platform is known, or one of its devices has passed its self-test. store: the user's folder, "" for none. */
int skg_platform_is_trusted(const char *store, cl_platform_id platform);

/* Saves that a device of this platform, which is not known, has passed its self-test. */
void skg_platform_trust(const char *store, cl_platform_id platform);

/* --- identity (identity.c) --- */

/* The digest under which programs and verdicts of a device are cached: of the names and versions of platform, device and driver; of
 * the processor's name and features if the device is a CPU, because a folder may be shared by machines; of the environment
 * variables that change what the driver compiles; and of the version of this library. A part of a device (threads=) has that of
 * the whole. */
skg_digest skg_identity_of(cl_platform_id platform, cl_device_id device);

/* Fills in identity, store, and what is known of the driver. To be called once platform and id are set. */
skg_status skg_device_identify(skg_device *device);

/* --- choosing (choose.c) --- */

/* The choices of a config for the device; NULL where they say nothing. */
typedef struct {
    const char *device, *driver; /* the values of device= and driver= */
} skg_device_words;

/* Chooses the device for the words of a config, and fills info. without: bit n excludes device n; index: the number of the chosen
 * device. A device that has failed the self-test SKG_SELF_TEST_CORE is chosen only if no other fits; opening it then fails with the
 * reason. */
skg_status skg_device_choose(const skg_device_words *words, uint64_t without, cl_platform_id *platform,
                             cl_device_id *device, skg_device_info *info, int32_t *index);

/* untested: 1 if the device of these words is of an unknown platform and has no cached verdict, so that the first context on it
 * would test it in this process. Platforms that are not trusted are not asked for their devices. */
skg_status skg_device_doubt(const skg_device_words *words, int32_t *untested);

/* The device that skg_context_create tries first for this config. */
skg_status skg_device_locate(const char *config, cl_platform_id *platform, cl_device_id *device,
                             skg_device_info *info);

/* The first step of skg_context_create: opens the device that config chooses among those that `without` leaves. The second step is
 * its self-test. */
skg_status skg_context_open(const char *config, uint64_t without, skg_context **context, int32_t *index);

/* Fills info with what OpenCL reports on a device. */
skg_status skg_device_inform(int32_t platform_number, int32_t device_number, cl_platform_id platform,
                             cl_device_id device, skg_device_info *info);

#endif
