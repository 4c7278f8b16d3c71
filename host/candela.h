/* candela.h: the public C interface of Candela, a renderer whose light transport runs as OpenCL
 * kernels.
 *
 * Every function returns a cdl_Status. A failure is reported once, through the caller's cdl_Log,
 * where it happened, as one line that names the file, the device or the OpenCL call and the cure.
 * Nothing is ever printed. Objects are opaque; who creates one frees it. */
#ifndef CANDELA_H
#define CANDELA_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define CDL_VERSION "0.1.0"

/* What a call came to; the command line exits with the same numbers. */
typedef enum cdl_Status {
  CDL_OK = 0,
  CDL_DIFFERENT = 1,    /* a check found differences */
  CDL_USAGE = 2,        /* an argument is wrong */
  CDL_BAD_INPUT = 3,    /* a scene, image or other input is damaged, missing or not supported */
  CDL_DEVICE = 4,       /* an OpenCL call failed, or no device fits */
  CDL_OUTPUT = 5,       /* an output could not be written */
  CDL_INTERRUPTED = 130 /* stopped on request; what was finished is kept */
} cdl_Status;

/* A loaded scene. */
typedef struct cdl_Scene cdl_Scene;

typedef enum cdl_LogLevel { CDL_LOG_ERROR, CDL_LOG_WARNING, CDL_LOG_NOTE } cdl_LogLevel;

/* Where messages go. `write` gets one line without a newline; it may be NULL (silence) and may be
 * called from any thread, one call at a time. The caller keeps ownership. */
typedef struct cdl_Log {
  void (*write)(void *user, cdl_LogLevel level, const char *message);
  void *user;
} cdl_Log;

#ifdef __cplusplus
}
#endif
#endif
