/* aov.h: the one list of what a render can give besides its colours, and their names in files. */
#ifndef CANDELA_IMAGE_AOV_H
#define CANDELA_IMAGE_AOV_H

#include "candela.h"
#include "image/image_layers.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef enum cdl_AovId {
  CDL_AOV_BEAUTY,
  CDL_AOV_ALBEDO,
  CDL_AOV_NORMAL,
  CDL_AOV_DEPTH,
  CDL_AOV_POSITION,
  CDL_AOV_EMISSION,
  CDL_AOV_OBJECT,
  CDL_AOV_MATERIAL,
  CDL_AOV_SAMPLES,
  CDL_AOV_VARIANCE,
  CDL_AOV_COUNT
} cdl_AovId;

/* Where a pixel's value comes from. */
typedef enum cdl_AovRule {
  CDL_AOV_MEAN,         /* mean over the pixel's samples */
  CDL_AOV_FIRST_SAMPLE, /* the first sample's: a mean of ids or of distances means nothing */
  CDL_AOV_STATISTIC     /* of the pixel's samples together */
} cdl_AovRule;

typedef struct cdl_Aov {
  const char *name;  /* on the command line */
  const char *layer; /* in an EXR; "" is the main layer */
  int channels;
  const char *channel[IMAGE_LAYER_CHANNELS];
  cdl_ChannelType type;
  cdl_AovRule rule;
  const char *meaning; /* with the unit, for help texts */
} cdl_Aov;

extern const cdl_Aov aov_table[CDL_AOV_COUNT];

#define AOV_BIT(id) (1u << (id))
#define AOV_ALL (AOV_BIT(CDL_AOV_COUNT) - 1u)

/* Reads a list of names with commas between them ("albedo,normal"; "all"); *set has AOV_BIT of
 * each, and of beauty always. CDL_USAGE, naming what there is, for anything else. */
cdl_Status aov_parse(const cdl_Log *log, const char *list, uint32_t *set);

/* The layer under which `data` (see cdl_ImageLayer) is stored. */
cdl_ImageLayer aov_layer(cdl_AovId id, const void *data);

#ifdef __cplusplus
}
#endif
#endif
