#include "core/log.h"

#include <stdarg.h>
#include <stdio.h>

static void log_line(const cdl_Log *log, cdl_LogLevel level, const char *format, va_list args) {
  if (!log || !log->write) return;
  char line[2048];
  vsnprintf(line, sizeof line, format, args);
  for (char *c = line; *c; c++)
    if (*c == '\n' || *c == '\r') *c = ' ';
  log->write(log->user, level, line);
}

cdl_Status log_fail(const cdl_Log *log, cdl_Status status, const char *format, ...) {
  va_list args;
  va_start(args, format);
  log_line(log, CDL_LOG_ERROR, format, args);
  va_end(args);
  return status;
}

void log_warning(const cdl_Log *log, const char *format, ...) {
  va_list args;
  va_start(args, format);
  log_line(log, CDL_LOG_WARNING, format, args);
  va_end(args);
}

void log_note(const cdl_Log *log, const char *format, ...) {
  va_list args;
  va_start(args, format);
  log_line(log, CDL_LOG_NOTE, format, args);
  va_end(args);
}
