/* statistics.h: what was rendered and what it cost, in JSON. Members are part of the command line's
 * contract (--stats): they may be added, never renamed. */
#ifndef CANDELA_RENDER_STATISTICS_H
#define CANDELA_RENDER_STATISTICS_H

#include <jansson.h>

#include "render/session.h"

/* NULL if memory is short. Seconds, counts and bytes; rates in 10^6 rays a second of render_s. */
json_t *statistics_of_session(const cdl_Session *session);

/* Adds a part's figures to those of the parts before it: counts and times are summed, the peak is
 * the largest; a kernel's median becomes the mean of the medians by launches. */
void statistics_add(json_t *sum, const json_t *part);

/* Sets what follows from the film and the sums: film_sha256, samples and mrays_per_s. */
cdl_Status statistics_finish(json_t *statistics, const cdl_Film *film);

#endif
