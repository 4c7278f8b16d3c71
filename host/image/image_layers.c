#include "image/image_layers.h"

#include <stdlib.h>
#include <string.h>

#include "core/log.h"
#include "image/image_file.h"
#include "image/oiio.h"

#define LAYERS_MAX_BYTES ((size_t)16 << 30)

cdl_Status image_write_exr_layers(const cdl_Log *log, const char *path,
                                  const cdl_ImagePicture *picture) {
  return oiio_write_layers(log, path, picture);
}

cdl_Status image_read_exr_layers(const cdl_Log *log, const char *path, cdl_ExrImage **image) {
  unsigned char *bytes = NULL;
  size_t size = 0;
  *image = NULL;
  cdl_Status status = image_file_read(log, path, LAYERS_MAX_BYTES, &bytes, &size);
  if (status != CDL_OK) return status;
  cdl_ExrImage *read = calloc(1, sizeof *read);
  if (!read) {
    status = log_fail(log, CDL_BAD_INPUT, "%s: not enough memory for the picture", path);
    goto done;
  }
  if (size < 4 || memcmp(bytes, "\x76\x2f\x31\x01", 4) != 0) {
    status =
        log_fail(log, CDL_BAD_INPUT, "%s: IMAGE_UNRECOGNIZED_FORMAT: not an OpenEXR file", path);
    goto done;
  }
  status = oiio_read_layers(log, path, bytes, size, read);
  if (status == CDL_OK) {
    *image = read;
    read = NULL;
  }
done:
  image_exr_free(read);
  free(bytes);
  return status;
}

void image_exr_free(cdl_ExrImage *image) {
  if (!image) return;
  for (int c = 0; c < image->channel_count; c++) {
    free(image->channels[c].name);
    free(image->channels[c].f32);
    free(image->channels[c].u32);
  }
  for (int a = 0; a < image->attribute_count; a++) {
    free((char *)image->attributes[a].name);
    free((char *)image->attributes[a].string);
  }
  free(image->channels);
  free(image->attributes);
  free(image);
}

const cdl_ExrChannel *image_exr_channel(const cdl_ExrImage *image, const char *name) {
  for (int c = 0; c < image->channel_count; c++)
    if (strcmp(image->channels[c].name, name) == 0) return &image->channels[c];
  return NULL;
}

const cdl_ImageAttribute *image_exr_attribute(const cdl_ExrImage *image, const char *name) {
  for (int a = 0; a < image->attribute_count; a++)
    if (strcmp(image->attributes[a].name, name) == 0) return &image->attributes[a];
  return NULL;
}
