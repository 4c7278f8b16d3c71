#include "scene/accessor.h"

#include <stdlib.h>
#include <string.h>

size_t component_size(uint32_t component) {
  switch (component) {
  case GL_BYTE:
  case GL_UNSIGNED_BYTE:
    return 1;
  case GL_SHORT:
  case GL_UNSIGNED_SHORT:
    return 2;
  case GL_UNSIGNED_INT:
  case GL_FLOAT:
    return 4;
  default:
    return 0;
  }
}

/* Columns of a matrix begin at multiples of four bytes. */
static size_t column_size(const Accessor *accessor) {
  size_t rows = accessor->width / accessor->columns;
  size_t bytes = rows * component_size(accessor->component);
  return accessor->columns > 1 ? (bytes + 3) & ~(size_t)3 : bytes;
}

size_t accessor_element_size(const Accessor *accessor) {
  size_t rows = accessor->width / accessor->columns;
  return column_size(accessor) * (accessor->columns - 1) +
         rows * component_size(accessor->component);
}

size_t accessor_packed_size(const Accessor *accessor) {
  return column_size(accessor) * accessor->columns;
}

uint32_t read_unsigned(const uint8_t *data, uint32_t component, size_t i) {
  uint16_t half;
  uint32_t word;
  switch (component) {
  case GL_UNSIGNED_BYTE:
    return data[i];
  case GL_UNSIGNED_SHORT:
    memcpy(&half, data + 2 * i, 2);
    return half;
  default:
    memcpy(&word, data + 4 * i, 4);
    return word;
  }
}

/* Normalised integers: section 3.11 of the specification. */
static float read_component(const uint8_t *data, uint32_t component, uint32_t normalized) {
  int16_t half;
  float value, scale;
  switch (component) {
  case GL_FLOAT:
    memcpy(&value, data, 4);
    return value;
  case GL_BYTE:
    value = (float)(int8_t)data[0], scale = 127.0f;
    break;
  case GL_UNSIGNED_BYTE:
    value = (float)data[0], scale = 255.0f;
    break;
  case GL_SHORT:
    memcpy(&half, data, 2), value = (float)half, scale = 32767.0f;
    break;
  default:
    value = (float)read_unsigned(data, component, 0), scale = 65535.0f;
    break;
  }
  if (!normalized) return value;
  value /= scale;
  return value < -1.0f ? -1.0f : value;
}

static void read_element(const Accessor *accessor, const uint8_t *data, float *out) {
  uint32_t rows = accessor->width / accessor->columns;
  size_t size = component_size(accessor->component), column = column_size(accessor);
  for (uint32_t c = 0; c < accessor->columns; c++)
    for (uint32_t r = 0; r < rows; r++)
      out[c * rows + r] =
          read_component(data + c * column + r * size, accessor->component, accessor->normalized);
}

static const uint8_t *view_data(const Document *doc, uint32_t view, size_t offset) {
  return doc->views[view].data + offset;
}

static int is_here(const Document *doc, const Accessor *a) {
  if (a->view != DOCUMENT_NONE && !a->data) return 0;
  return !a->sparse_count || (doc->views[a->sparse_view].data && doc->views[a->values_view].data);
}

int accessor_has_data(const Document *doc, const Accessor *a) {
  return (a->data || a->sparse_count) && is_here(doc, a);
}

cdl_Status accessor_require(const Document *doc, uint32_t index) {
  if (is_here(doc, &doc->accessors[index])) return CDL_OK;
  return document_fail(doc, AT("/accessors/%u", index), "NON_RELATIVE_URI",
                       "its buffer has no data here, and nothing is fetched from the network.");
}

/* Plain packed floats, by far the most frequent kind, are copied whole. */
static void read_dense(const Accessor *accessor, float *out) {
  size_t stride = accessor->stride;
  const uint8_t *data = accessor->data;
  if (accessor->component == GL_FLOAT && stride == 4 * (size_t)accessor->width) {
    memcpy(out, data, accessor->count * stride);
    return;
  }
  for (size_t i = 0; i < accessor->count; i++)
    read_element(accessor, data + i * stride, out + i * accessor->width);
}

float *accessor_floats(const Document *doc, uint32_t index) {
  const Accessor *accessor = &doc->accessors[index];
  float *out = calloc(accessor->count, accessor->width * sizeof *out);
  if (!out) return NULL;
  if (accessor->data) read_dense(accessor, out);
  if (!accessor->sparse_count) return out;
  const uint8_t *indices = view_data(doc, accessor->sparse_view, accessor->sparse_offset);
  const uint8_t *values = view_data(doc, accessor->values_view, accessor->values_offset);
  size_t stride = accessor_packed_size(accessor);
  for (size_t i = 0; i < accessor->sparse_count; i++) {
    size_t at = read_unsigned(indices, accessor->sparse_component, i);
    read_element(accessor, values + i * stride, out + at * accessor->width);
  }
  return out;
}

uint32_t *accessor_integers(const Document *doc, uint32_t index) {
  const Accessor *accessor = &doc->accessors[index];
  uint32_t *out = calloc(accessor->count, sizeof *out);
  if (!out) return NULL;
  for (size_t i = 0; accessor->data && i < accessor->count; i++)
    out[i] = read_unsigned(accessor->data + i * accessor->stride, accessor->component, 0);
  for (size_t i = 0; i < accessor->sparse_count; i++) {
    const uint8_t *indices = view_data(doc, accessor->sparse_view, accessor->sparse_offset);
    const uint8_t *values = view_data(doc, accessor->values_view, accessor->values_offset);
    out[read_unsigned(indices, accessor->sparse_component, i)] =
        read_unsigned(values, accessor->component, i);
  }
  return out;
}

const uint8_t *accessor_element(const Document *doc, const Accessor *a, size_t i) {
  size_t low = 0, high = a->sparse_count;
  while (low < high) {
    size_t middle = (low + high) / 2;
    uint32_t index = read_unsigned(view_data(doc, a->sparse_view, a->sparse_offset),
                                   a->sparse_component, middle);
    if (index == i)
      return view_data(doc, a->values_view, a->values_offset) + middle * accessor_packed_size(a);
    if (index < i)
      low = middle + 1;
    else
      high = middle;
  }
  return a->data ? a->data + i * a->stride : NULL;
}

double accessor_component(const Accessor *a, const uint8_t *element, uint32_t c) {
  if (!element) return 0;
  uint32_t rows = a->width / a->columns;
  const uint8_t *data =
      element + c / rows * column_size(a) + c % rows * component_size(a->component);
  if (a->component == GL_UNSIGNED_INT) return read_unsigned(data, a->component, 0);
  return read_component(data, a->component, 0);
}
