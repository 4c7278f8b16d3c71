/* film.h: the channels that the film adds up. */
#ifndef CDL_ABI_FILM_H
#define CDL_ABI_FILM_H

#include "abi/types.h"

#define CDL_FILM_CHANNELS_MAX 32u

typedef struct cdl_FilmChannel {
  uint field;      /* CDL_SLOT_* of its word */
  uint first_only; /* 1: not added: the bits of the first sample */
  uint pad[2];
} cdl_FilmChannel;
CDL_ABI_SIZE(cdl_FilmChannel, 16);

#endif
