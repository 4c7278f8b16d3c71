/* parts.h: partial films in files. A part is an EXR picture that also has the sums of its blocks as
 * layers and, in its header, the job, the statistics and the range of blocks. */
#ifndef CANDELA_RENDER_PARTS_H
#define CANDELA_RENDER_PARTS_H

#include <jansson.h>

#include "image/image_layers.h"
#include "render/film.h"

/* A part without its pixels. */
typedef struct cdl_Part {
  const char *path; /* the caller's */
  json_t *job, *statistics, *header;
  uint32_t first, count; /* blocks */
} cdl_Part;

/* Reads what a part says of itself; part_clear() it. If `image` is not NULL, the file as read is
 * the caller's too. CDL_BAD_INPUT if the file is no part or damaged. */
cdl_Status part_read(const cdl_Log *log, const char *path, cdl_Part *part, cdl_ExrImage **image);

/* Adds the part's blocks to a film of its job. */
cdl_Status part_add(const cdl_Log *log, const cdl_Part *part, const cdl_ExrImage *image,
                    cdl_Film *film);

void part_clear(cdl_Part *part);

#endif
