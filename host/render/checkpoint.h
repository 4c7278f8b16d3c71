/* checkpoint.h: the state of a film in a file, bit for bit.
 *
 * The file: a magic line with the format's version, a word that tells the byte order, the size of a
 * JSON text and the text {"job", "state", "film"}, the film's arrays, and the SHA-256 of all that.
 */
#ifndef CANDELA_RENDER_CHECKPOINT_H
#define CANDELA_RENDER_CHECKPOINT_H

#include <jansson.h>

#include "render/film.h"

/* Writes all at once. `state` is what the caller wants back. CDL_OUTPUT on failure. */
cdl_Status checkpoint_write(const cdl_Log *log, const char *path, const json_t *job,
                            const json_t *state, const cdl_Film *film);

/* Whether a state is one that the reader can go on from. */
typedef int (*cdl_StateCheck)(const void *user, const json_t *state);

/* Fills a film of the same shape and gives back the state, which is the caller's. CDL_BAD_INPUT,
 * with film and *state untouched, if the file is damaged or of another job,
 * or `check`, unless it is NULL, does not take the state. */
cdl_Status checkpoint_read(const cdl_Log *log, const char *path, const json_t *job, cdl_Film *film,
                           cdl_StateCheck check, const void *user, json_t **state);

#endif
