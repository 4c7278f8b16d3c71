/* schema_compression.h: the schemas of schema_compression.c, for the list of extensions. */
#ifndef CANDELA_SCENE_SCHEMA_COMPRESSION_H
#define CANDELA_SCENE_SCHEMA_COMPRESSION_H

#include "scene/schema.h"

extern const Schema schema_draco, schema_meshopt_view_ext, schema_meshopt_view_khr,
    schema_meshopt_buffer;

#endif
