/* The user's folder in which compiled kernels and verdicts on devices are kept. Private.
 *
 * It is $SKG_CACHE_DIR, else $XDG_CACHE_HOME/skiagraph, else $HOME/.cache/skiagraph. SKG_CACHE_DIR=none turns it off.
 * The folder has to belong to this user, and no one else may write to it, because the driver runs what it holds.
 * Nothing here ever fails a call: what cannot be read or written is compiled or tested again. */
#ifndef SKG_KEPT_H
#define SKG_KEPT_H

#include "core/digest.h"

/* What a file of the folder holds; part of its name and of its header. */
typedef enum { SKG_KEPT_PROGRAM, SKG_KEPT_USES, SKG_KEPT_VERDICT } skg_kept;

enum { SKG_STORE_PATH = 1024 };

/* Writes the path of the folder, "" for none. Reads the environment. */
void skg_store_find(char path[SKG_STORE_PATH]);

/* Reads what is kept under this key. 1: *data and *bytes are set, and the caller frees *data with skg_free. 0: there is
 * none, or it is not whole, or it is not ours. */
int skg_store_read(const char *path, const skg_digest *key, skg_kept kind, void **data, int64_t *bytes);

/* Keeps these bytes under this key, makes the folder if need be, and removes what was not used for the longest time
 * until the folder holds at most 256 MiB. 1: done. */
int skg_store_write(const char *path, const skg_digest *key, skg_kept kind, const void *data, int64_t bytes);

/* Removes what is kept under this key. */
void skg_store_remove(const char *path, const skg_digest *key, skg_kept kind);

/* --- the size of the folder (store_bound.c) --- */

/* The ending of a file that is being written. */
#define SKG_TEMPORARY ".part"

/* Notes that this open file was used now. Files of the last hour are left alone, so that it costs nothing. */
void skg_store_used(int file);

/* Removes files of the open folder until it holds at most 256 MiB, and what a process that died left half written. Files
 * that are not ours by their name are left alone. */
void skg_store_bound(int folder);

#endif
