/* types.h: what every shared struct is made of: 4-byte scalars and fixed arrays of them, laid out
 * alike by C, C++ and OpenCL C. Element structs of arrays are multiples of 16 bytes. */
#ifndef CDL_ABI_TYPES_H
#define CDL_ABI_TYPES_H

#ifndef __OPENCL_VERSION__
#include <stdint.h>
typedef uint32_t uint;
#endif

/* Fails to compile where sizeof(type) is not `bytes`. */
#define CDL_ABI_SIZE(type, bytes)                                                                  \
  typedef char type##_size_is_##bytes[sizeof(type) == (bytes) ? 1 : -1]

#define CDL_NONE 0xffffffffu /* no index */

#endif
