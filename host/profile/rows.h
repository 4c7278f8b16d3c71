/* rows.h: what a profile is made of; private to host/profile. */
#ifndef CANDELA_PROFILE_ROWS_H
#define CANDELA_PROFILE_ROWS_H

#include "profile/profile.h"

typedef struct ProfileRow {
  uint64_t launches, items, rays;
  double total_s;
  double first_s;       /* with compilation */
  double first_alone_s; /* without */
  double *seconds;      /* of launches that are not apart */
  size_t kept, room;
  int host_timed;
} ProfileRow;

struct cdl_Profile {
  const char *const *names;
  size_t count;
  ProfileRow *rows;
  cdl_ProfileRest rest;
};

#endif
