/* output.h: the layers and header entries of a picture's file. */
#ifndef CANDELA_RENDER_OUTPUT_H
#define CANDELA_RENDER_OUTPUT_H

#include "image/image_layers.h"
#include "render/picture.h"

/* Layers as they are gathered; the list owns their data and the names that it made itself. */
typedef struct cdl_LayerList {
  cdl_ImageLayer *layers;
  char **names; /* made names, or NULL, per layer */
  int count, capacity;
} cdl_LayerList;

/* Appends a layer. Takes `data` and `name` (NULL: layer->name lives on), which are freed with the
 * list, or at once when it fails. CDL_OUTPUT, silently, if memory is short or `data` is NULL. */
cdl_Status layers_add(cdl_LayerList *list, cdl_ImageLayer layer, void *data, char *name);

void layers_free(cdl_LayerList *list);

/* Appends the block sums of a film that keeps blocks apart, those that every pixel has: per block
 * and AOV a layer "block.000012" or "block.000012.normal". */
cdl_Status part_layers(const cdl_Film *film, cdl_LayerList *list);

/* Planes of floats as one array of pixels, malloc'ed. */
float *interleave(const float *planes, size_t pixels, int channels);

#endif
