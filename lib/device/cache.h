/* The cache of compiled kernels and verdicts on devices: a folder of the user. Private.
 *
 * It is $SKG_CACHE_DIR, else $XDG_CACHE_HOME/skiagraph, else $HOME/.cache/skiagraph. SKG_CACHE_DIR=none turns it off.
 * The folder has to belong to this user, and no one else may write to it, because the driver runs what it holds.
 * A file that cannot be read or written fails no call: the kernel is compiled, or the device tested, again. */
#ifndef SKG_DEVICE_CACHE_H
#define SKG_DEVICE_CACHE_H

#include "core/digest.h"

/* The kind of contents of a file of the folder; part of its name and of its header. */
typedef enum { SKG_KEPT_PROGRAM, SKG_KEPT_USES, SKG_KEPT_VERDICT } skg_kept;

enum { SKG_STORE_PATH = 1024 };

/* Writes the path of the folder, "" for none. Reads the environment. */
void skg_store_find(char path[SKG_STORE_PATH]);

/* Reads the entry of a key. 1: *data and *bytes are set, and the caller frees *data with skg_free. 0: there is none, or the file is
 * damaged, or it belongs to another user. */
int skg_store_read(const char *path, const skg_digest *key, skg_kept kind, void **data, int64_t *bytes);

/* Writes the entry of a key, makes the folder if need be, and removes the least recently used entries until the folder holds
 * at most 256 MiB. 1: done. */
int skg_store_write(const char *path, const skg_digest *key, skg_kept kind, const void *data, int64_t bytes);

/* Removes the entry of a key. */
void skg_store_remove(const char *path, const skg_digest *key, skg_kept kind);

/* --- the size of the folder (store_bound.c) --- */

/* The ending of a file that is being written. */
#define SKG_TEMPORARY ".part"

/* Marks this open file as used now. The time of a file is written at most once an hour, to save writes. */
void skg_store_used(int file);

/* Removes the least recently used files of the open folder until it holds at most 256 MiB, and the unfinished files of processes that
 * have ended. Files with other names stay. */
void skg_store_bound(int folder);

#endif
