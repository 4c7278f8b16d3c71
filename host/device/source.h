/* source.h: the kernel sources, embedded in the program or read from the folder $CANDELA_KERNELS.
 *
 * Paths are relative to the root of the tree, "stages/intersect.cl", with forward slashes. */
#ifndef CANDELA_DEVICE_SOURCE_H
#define CANDELA_DEVICE_SOURCE_H

#include "candela.h"

typedef struct cdl_KernelSource {
  const char *path;
  const char *text; /* NUL-terminated */
  size_t size;      /* bytes without the NUL */
} cdl_KernelSource;

/* Generated from kernels/ by scripts/embed_kernels.sh: sorted by path, ended by a NULL path. */
extern const cdl_KernelSource kernel_sources[];

/* The text of one source, NUL-terminated, to be freed by the caller. CDL_BAD_INPUT if there is no
 * such file. */
cdl_Status source_read(const cdl_Log *log, const char *path, char **text);

/* One translation unit: the file with every `#include "path"` replaced by that file, where `path`
 * is relative to the root of the tree. #line directives keep file and line of compiler messages.
 * A header with an include guard is put in once, any other at every include; `#include <path>` is
 * left to the compiler. The caller frees *text. CDL_BAD_INPUT names an unknown include and the file
 * and line that asks for it. */
cdl_Status source_flatten(const cdl_Log *log, const char *path, char **text);

/* The same for a text that is not part of the tree, such as the kernel of a test; `label` is its
 * name in messages. */
cdl_Status source_flatten_text(const cdl_Log *log, const char *label, const char *source,
                               char **text);

enum { CDL_SHA256_HEX = 65 };

/* SHA-256 over paths and contents of the whole tree, as 64 hexadecimal digits and a NUL. */
cdl_Status source_hash(const cdl_Log *log, char hex[CDL_SHA256_HEX]);

#endif
