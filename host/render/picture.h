/* picture.h: a film with all that its files say of it. */
#ifndef CANDELA_RENDER_PICTURE_H
#define CANDELA_RENDER_PICTURE_H

#include <jansson.h>

#include "image/tonemap.h"
#include "render/session.h"

struct cdl_Picture {
  const cdl_Log *log;
  cdl_Film *film;
  json_t *job;        /* job.h */
  json_t *header;     /* flat, of strings and integers: what goes into a file's header */
  json_t *statistics; /* statistics.h */
};

/* What is known of a picture's header before the render. *header is the caller's. CDL_DEVICE if
 * memory is short. */
cdl_Status header_of_session(const cdl_Session *session, json_t **header);

/* The picture of a session as it is now; its film stays the session's. picture_clear() it. */
cdl_Status picture_of_session(cdl_Session *session, cdl_Picture *picture);

/* Writes by suffix; see cdl_session_write. */
cdl_Status picture_write(const cdl_Picture *picture, const char *path, const cdl_Display *display);

/* Frees all but the film and the picture itself. */
void picture_clear(cdl_Picture *picture);

#endif
