/* image_layers.h: pictures of many named layers, stored as OpenEXR. */
#ifndef CANDELA_IMAGE_IMAGE_LAYERS_H
#define CANDELA_IMAGE_IMAGE_LAYERS_H

#include "candela.h"

#ifdef __cplusplus
extern "C" {
#endif

#define IMAGE_LAYER_CHANNELS 4

/* How a channel is stored in the file. */
typedef enum cdl_ChannelType {
  CDL_CHANNEL_FLOAT,
  CDL_CHANNEL_HALF,
  CDL_CHANNEL_UINT
} cdl_ChannelType;

/* One layer to write; names and data stay the caller's. */
typedef struct cdl_ImageLayer {
  const char *name; /* "": the main layer, whose channels are R, G, B; "albedo": albedo.R, … */
  int channels;     /* 1 to IMAGE_LAYER_CHANNELS */
  const char *channel[IMAGE_LAYER_CHANNELS]; /* "R", "X", "id", … without the layer's name */
  cdl_ChannelType type;
  const void *data; /* height × width × channels, rows from the top: float (FLOAT and HALF, which is
                       rounded on the way) or uint32_t (UINT, stored bit for bit) */
} cdl_ImageLayer;

typedef enum cdl_AttributeType {
  CDL_ATTRIBUTE_STRING,
  CDL_ATTRIBUTE_INT,
  CDL_ATTRIBUTE_FLOAT
} cdl_AttributeType;

/* One entry of a file's header; the field that `type` names holds the value. 64-bit numbers and
 * hashes go as strings. Names: letters, digits, dots ("candela.seed"), at most 255 bytes; no colon,
 * which the library takes for a format's own. */
typedef struct cdl_ImageAttribute {
  const char *name;
  cdl_AttributeType type;
  const char *string;
  int32_t integer;
  float real;
} cdl_ImageAttribute;

/* What goes into a file. */
typedef struct cdl_ImagePicture {
  int width, height;
  const cdl_ImageLayer *layers;
  int layer_count;
  const cdl_ImageAttribute *attributes;
  int attribute_count;
} cdl_ImagePicture;

/* Writes one scanline part, ZIP compressed, all at once (image_file_write). The same picture gives
 * the same bytes. CDL_OUTPUT on failure, with no file left behind. */
cdl_Status image_write_exr_layers(const cdl_Log *log, const char *path,
                                  const cdl_ImagePicture *picture);

/* One channel as read; `name` is the whole name ("albedo.R"). */
typedef struct cdl_ExrChannel {
  char *name;
  cdl_ChannelType type; /* as stored */
  float *f32;           /* height × width, for FLOAT and HALF; else NULL */
  uint32_t *u32;        /* height × width, for UINT, bit for bit; else NULL */
} cdl_ExrChannel;

/* A file as read: every channel and those header entries that are strings, ints and floats. */
typedef struct cdl_ExrImage {
  int width, height;
  cdl_ExrChannel *channels;
  int channel_count;
  cdl_ImageAttribute *attributes;
  int attribute_count;
} cdl_ExrImage;

/* Reads the first part of an OpenEXR file (at most 16 GiB). *image is the caller's
 * (image_exr_free), NULL on failure, with CDL_BAD_INPUT. */
cdl_Status image_read_exr_layers(const cdl_Log *log, const char *path, cdl_ExrImage **image);

void image_exr_free(cdl_ExrImage *image);

/* NULL when there is none of that name. What is returned lives as long as the image. */
const cdl_ExrChannel *image_exr_channel(const cdl_ExrImage *image, const char *name);
const cdl_ImageAttribute *image_exr_attribute(const cdl_ExrImage *image, const char *name);

#ifdef __cplusplus
}
#endif
#endif
