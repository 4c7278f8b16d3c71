/* buffer.h: memory on a device. Errors name the buffer, its size and what to do. */
#ifndef CANDELA_DEVICE_BUFFER_H
#define CANDELA_DEVICE_BUFFER_H

#include "device/device.h"

/* `name` is not copied: a literal, or something that lives as long. An all-zero buffer is none. */
typedef struct cdl_Buffer {
  cl_mem mem;
  size_t size; /* bytes asked for; 0 is allowed, `mem` then has a few zeroed bytes */
  const char *name;
  cdl_Device *device;
} cdl_Buffer;

/* `data` (NULL: contents undefined) is copied, so the caller may free it at once. */
cdl_Status buffer_create(cdl_Device *device, const char *name, size_t size, const void *data,
                         cdl_Buffer *buffer);

/* A buffer over the caller's memory, which must stay, unchanged by the host, until buffer_free:
 * on devices that share memory with the host there is no copy. `data` is best aligned to 64 bytes.
 */
cdl_Status buffer_wrap(cdl_Device *device, const char *name, size_t size, void *data,
                       cdl_Buffer *buffer);

/* Frees and zeroes it; fine for an all-zero buffer. */
void buffer_free(cdl_Buffer *buffer);

/* `offset` and `size` in bytes. Reads, writes and maps block until done; a fill is only enqueued.
 */
cdl_Status buffer_write(cdl_Buffer *buffer, size_t offset, size_t size, const void *data);
cdl_Status buffer_read(const cdl_Buffer *buffer, size_t offset, size_t size, void *data);
cdl_Status buffer_fill(cdl_Buffer *buffer, size_t offset, size_t size, uint32_t word);
cdl_Status buffer_map(const cdl_Buffer *buffer, cl_map_flags flags, size_t offset, size_t size,
                      void **data);
cdl_Status buffer_unmap(const cdl_Buffer *buffer, void *data);

#endif
