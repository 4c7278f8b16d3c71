/* schema_compression.c: the members of the extensions that compress data. */
#include "scene/schema_members.h"
#include "scene/schema_compression.h"

static const char *const modes[] = {"ATTRIBUTES", "TRIANGLES", "INDICES", NULL};
static const char *const ext_filters[] = {"NONE", "OCTAHEDRAL", "QUATERNION", "EXPONENTIAL", NULL};
static const char *const khr_filters[] = {"NONE",        "OCTAHEDRAL", "QUATERNION",
                                          "EXPONENTIAL", "COLOR",      NULL};

static const Member draco[] = {INDEX("bufferView", REQUIRED, "bufferViews"),
                               INDEX_MAP("attributes", REQUIRED, NULL), END};
SCHEMA(schema_draco, "KHR_draco_mesh_compression", draco);

#define MESHOPT_VIEW(filters)                                                                      \
  {                                                                                                \
    INDEX("buffer", REQUIRED, "buffers"), INTEGER("byteOffset", 0, 0, MOST),                       \
        INTEGER("byteLength", REQUIRED, 1, MOST), INTEGER("byteStride", REQUIRED, 2, 256),         \
        INTEGER("count", REQUIRED, 1, MOST), CHOICE("mode", REQUIRED | LISTED, modes),             \
        CHOICE("filter", LISTED, filters), END                                                     \
  }
static const Member ext_view[] = MESHOPT_VIEW(ext_filters);
SCHEMA(schema_meshopt_view_ext, "EXT_meshopt_compression", ext_view);
static const Member khr_view[] = MESHOPT_VIEW(khr_filters);
SCHEMA(schema_meshopt_view_khr, "KHR_meshopt_compression", khr_view);

static const Member buffer[] = {FLAG("fallback"), END};
SCHEMA(schema_meshopt_buffer, "meshopt buffer", buffer);
