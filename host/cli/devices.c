/* candela devices: every platform and device, what it lacks, and why it cannot be used. */
#include "cli/cli.h"
#include "core/log.h"
#include "device/device.h"

#include <jansson.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct Options {
  int json;
} Options;

static const struct argp_option option_list[] = {
    {"json", 'j', NULL, 0, "Print JSON on standard output", 0}, {0}};

static error_t parse_option(int key, char *value, struct argp_state *state) {
  Options *options = state->input;
  if (key == 'j') {
    options->json = 1;
    return 0;
  }
  if (key == ARGP_KEY_ARG) cli_usage("unexpected argument '%s'", value);
  return ARGP_ERR_UNKNOWN;
}

static const struct argp parser = {
    option_list,
    parse_option,
    "",
    "Lists every OpenCL platform and device, what it lacks, and why it cannot be used.\v"
    "The number in front of a device is what --device takes, as well as any part of its name or of "
    "its platform's. A device is exact if it computes the same bits as all exact devices; where "
    "its "
    "driver does not say so, that is measured.\n\n"
    "Exit status: 0 if a device can be used, 4 if none can, 2 for wrong usage.",
    NULL,
    NULL,
    NULL};

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

static void print_device(const cdl_DeviceInfo *d, int is_default) {
  printf("%3d  %s%s\n", d->index, d->name, is_default ? "  (default)" : "");
  printf("     %s, %s\n", d->platform, d->platform_version);
  printf("     %s of %u compute units, %s %s, driver %s, %s\n", type_name(d->type),
         d->compute_units, d->vendor, d->version, d->driver, d->c_version);
  printf("     %.1f GB of memory, %.1f GB in one buffer, %llu kB local; float width %u%s\n",
         1e-9 * d->global_mem, 1e-9 * d->max_alloc, (unsigned long long)d->local_mem / 1024,
         d->native_float_width, d->timer_ns ? "" : "; no usable timers");
  if (!d->usable)
    printf("     cannot be used: %s\n", d->unusable);
  else
    printf("     %s: %s\n", verdict(d), d->exactness);
}

static void print_list(const cdl_DeviceInfo *list, size_t count, int best) {
  for (size_t i = 0; i < count; i++) {
    if (list[i].id)
      print_device(&list[i], (int)i == best);
    else
      printf("  -  %s, %s\n     %s\n", list[i].platform, list[i].platform_version,
             list[i].unusable);
  }
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

static void print_json(const cdl_DeviceInfo *list, size_t count, int best) {
  json_t *devices = json_array();
  for (size_t i = 0; i < count; i++)
    json_array_append_new(devices, device_json(&list[i], (int)i == best));
  json_t *all = json_pack("{s:o}", "devices", devices);
  json_dumpf(all, stdout, JSON_INDENT(2));
  putchar('\n');
  json_decref(all);
}

int cli_devices(int argc, char **argv) {
  Options options = {0};
  cdl_DeviceInfo *list = NULL;
  size_t count = 0, best = 0;
  cli_parse(&parser, argc, argv, &options);
  cdl_Status status = device_list(&cli_log, &list, &count);
  if (status) return status;
  /* As a render chooses: by what drivers report, before anything is measured. */
  status = device_select(&cli_log, list, count, NULL, &best);
  int default_entry = status ? -1 : (int)best;
  for (size_t i = 0; i < count; i++) measure(&list[i]);
  if (!status) status = device_select(&cli_log, list, count, NULL, &best); /* is any left? */
  if (options.json)
    print_json(list, count, default_entry);
  else
    print_list(list, count, default_entry);
  free(list);
  if (fflush(stdout) || ferror(stdout))
    return log_fail(&cli_log, CDL_OUTPUT, "standard output could not be written");
  return status;
}
