/* image_file.h: whole files in and out, for this folder. */
#ifndef CANDELA_IMAGE_IMAGE_FILE_H
#define CANDELA_IMAGE_IMAGE_FILE_H

#include "candela.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Reads a regular file of at most `limit` bytes. *bytes is malloc'ed and the caller's, never NULL
 * on success. CDL_BAD_INPUT if it is missing, not a regular file, too large or unreadable. */
cdl_Status image_file_read(const cdl_Log *log, const char *path, size_t limit,
                           unsigned char **bytes, size_t *size);

/* Writes `path` all at once: a temporary file in the same folder is filled, synced and renamed, so
 * that nobody ever sees half a file. On failure CDL_OUTPUT; the old file, if any, is untouched and
 * no temporary file stays. */
cdl_Status image_file_write(const cdl_Log *log, const char *path, const void *bytes, size_t size);

/* Finds out whether image_file_write could create `path`, by creating its temporary file. */
cdl_Status image_file_probe(const cdl_Log *log, const char *path);

#ifdef __cplusplus
}
#endif
#endif
