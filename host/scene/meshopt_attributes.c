/* meshopt_attributes.c: attribute streams of KHR_meshopt_compression, appendix A, mode 0: the
 * library that Debian 12 has does not know the streams' version 1.
 *
 * A stream: header, blocks, padding, tail. A block holds up to 256 elements byte by byte: for each
 * byte of an element the differences from one element to the next, in groups of 16. The tail holds
 * the element before the first, and (version 1) how each four bytes were made into differences. */
#include <string.h>

#include "scene/compression.h"

enum { GROUP = 16, BLOCK_BYTES = 8192, BLOCK_ELEMENTS = 256, MOST_STRIDE = 256 };
enum { CONTROL_ZERO = 2, CONTROL_LITERAL = 3 };
enum { CHANNEL_BYTES, CHANNEL_SHORTS, CHANNEL_XOR };

typedef struct Reader {
  const uint8_t *at, *end;
} Reader;

static const uint8_t *take(Reader *reader, size_t size) {
  const uint8_t *at = reader->at;
  if ((size_t)(reader->end - at) < size) return NULL;
  reader->at += size;
  return at;
}

/* 16 differences of `bits` each; one with all bits set stands for a byte that follows. */
static int read_group(Reader *reader, unsigned bits, uint8_t *out) {
  const uint8_t *packed = take(reader, 2 * bits), sentinel = (uint8_t)((1u << bits) - 1);
  if (!packed) return 0;
  if (bits == 0) memset(out, 0, GROUP);
  if (bits == 8) memcpy(out, packed, GROUP);
  for (unsigned i = 0; bits > 0 && bits < 8 && i < GROUP; i++) {
    unsigned at = i * bits % 8, shift = bits == 1 ? at : 8 - bits - at;
    out[i] = packed[i * bits / 8] >> shift & sentinel;
    if (out[i] != sentinel) continue;
    const uint8_t *literal = take(reader, 1);
    if (!literal) return 0;
    out[i] = *literal;
  }
  return 1;
}

/* The differences of one byte of `count` elements; out has room for whole groups. */
static int read_bytes(Reader *reader, const uint8_t bits[4], size_t count, uint8_t *out) {
  size_t groups = (count + GROUP - 1) / GROUP;
  const uint8_t *headers = take(reader, (groups + 3) / 4);
  for (size_t g = 0; headers && g < groups; g++)
    if (!read_group(reader, bits[headers[g / 4] >> g % 4 * 2 & 3], out + g * GROUP)) return 0;
  return headers != NULL;
}

static int read_controlled(Reader *reader, unsigned control, size_t count, uint8_t *out) {
  static const uint8_t bits[2][4] = {{0, 1, 2, 4}, {1, 2, 4, 8}};
  if (control < CONTROL_ZERO) return read_bytes(reader, bits[control], count, out);
  if (control == CONTROL_ZERO) {
    memset(out, 0, count);
    return 1;
  }
  const uint8_t *literals = take(reader, count);
  if (literals) memcpy(out, literals, count);
  return literals != NULL;
}

/* The value of four bytes from the one before and the four bytes of difference. */
static uint32_t next_value(uint8_t channel, uint32_t last, uint32_t d) {
  uint32_t turn = channel >> 4, value = 0; /* turned left when it was written */
  switch (channel & 15) {
  case CHANNEL_BYTES:
    for (int k = 0; k < 32; k += 8) {
      uint32_t v = d >> k & 0xff, step = v & 1 ? ~(v >> 1) : v >> 1;
      value |= (((last >> k) + step) & 0xff) << k;
    }
    return value;
  case CHANNEL_SHORTS:
    for (int k = 0; k < 32; k += 16) {
      uint32_t v = d >> k & 0xffff, step = v & 1 ? ~(v >> 1) : v >> 1;
      value |= (((last >> k) + step) & 0xffff) << k;
    }
    return value;
  default:
    return last ^ (d >> turn | d << ((32 - turn) & 31));
  }
}

/* One block. `last` is the element before it, and then its last one. */
static int read_block(Reader *reader, const uint8_t *channels, size_t count, size_t stride,
                      uint8_t *last, uint8_t *out) {
  static const uint8_t bits[4] = {0, 2, 4, 8};
  uint8_t bytes[BLOCK_BYTES];
  size_t room = (count + GROUP - 1) / GROUP * GROUP;
  const uint8_t *controls = channels ? take(reader, stride / 4) : NULL;
  if (channels && !controls) return 0;
  for (size_t k = 0; k < stride; k++) {
    uint8_t *to = bytes + k * room;
    int held = controls ? read_controlled(reader, controls[k / 4] >> k % 4 * 2 & 3, count, to)
                        : read_bytes(reader, bits, count, to);
    if (!held) return 0;
  }
  for (size_t k = 0; k < stride; k += 4) {
    uint8_t channel = channels ? channels[k / 4] : CHANNEL_BYTES;
    uint32_t value = (uint32_t)last[k] | (uint32_t)last[k + 1] << 8 | (uint32_t)last[k + 2] << 16 |
                     (uint32_t)last[k + 3] << 24;
    for (size_t i = 0; i < count; i++) {
      const uint8_t *b = bytes + k * room + i;
      value = next_value(channel, value,
                         (uint32_t)b[0] | (uint32_t)b[room] << 8 | (uint32_t)b[2 * room] << 16 |
                             (uint32_t)b[3 * room] << 24);
      for (int c = 0; c < 4; c++) out[i * stride + k + c] = (uint8_t)(value >> 8 * c);
    }
  }
  memcpy(last, out + (count - 1) * stride, stride);
  return 1;
}

static int channels_hold(const uint8_t *channels, size_t count) {
  for (size_t i = 0; i < count; i++)
    if ((channels[i] & 15) > CHANNEL_XOR || ((channels[i] & 15) < CHANNEL_XOR && channels[i] >> 4))
      return 0;
  return 1;
}

int meshopt_attributes(const uint8_t *stream, size_t size, size_t count, size_t stride,
                       uint8_t *out) {
  int version = size ? stream[0] & 15 : 0;
  size_t tail = stride + (version ? stride / 4 : 0), least = version ? 24 : 32;
  size_t padded = tail < least ? least : tail;
  if (size < 1 + padded || stream[0] >> 4 != 0xa || version > 1) return 0;
  Reader reader = {stream + 1, stream + size - padded};
  const uint8_t *first = stream + size - tail, *channels = version ? first + stride : NULL;
  if (channels && !channels_hold(channels, stride / 4)) return 0;
  uint8_t last[MOST_STRIDE];
  memcpy(last, first, stride);
  size_t most = BLOCK_BYTES / stride & ~(size_t)(GROUP - 1);
  if (most > BLOCK_ELEMENTS) most = BLOCK_ELEMENTS;
  for (size_t done = 0; done < count;) {
    size_t here = count - done < most ? count - done : most;
    if (!read_block(&reader, channels, here, stride, last, out + done * stride)) return 0;
    done += here;
  }
  return reader.at == reader.end;
}
