/* Every launch of a session on a time line, in the Trace Event Format. */
#include <stdio.h>
#include <stdlib.h>

#include "core/clock.h"
#include "core/log.h"
#include "profile/watch.h"
#include "render/session.h"

typedef struct Event {
  const char *name; /* static */
  const char *unit; /* of `amount` */
  double start, seconds;
  uint64_t amount;
  int lane; /* LANE_* */
} Event;

enum { LANE_KERNELS, LANE_HOST };

struct cdl_Trace {
  cdl_Session *session;
  Event *events;
  size_t count, capacity;
  double begin;  /* clock_now() at the start */
  double cursor; /* where the next launch lies at the earliest */
  int short_of_memory;
};

static void add_event(cdl_Trace *trace, Event event) {
  if (trace->count == trace->capacity) {
    const size_t capacity = trace->capacity ? 2 * trace->capacity : 1024;
    Event *events = realloc(trace->events, capacity * sizeof *events);
    if (!events) {
      trace->short_of_memory = 1;
      return;
    }
    trace->events = events;
    trace->capacity = capacity;
  }
  trace->events[trace->count++] = event;
}

/* Launches are reported when they have long finished. The queue is in order, so they are laid end
 * to end from the last moment when host and device are known to have met. */
static void on_launch(void *user, const cdl_Launch *launch) {
  cdl_Trace *trace = user;
  cdl_Profile *profile = trace->session->profile;
  const cdl_LaunchRecord record = {.kernel = launch->kernel,
                                   .items = launch->items,
                                   .seconds = launch->seconds,
                                   .compile_seconds = launch->compile_seconds,
                                   .first = launch->first,
                                   .host_timed = launch->host_timed};
  if (profile) profile_launch(profile, &record);
  trace->cursor += launch->compile_seconds;
  add_event(trace, (Event){kernel_name(launch->kernel), "items", trace->cursor, launch->seconds,
                           launch->items, LANE_KERNELS});
  trace->cursor += launch->seconds;
}

/* A copy blocks, so the device is idle when it ends. */
static void on_transfer(void *user, size_t bytes, double seconds) {
  cdl_Trace *trace = user;
  const double now = clock_now() - trace->begin;
  if (trace->session->profile) profile_transfer(trace->session->profile, bytes, seconds);
  add_event(trace, (Event){"copy", "bytes", now - seconds, seconds, bytes, LANE_HOST});
  if (trace->cursor < now) trace->cursor = now;
}

static void on_build(void *user, cdl_KernelId kernel, double seconds) {
  cdl_Trace *trace = user;
  const double now = clock_now() - trace->begin;
  if (trace->session->profile) profile_compile(trace->session->profile, seconds);
  add_event(trace, (Event){kernel_name(kernel), "compiled", now - seconds, seconds, 1, LANE_HOST});
}

cdl_Status cdl_trace_start(cdl_Session *session, cdl_Trace **trace) {
  *trace = calloc(1, sizeof **trace);
  if (!*trace) return log_fail(session->log, CDL_DEVICE, "not enough memory for a trace");
  (*trace)->session = session;
  (*trace)->begin = clock_now();
  const cdl_Observer observer = {*trace, on_launch, on_transfer, on_build};
  cdl_Status status = device_observe(session->device, &observer);
  if (status) {
    free(*trace);
    *trace = NULL;
  }
  return status;
}

static void print_event(FILE *out, const Event *event) {
  fprintf(out,
          ",\n{\"name\":\"%s\",\"ph\":\"X\",\"pid\":1,\"tid\":%d,\"ts\":%.3f,\"dur\":%.3f,"
          "\"args\":{\"%s\":%llu}}",
          event->name, event->lane + 1, 1e6 * event->start, 1e6 * event->seconds, event->unit,
          (unsigned long long)event->amount);
}

cdl_Status cdl_trace_write(const cdl_Trace *trace, const char *path) {
  char *text = NULL;
  size_t size;
  FILE *out = trace->short_of_memory ? NULL : open_memstream(&text, &size);
  int failed = !out;
  if (out) {
    fprintf(out, "{\"displayTimeUnit\":\"ms\",\"traceEvents\":[\n");
    fprintf(out, "{\"name\":\"thread_name\",\"ph\":\"M\",\"pid\":1,\"tid\":1,"
                 "\"args\":{\"name\":\"kernels, end to end\"}},\n"
                 "{\"name\":\"thread_name\",\"ph\":\"M\",\"pid\":1,\"tid\":2,"
                 "\"args\":{\"name\":\"copies and compilation\"}}");
    for (size_t i = 0; i < trace->count; i++) print_event(out, &trace->events[i]);
    fprintf(out, "\n]}\n");
    failed = ferror(out);
    failed |= fclose(out);
  }
  cdl_Status status = failed ? log_fail(trace->session->log, CDL_OUTPUT,
                                        "%s: not enough memory for the trace", path)
                             : cdl_text_write(trace->session->log, path, text);
  free(text);
  return status;
}

void cdl_trace_free(cdl_Trace *trace) {
  if (!trace) return;
  profile_watch(trace->session->profile, trace->session->device);
  free(trace->events);
  free(trace);
}
