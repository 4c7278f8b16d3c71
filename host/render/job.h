/* job.h: what decides the bits of a picture, as a flat JSON object of strings and integers:
 * version, scene, kernels, camera, size, crop, samples, seed, depth, AOVs and mathematics. Two
 * renders of equal jobs give equal films, whatever device, schedule or cut they used. */
#ifndef CANDELA_RENDER_JOB_H
#define CANDELA_RENDER_JOB_H

#include <jansson.h>

#include "render/session.h"

/* *job is the caller's. CDL_DEVICE if memory is short, or what source_hash reports. */
cdl_Status job_of_session(const cdl_Session *session, json_t **job);

/* CDL_BAD_INPUT unless both jobs are equal: one line that starts with `name` and tells the first
 * member that differs and both values. `other` says whose job `ours` is: "this render". */
cdl_Status job_check(const cdl_Log *log, const char *name, const json_t *theirs, const char *other,
                     const json_t *ours);

/* An integer member; 0 if there is none. */
uint32_t job_integer(const json_t *job, const char *name);

#endif
