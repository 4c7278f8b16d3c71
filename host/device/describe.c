/* describe.c: every device, what it lacks and why it cannot be used, told as JSON and in words. */
#include <jansson.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/log.h"
#include "core/text.h"
#include "device/device.h"

typedef struct Listing {
  cdl_DeviceInfo *devices;
  size_t count;
  int best; /* the one that a render takes by itself; -1: none */
} Listing;

/* Keeps the last message: the reason why a device could not be measured. */
static void to_text(void *user, cdl_LogLevel level, const char *message) {
  if (level == CDL_LOG_ERROR) snprintf(user, sizeof((cdl_DeviceInfo *)0)->unusable, "%s", message);
}

/* A driver that cannot run the probe cannot render. */
static void measure(cdl_DeviceInfo *info) {
  char selector[16], why[sizeof info->unusable] = "";
  cdl_Log log = {to_text, why};
  cdl_Device *device = NULL;
  if (!info->usable || info->exact != CDL_EXACT_UNKNOWN) return;
  snprintf(selector, sizeof selector, "%d", info->index);
  if (device_open(&log, selector, &device)) {
    info->usable = 0;
    snprintf(info->unusable, sizeof info->unusable, "%s", why);
    snprintf(info->exactness, sizeof info->exactness, "could not be measured");
  } else {
    *info = *device_info(device);
  }
  device_close(device);
}

static const char *type_name(cl_device_type type) {
  type &= CL_DEVICE_TYPE_CPU | CL_DEVICE_TYPE_GPU | CL_DEVICE_TYPE_ACCELERATOR;
  if (type == CL_DEVICE_TYPE_GPU) return "GPU";
  if (type == CL_DEVICE_TYPE_CPU) return "CPU";
  return type == CL_DEVICE_TYPE_ACCELERATOR ? "accelerator" : "simulator";
}

static const char *verdict(const cdl_DeviceInfo *info) {
  if (info->exact == CDL_EXACT_NORMALS) return "exact but for denormals";
  return info->exact >= CDL_EXACT_REPORTED ? "exact" : "not exact";
}

static void print_device(FILE *out, const cdl_DeviceInfo *d, int is_default) {
  fprintf(out, "%3d  %s%s\n", d->index, d->name, is_default ? "  (default)" : "");
  fprintf(out, "     %s, %s\n", d->platform, d->platform_version);
  fprintf(out, "     %s of %u compute units, %s %s, driver %s, %s\n", type_name(d->type),
          d->compute_units, d->vendor, d->version, d->driver, d->c_version);
  fprintf(out, "     %.1f GB of memory, %.1f GB in one buffer, %llu kB local; float width %u%s\n",
          1e-9 * d->global_mem, 1e-9 * d->max_alloc, (unsigned long long)d->local_mem / 1024,
          d->native_float_width, d->timer_ns ? "" : "; no usable timers");
  if (!d->usable)
    fprintf(out, "     cannot be used: %s\n", d->unusable);
  else
    fprintf(out, "     %s: %s\n", verdict(d), d->exactness);
}

static char *list_text(const Listing *l) {
  char *text = NULL;
  size_t size;
  FILE *out = open_memstream(&text, &size);
  if (!out) return NULL;
  for (size_t i = 0; i < l->count; i++) {
    const cdl_DeviceInfo *d = &l->devices[i];
    if (d->id)
      print_device(out, d, (int)i == l->best);
    else
      fprintf(out, "  -  %s, %s\n     %s\n", d->platform, d->platform_version, d->unusable);
  }
  if (fclose(out) == 0) return text;
  free(text);
  return NULL;
}

static json_t *device_json(const cdl_DeviceInfo *d, int is_default) {
  static const char *const exactness[] = {"no", "unknown", "normals", "reported", "measured"};
  json_t *json = json_object();
  json_object_set_new(json, "platform", json_string(d->platform));
  json_object_set_new(json, "platform_version", json_string(d->platform_version));
  json_object_set_new(json, "usable", json_boolean(d->usable));
  json_object_set_new(json, "unusable", d->usable ? json_null() : json_string(d->unusable));
  if (!d->id) return json;
  json_object_update_new(json, json_pack("{s:i, s:b, s:s, s:s, s:s, s:s, s:s, s:s}", "index",
                                         d->index, "default", is_default, "name", d->name, "vendor",
                                         d->vendor, "driver", d->driver, "version", d->version,
                                         "c_version", d->c_version, "type", type_name(d->type)));
  json_object_update_new(
      json,
      json_pack("{s:I, s:I, s:I, s:I, s:I, s:I}", "compute_units", (json_int_t)d->compute_units,
                "native_float_width", (json_int_t)d->native_float_width, "global_mem_bytes",
                (json_int_t)d->global_mem, "max_alloc_bytes", (json_int_t)d->max_alloc,
                "local_mem_bytes", (json_int_t)d->local_mem, "timer_ns", (json_int_t)d->timer_ns));
  json_object_update_new(json, json_pack("{s:b, s:b, s:b, s:b, s:s, s:s}", "fma", d->has_fma,
                                         "denorms", d->has_denorms, "correctly_rounded_divide_sqrt",
                                         d->has_correct_divide, "exact",
                                         d->exact >= CDL_EXACT_REPORTED, "exact_verdict",
                                         exactness[d->exact], "exactness", d->exactness));
  return json;
}

static char *list_json(const Listing *l) {
  json_t *devices = json_array();
  for (size_t i = 0; i < l->count; i++)
    json_array_append_new(devices, device_json(&l->devices[i], (int)i == l->best));
  json_t *all = json_pack("{s:o}", "devices", devices);
  char *text = text_of_json(all);
  json_decref(all);
  return text;
}

/* Measures what drivers do not say; CDL_DEVICE if no device can be used. */
static cdl_Status take_stock(const cdl_Log *log, Listing *l) {
  size_t best = 0;
  /* As a render chooses: by what drivers report, before anything is measured. */
  cdl_Status status = device_select(log, l->devices, l->count, NULL, &best);
  l->best = status ? -1 : (int)best;
  for (size_t i = 0; i < l->count; i++) measure(&l->devices[i]);
  /* Is any left? */
  return status ? status : device_select(log, l->devices, l->count, NULL, &best);
}

static cdl_Status describe(const cdl_Log *log, char *(*tell)(const Listing *), char **text) {
  Listing listing = {0};
  *text = NULL;
  cdl_Status status = device_list(log, &listing.devices, &listing.count);
  if (status) return status;
  status = take_stock(log, &listing);
  *text = tell(&listing);
  if (!*text) status = log_fail(log, CDL_DEVICE, "not enough memory for the list of devices");
  free(listing.devices);
  return status;
}

cdl_Status cdl_devices_json(const cdl_Log *log, char **json) {
  return describe(log, list_json, json);
}

cdl_Status cdl_devices_text(const cdl_Log *log, char **text) {
  return describe(log, list_text, text);
}
