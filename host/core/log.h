/* log.h: how library functions report; see cdl_Log. */
#ifndef CANDELA_CORE_LOG_H
#define CANDELA_CORE_LOG_H

#include "candela.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Reports one error line and returns `status`, so that a failure reads `return log_fail(…)`.
 * The message is at most 2047 bytes; longer ones are cut; newlines become spaces. */
cdl_Status log_fail(const cdl_Log *log, cdl_Status status, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

void log_warning(const cdl_Log *log, const char *format, ...) __attribute__((format(printf, 2, 3)));

void log_note(const cdl_Log *log, const char *format, ...) __attribute__((format(printf, 2, 3)));

#ifdef __cplusplus
}
#endif
#endif
