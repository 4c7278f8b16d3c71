/* oiio.cpp: OpenImageIO behind plain C calls. Always an explicit reader or writer, working on
 * memory: the library neither guesses formats nor touches the file system. */
#include "image/oiio.h"

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include "core/log.h"
#include "image/image_file.h"

using OIIO::ImageInput;
using OIIO::ImageOutput;
using OIIO::ImageSpec;
using OIIO::TypeDesc;
using OIIO::Filesystem::IOMemReader;
using OIIO::Filesystem::IOVecOutput;

namespace {

/* Failures inside this file travel as exceptions and become a status in guarded(). */
struct Failure {
  std::string message;
};

template <class Body>
cdl_Status guarded(const cdl_Log *log, cdl_Status bad, const char *name, Body body) {
  const char *code = bad == CDL_BAD_INPUT ? "IMAGE_DATA_INVALID: " : "";
  try {
    return body();
  } catch (const Failure &failure) {
    return log_fail(log, bad, "%s: %s%s", name, code, failure.message.c_str());
  } catch (const std::bad_alloc &) {
    return log_fail(log, bad, "%s: not enough memory for the picture", name);
  } catch (const std::exception &error) {
    return log_fail(log, bad, "%s: %s%s", name, code, error.what());
  } catch (...) {
    return log_fail(log, bad, "%s: %sthe image library failed", name, code);
  }
}

/* The library's own limits hold before anything is allocated for a damaged header. One thread:
 * scenes decode their textures in parallel already. */
void configure() {
  static std::once_flag once;
  std::call_once(once, [] {
    OIIO::attribute("limits:imagesize_MB", int(IMAGE_MAX_PIXELS * 4 * sizeof(float) >> 20));
    OIIO::attribute("limits:channels", 1024);
    OIIO::attribute("threads", 1);
    OIIO::attribute("debug", 0); /* it prints */
  });
}

std::string why(std::string message, const char *otherwise) {
  if (message.empty()) message = otherwise;
  for (char &c : message)
    if (c == '\n') c = ' ';
  return message;
}

std::unique_ptr<ImageInput> open_memory(const char *format, IOMemReader &memory, ImageSpec &spec) {
  configure();
  auto input = ImageInput::create(format);
  if (!input)
    throw Failure{std::string("OpenImageIO has no reader for ") + format + ": " + OIIO::geterror()};
  ImageSpec hints;
  hints.attribute("oiio:UnassociatedAlpha", 1);
  if (!input->set_ioproxy(&memory) || !input->open("memory", spec, hints))
    throw Failure{why(input->geterror(), "the header cannot be read")};
  if (spec.deep) throw Failure{"deep images are not supported"};
  if (spec.width < 1 || spec.height < 1 || spec.depth > 1 || spec.nchannels < 1 ||
      spec.width > IMAGE_MAX_SIDE || spec.height > IMAGE_MAX_SIDE ||
      size_t(spec.width) * size_t(spec.height) > IMAGE_MAX_PIXELS)
    throw Failure{"the picture is " + std::to_string(spec.width) + " x " +
                  std::to_string(spec.height) + "; the limits are 65536 per side and 512 Mpixel"};
  return input;
}

/* Which stored channels make up RGBA: grey repeats its channel, -1 is a missing alpha. */
struct Mapping {
  int source[4];
};

Mapping map_by_count(int channels) {
  static const Mapping known[4] = {
      {{0, 0, 0, -1}}, {{0, 0, 0, 1}}, {{0, 1, 2, -1}}, {{0, 1, 2, 3}}};
  if (channels > 4) throw Failure{"the picture has more than 4 channels"};
  return known[channels - 1];
}

int find_channel(const ImageSpec &spec, const std::string &name) {
  auto at = std::find(spec.channelnames.begin(), spec.channelnames.end(), name);
  return at == spec.channelnames.end() ? -1 : int(at - spec.channelnames.begin());
}

bool map_layer(const ImageSpec &spec, const std::string &prefix, Mapping &mapping) {
  const int grey = find_channel(spec, prefix + "Y"), alpha = find_channel(spec, prefix + "A");
  mapping = {{find_channel(spec, prefix + "R"), find_channel(spec, prefix + "G"),
              find_channel(spec, prefix + "B"), alpha}};
  if (mapping.source[0] >= 0 && mapping.source[1] >= 0 && mapping.source[2] >= 0) return true;
  mapping = {{grey, grey, grey, alpha}};
  return grey >= 0;
}

Mapping map_by_name(const ImageSpec &spec) {
  Mapping mapping;
  if (map_layer(spec, "", mapping)) return mapping;
  for (const std::string &name : spec.channelnames) {
    const size_t dot = name.rfind('.');
    if (dot != std::string::npos && map_layer(spec, name.substr(0, dot + 1), mapping))
      return mapping;
  }
  throw Failure{"no channels R, G, B or Y"};
}

/* Reads straight into the RGBA buffer, one run of neighbouring stored channels at a time, then
 * spreads grey and fills in the missing alpha. */
template <class T>
void read_rgba(ImageInput &input, const ImageSpec &spec, const Mapping &mapping, TypeDesc type,
               T one, T *rgba) {
  const int *source = mapping.source;
  const bool grey = source[0] == source[1];
  for (int to = 0, count; to < 4; to += count) {
    count = 1;
    if (source[to] < 0 || (grey && (to == 1 || to == 2))) continue;
    while (to + count < 4 && source[to + count] == source[to] + count) count++;
    if (!input.read_image(0, 0, source[to], source[to] + count, type, rgba + to, 4 * sizeof(T),
                          OIIO::stride_t(4 * sizeof(T)) * spec.width))
      throw Failure{why(input.geterror(), "the pixels cannot be read")};
  }
  const size_t pixels = size_t(spec.width) * size_t(spec.height);
  for (size_t i = 0; i < pixels; i++) {
    T *pixel = rgba + 4 * i;
    if (grey) pixel[1] = pixel[2] = pixel[0];
    if (source[3] < 0) pixel[3] = one;
  }
}

template <class T> T *allocate(size_t count) {
  T *memory = static_cast<T *>(malloc(count * sizeof(T)));
  if (!memory) throw std::bad_alloc();
  return memory;
}

void decode(const char *format, const void *bytes, size_t size, cdl_Image *image) {
  IOMemReader memory(bytes, size);
  ImageSpec spec;
  auto input = open_memory(format, memory, spec);
  const bool exr = strcmp(format, "openexr") == 0;
  const Mapping mapping = exr ? map_by_name(spec) : map_by_count(spec.nchannels);
  const size_t values = size_t(spec.width) * size_t(spec.height) * 4;
  image->width = spec.width;
  image->height = spec.height;
  image->channels = 4;
  if (spec.format == TypeDesc::UINT8) {
    image->u8 = allocate<uint8_t>(values);
    read_rgba<uint8_t>(*input, spec, mapping, TypeDesc::UINT8, 255, image->u8);
  } else {
    image->f32 = allocate<float>(values);
    read_rgba<float>(*input, spec, mapping, TypeDesc::FLOAT, 1.0f, image->f32);
  }
}

/* ---- layers in ---- */

char *copy_string(const std::string &text) {
  char *copy = allocate<char>(text.size() + 1);
  memcpy(copy, text.c_str(), text.size() + 1);
  return copy;
}

void read_attributes(const ImageSpec &spec, cdl_ExrImage *image) {
  image->attributes = static_cast<cdl_ImageAttribute *>(
      calloc(spec.extra_attribs.size() + 1, sizeof(cdl_ImageAttribute)));
  if (!image->attributes) throw std::bad_alloc();
  for (const auto &entry : spec.extra_attribs) {
    const std::string name = entry.name().string();
    const TypeDesc type = entry.type();
    if (name.compare(0, 5, "oiio:") == 0) continue;
    if (type != TypeDesc::STRING && type != TypeDesc::INT && type != TypeDesc::FLOAT) continue;
    cdl_ImageAttribute *to = &image->attributes[image->attribute_count++];
    to->name = copy_string(name);
    to->type = type == TypeDesc::STRING ? CDL_ATTRIBUTE_STRING
               : type == TypeDesc::INT  ? CDL_ATTRIBUTE_INT
                                        : CDL_ATTRIBUTE_FLOAT;
    if (type == TypeDesc::STRING) to->string = copy_string(entry.get_string(1 << 30));
    if (type == TypeDesc::INT) to->integer = entry.get_int();
    if (type == TypeDesc::FLOAT) to->real = entry.get_float();
  }
}

void describe_channels(const ImageSpec &spec, cdl_ExrImage *image) {
  const size_t pixels = size_t(spec.width) * size_t(spec.height);
  image->channels =
      static_cast<cdl_ExrChannel *>(calloc(size_t(spec.nchannels), sizeof(cdl_ExrChannel)));
  if (!image->channels) throw std::bad_alloc();
  for (int c = 0; c < spec.nchannels; c++) {
    cdl_ExrChannel *to = &image->channels[image->channel_count++];
    const TypeDesc type = spec.channelformat(c);
    to->name = copy_string(spec.channelnames[size_t(c)]);
    to->type = type == TypeDesc::UINT32 ? CDL_CHANNEL_UINT
               : type == TypeDesc::HALF ? CDL_CHANNEL_HALF
                                        : CDL_CHANNEL_FLOAT;
    if (type == TypeDesc::UINT32)
      to->u32 = allocate<uint32_t>(pixels);
    else
      to->f32 = allocate<float>(pixels);
  }
}

/* A tile row or a run of scanlines at a time: native values, unpacked channel by channel, because a
 * conversion of the whole would send the integers through float. */
void read_planes(ImageInput &input, const ImageSpec &spec, cdl_ExrImage *image) {
  const int rows = spec.tile_height ? spec.tile_height : 64;
  const size_t pixel_bytes = spec.pixel_bytes(true), width = size_t(spec.width);
  std::vector<unsigned char> native(pixel_bytes * width * size_t(rows));
  for (int y = 0; y < spec.height; y += rows) {
    const int count = std::min(rows, spec.height - y), y0 = spec.y + y;
    const bool read =
        spec.tile_width
            ? input.read_tiles(0, 0, spec.x, spec.x + spec.width, y0, y0 + count, spec.z,
                               spec.z + 1, 0, spec.nchannels, TypeDesc::UNKNOWN, native.data())
            : input.read_scanlines(0, 0, y0, y0 + count, spec.z, 0, spec.nchannels,
                                   TypeDesc::UNKNOWN, native.data());
    if (!read) throw Failure{why(input.geterror(), "the pixels cannot be read")};
    size_t offset = 0;
    for (int c = 0; c < spec.nchannels; c++) {
      const TypeDesc type = spec.channelformat(c);
      const cdl_ExrChannel &to = image->channels[c];
      const bool whole = type == TypeDesc::UINT32;
      void *plane = whole ? static_cast<void *>(to.u32 + size_t(y) * width)
                          : static_cast<void *>(to.f32 + size_t(y) * width);
      const TypeDesc wanted = whole ? TypeDesc::UINT32 : TypeDesc::FLOAT;
      OIIO::convert_image(1, spec.width, count, 1, native.data() + offset, type,
                          OIIO::stride_t(pixel_bytes), OIIO::AutoStride, OIIO::AutoStride, plane,
                          wanted, OIIO::AutoStride, OIIO::AutoStride, OIIO::AutoStride);
      offset += type.size();
    }
  }
}

/* ---- out ---- */

TypeDesc stored_type(cdl_ChannelType type) {
  return type == CDL_CHANNEL_UINT   ? TypeDesc::UINT32
         : type == CDL_CHANNEL_HALF ? TypeDesc::HALF
                                    : TypeDesc::FLOAT;
}

ImageSpec layers_spec(const cdl_ImagePicture *picture) {
  ImageSpec spec(picture->width, picture->height, 0, TypeDesc::FLOAT);
  for (int l = 0; l < picture->layer_count; l++) {
    const cdl_ImageLayer &layer = picture->layers[l];
    const std::string prefix = layer.name[0] ? std::string(layer.name) + "." : "";
    for (int c = 0; c < layer.channels; c++) {
      const std::string name = prefix + layer.channel[c];
      if (find_channel(spec, name) >= 0) throw Failure{"channel " + name + " is there twice"};
      spec.channelnames.push_back(name);
      spec.channelformats.push_back(stored_type(layer.type));
    }
  }
  spec.nchannels = int(spec.channelnames.size());
  if (spec.nchannels < 1) throw Failure{"a picture needs a layer"};
  spec.attribute("compression", "zip");
  /* Without one the writer adds the time of day, and equal pictures would not be equal files. Of a
   * type that it does not take, it is left out altogether. */
  spec.attribute("DateTime", 0);
  for (int a = 0; a < picture->attribute_count; a++) {
    const cdl_ImageAttribute &entry = picture->attributes[a];
    if (entry.type == CDL_ATTRIBUTE_STRING) spec.attribute(entry.name, entry.string);
    if (entry.type == CDL_ATTRIBUTE_INT) spec.attribute(entry.name, int(entry.integer));
    if (entry.type == CDL_ATTRIBUTE_FLOAT) spec.attribute(entry.name, entry.real);
  }
  return spec;
}

std::unique_ptr<ImageOutput> open_output(const char *format, IOVecOutput &memory,
                                         const ImageSpec &spec) {
  configure();
  auto output = ImageOutput::create(format);
  if (!output)
    throw Failure{std::string("OpenImageIO has no writer for ") + format + ": " + OIIO::geterror()};
  if (!output->set_ioproxy(&memory) || !output->open("memory", spec))
    throw Failure{why(output->geterror(), "the header cannot be written")};
  return output;
}

/* Interleaves the layers row by row, in stored types: as little as possible is held twice. */
void write_rows(ImageOutput &output, const ImageSpec &spec, const cdl_ImagePicture *picture) {
  const int rows = 64; /* a multiple of the 16 lines of a ZIP block */
  const size_t pixel_bytes = spec.pixel_bytes(true), width = size_t(spec.width);
  std::vector<unsigned char> native(pixel_bytes * width * size_t(rows));
  for (int y = 0; y < spec.height; y += rows) {
    const int count = std::min(rows, spec.height - y);
    size_t offset = 0;
    for (int l = 0; l < picture->layer_count; l++) {
      const cdl_ImageLayer &layer = picture->layers[l];
      const TypeDesc type = stored_type(layer.type);
      const TypeDesc given = layer.type == CDL_CHANNEL_UINT ? TypeDesc::UINT32 : TypeDesc::FLOAT;
      const char *from =
          static_cast<const char *>(layer.data) + size_t(y) * width * size_t(layer.channels) * 4;
      OIIO::convert_image(layer.channels, spec.width, count, 1, from, given, OIIO::AutoStride,
                          OIIO::AutoStride, OIIO::AutoStride, native.data() + offset, type,
                          OIIO::stride_t(pixel_bytes), OIIO::AutoStride, OIIO::AutoStride);
      offset += type.size() * size_t(layer.channels);
    }
    if (!output.write_scanlines(y, y + count, 0, TypeDesc::UNKNOWN, native.data()))
      throw Failure{why(output.geterror(), "the pixels cannot be written")};
  }
}

} // namespace

extern "C" cdl_Status oiio_decode(const cdl_Log *log, const char *name, const char *format,
                                  const void *bytes, size_t size, cdl_Image *image) {
  return guarded(log, CDL_BAD_INPUT, name, [&] {
    decode(format, bytes, size, image);
    return CDL_OK;
  });
}

extern "C" cdl_Status oiio_read_layers(const cdl_Log *log, const char *name, const void *bytes,
                                       size_t size, cdl_ExrImage *image) {
  return guarded(log, CDL_BAD_INPUT, name, [&] {
    IOMemReader memory(bytes, size);
    ImageSpec spec;
    auto input = open_memory("openexr", memory, spec);
    image->width = spec.width;
    image->height = spec.height;
    describe_channels(spec, image);
    read_attributes(spec, image);
    read_planes(*input, spec, image);
    return CDL_OK;
  });
}

extern "C" cdl_Status oiio_write_layers(const cdl_Log *log, const char *path,
                                        const cdl_ImagePicture *picture) {
  return guarded(log, CDL_OUTPUT, path, [&] {
    std::vector<unsigned char> bytes;
    IOVecOutput memory(bytes);
    const ImageSpec spec = layers_spec(picture);
    auto output = open_output("openexr", memory, spec);
    write_rows(*output, spec, picture);
    if (!output->close()) throw Failure{why(output->geterror(), "the picture cannot be finished")};
    return image_file_write(log, path, bytes.data(), bytes.size());
  });
}

extern "C" cdl_Status oiio_write_rgb(const cdl_Log *log, const char *path, const char *format,
                                     int width, int height, int bits8, const void *rgb,
                                     const char *description) {
  return guarded(log, CDL_OUTPUT, path, [&] {
    std::vector<unsigned char> bytes;
    IOVecOutput memory(bytes);
    const TypeDesc type = bits8 ? TypeDesc::UINT8 : TypeDesc::FLOAT;
    ImageSpec spec(width, height, 3, type);
    spec.attribute("oiio:ColorSpace", bits8 ? "sRGB" : "Linear");
    spec.attribute("Software", "Candela " CDL_VERSION);
    if (description) spec.attribute("ImageDescription", description);
    if (strcmp(format, "jpeg") == 0) spec.attribute("Compression", "jpeg:95");
    if (strcmp(format, "tiff") == 0) spec.attribute("Compression", "zip");
    auto output = open_output(format, memory, spec);
    if (!output->write_image(type, rgb))
      throw Failure{why(output->geterror(), "the pixels cannot be written")};
    if (!output->close()) throw Failure{why(output->geterror(), "the picture cannot be finished")};
    return image_file_write(log, path, bytes.data(), bytes.size());
  });
}
