#include "scene/check.h"

#include "scene/schema.h"

cdl_Status check_document(Document *doc) {
  static cdl_Status (*const checks[])(Document *) = {
      schema_check,     check_asset,     check_buffers,     check_accessors,
      check_nodes,      check_meshes,    check_materials,   check_cameras_and_lights,
      check_animations, check_mesh_data, check_deformation, check_images};
  cdl_Status status = CDL_OK;
  for (size_t i = 0; i < sizeof checks / sizeof *checks && !status; i++) status = checks[i](doc);
  return status;
}
