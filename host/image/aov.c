#include "image/aov.h"

#include <string.h>

#include "core/log.h"

#define NAMES                                                                                      \
  "beauty, albedo, normal, depth, position, emission, object, material, samples, variance"

/* Layer and channel names as compositors and denoisers look for them: colours are R, G, B, vectors
 * X, Y, Z, and depth.Z is what Nuke reads as depth. */
const cdl_Aov aov_table[CDL_AOV_COUNT] = {
    [CDL_AOV_BEAUTY] = {"beauty",
                        "",
                        3,
                        {"R", "G", "B"},
                        CDL_CHANNEL_FLOAT,
                        CDL_AOV_MEAN,
                        "radiance, linear Rec. 709"},
    [CDL_AOV_ALBEDO] = {"albedo",
                        "albedo",
                        3,
                        {"R", "G", "B"},
                        CDL_CHANNEL_FLOAT,
                        CDL_AOV_MEAN,
                        "reflectance of the first surface, 0 to 1"},
    [CDL_AOV_NORMAL] = {"normal",
                        "normal",
                        3,
                        {"X", "Y", "Z"},
                        CDL_CHANNEL_FLOAT,
                        CDL_AOV_MEAN,
                        "shading normal of the first surface in the world"},
    [CDL_AOV_DEPTH] = {"depth",
                       "depth",
                       1,
                       {"Z"},
                       CDL_CHANNEL_FLOAT,
                       CDL_AOV_FIRST_SAMPLE,
                       "distance from the camera's plane in metres; infinite where nothing is hit"},
    [CDL_AOV_POSITION] = {"position",
                          "position",
                          3,
                          {"X", "Y", "Z"},
                          CDL_CHANNEL_FLOAT,
                          CDL_AOV_FIRST_SAMPLE,
                          "first surface in the world, metres"},
    [CDL_AOV_EMISSION] = {"emission",
                          "emission",
                          3,
                          {"R", "G", "B"},
                          CDL_CHANNEL_FLOAT,
                          CDL_AOV_MEAN,
                          "radiance that the first surface gives by itself"},
    [CDL_AOV_OBJECT] = {"object",
                        "object",
                        1,
                        {"id"},
                        CDL_CHANNEL_UINT,
                        CDL_AOV_FIRST_SAMPLE,
                        "nodes with a mesh and GPU instances, from 1; 0 where nothing is hit"},
    [CDL_AOV_MATERIAL] = {"material",
                          "material",
                          1,
                          {"id"},
                          CDL_CHANNEL_UINT,
                          CDL_AOV_FIRST_SAMPLE,
                          "material, counted from 1; 0 where nothing is hit"},
    [CDL_AOV_SAMPLES] =
        {"samples", "samples", 1, {"count"}, CDL_CHANNEL_UINT, CDL_AOV_STATISTIC, "samples taken"},
    [CDL_AOV_VARIANCE] = {"variance",
                          "variance",
                          3,
                          {"R", "G", "B"},
                          CDL_CHANNEL_FLOAT,
                          CDL_AOV_STATISTIC,
                          "variance of the mean in the main layer"},
};

static int find_aov(const char *name, size_t length) {
  for (int i = 0; i < CDL_AOV_COUNT; i++)
    if (strlen(aov_table[i].name) == length && strncmp(aov_table[i].name, name, length) == 0)
      return i;
  return -1;
}

cdl_Status aov_parse(const cdl_Log *log, const char *list, uint32_t *set) {
  *set = AOV_BIT(CDL_AOV_BEAUTY);
  for (const char *name = list;;) {
    const size_t length = strcspn(name, ",");
    const int id = find_aov(name, length);
    const int all = length == 3 && strncmp(name, "all", 3) == 0;
    if (id < 0 && !all)
      return log_fail(log, CDL_USAGE, "no AOV is called '%.*s'; there are " NAMES " and all",
                      (int)length, name);
    *set |= all ? AOV_ALL : AOV_BIT(id);
    if (!name[length]) return CDL_OK;
    name += length + 1;
  }
}

cdl_ImageLayer aov_layer(cdl_AovId id, const void *data) {
  const cdl_Aov *aov = &aov_table[id];
  cdl_ImageLayer layer = {
      .name = aov->layer, .channels = aov->channels, .type = aov->type, .data = data};
  memcpy(layer.channel, aov->channel, sizeof layer.channel);
  return layer;
}
