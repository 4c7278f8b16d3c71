/* accessor.h: the elements of accessors, once check_accessors() has proven where they lie. */
#ifndef CANDELA_SCENE_ACCESSOR_H
#define CANDELA_SCENE_ACCESSOR_H

#include "scene/document.h"

#ifdef __cplusplus
extern "C" {
#endif

#define GL_BYTE 5120u
#define GL_UNSIGNED_BYTE 5121u
#define GL_SHORT 5122u
#define GL_UNSIGNED_SHORT 5123u
#define GL_UNSIGNED_INT 5125u
#define GL_FLOAT 5126u

/* Bytes of one component; 0 for an unknown type. */
size_t component_size(uint32_t component);

/* Bytes from one element's first to its last, with the padding of matrix columns (section 3.6.2.4).
 */
size_t accessor_element_size(const Accessor *accessor);

/* Bytes from one element to the next where nothing lies between them. */
size_t accessor_packed_size(const Accessor *accessor);

/* Whether there are bytes behind an accessor: without, it is zeros, or its buffer is not here. */
int accessor_has_data(const Document *doc, const Accessor *accessor);

/* Fails for an accessor whose buffer is not here: nothing is fetched from the network, and a buffer
 * may have no uri at all. */
cdl_Status accessor_require(const Document *doc, uint32_t index);

/* All elements as floats, accessor->width for each, integers normalised where the accessor says so,
 * sparse values put in. Free the result; NULL when memory is short. */
float *accessor_floats(const Document *doc, uint32_t index);

/* The elements of a scalar unsigned accessor. Free the result; NULL when memory is short. */
uint32_t *accessor_integers(const Document *doc, uint32_t index);

/* Scalar unsigned integer number i of a run at `data`. */
uint32_t read_unsigned(const uint8_t *data, uint32_t component, size_t i);

/* Where the bytes of element i lie, sparse values considered; NULL: it is zero. */
const uint8_t *accessor_element(const Document *doc, const Accessor *accessor, size_t i);

/* Component c of an element as stored, not normalised. */
double accessor_component(const Accessor *accessor, const uint8_t *element, uint32_t c);

#ifdef __cplusplus
}
#endif
#endif
