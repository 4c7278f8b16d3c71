#define _GNU_SOURCE /* strcasestr */
#include "device/device.h"

#include "core/log.h"
#include "core/text.h"

#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MAX_PLATFORMS = 64, MAX_DEVICES = 256 };

static void trim(char *text) {
  size_t n = strlen(text), lead = strspn(text, " \t");
  while (n > lead && isspace((unsigned char)text[n - 1])) n--;
  memmove(text, text + lead, n - lead);
  text[n - lead] = 0;
}

/* Long answers are CL_INVALID_VALUE in a short buffer, so they are fetched whole and cut. */
static void device_string(cl_device_id id, cl_device_info what, char text[128]) {
  size_t size = 0;
  text[0] = 0;
  if (clGetDeviceInfo(id, what, 0, NULL, &size) || !size) return;
  char *all = calloc(1, size + 1);
  if (all && !clGetDeviceInfo(id, what, size, all, NULL)) text_copy(text, 128, all);
  free(all);
  trim(text);
}

static void platform_string(cl_platform_id id, cl_platform_info what, char text[128]) {
  size_t size = 0;
  text[0] = 0;
  if (clGetPlatformInfo(id, what, 0, NULL, &size) || !size) return;
  char *all = calloc(1, size + 1);
  if (all && !clGetPlatformInfo(id, what, size, all, NULL)) text_copy(text, 128, all);
  free(all);
  trim(text);
}

/* Answers of 4 or 8 bytes; 0 if the device does not know the question. */
static uint64_t device_number(cl_device_id id, cl_device_info what) {
  uint32_t words[2] = {0};
  size_t size = 0;
  if (clGetDeviceInfo(id, what, sizeof words, words, &size) || size > sizeof words) return 0;
  return words[0] | (uint64_t)words[1] << 32; /* every host of ours is little-endian */
}

static int version_at_least_1_2(const char *text) {
  int major = 0, minor = 0;
  const char *digit = strpbrk(text, "0123456789");
  if (!digit || sscanf(digit, "%d.%d", &major, &minor) != 2) return 0;
  return major > 1 || (major == 1 && minor >= 2);
}

static void judge_use(cdl_DeviceInfo *info) {
  const char *why = "";
  if (!version_at_least_1_2(info->version))
    why = "its OpenCL is older than 1.2; a newer driver is needed";
  else if (!device_number(info->id, CL_DEVICE_AVAILABLE))
    why = "its driver says that it is not available";
  else if (!device_number(info->id, CL_DEVICE_COMPILER_AVAILABLE))
    why = "it has no compiler for OpenCL C";
  else if (!device_number(info->id, CL_DEVICE_ENDIAN_LITTLE))
    why = "it is big-endian";
  snprintf(info->unusable, sizeof info->unusable, "%s", why);
  info->usable = !*why;
}

static void judge_exactness(cdl_DeviceInfo *info) {
  if (!info->usable) {
    snprintf(info->exactness, sizeof info->exactness, "cannot be used");
  } else if (info->has_fma && info->has_denorms && info->has_correct_divide) {
    info->exact = CDL_EXACT_REPORTED;
    snprintf(info->exactness, sizeof info->exactness,
             "reports fused multiply-add, denormals and correctly rounded division");
  } else {
    info->exact = CDL_EXACT_UNKNOWN;
    snprintf(info->exactness, sizeof info->exactness, "does not report%s%s%s",
             info->has_fma ? "" : " fused multiply-add,", info->has_denorms ? "" : " denormals,",
             info->has_correct_divide ? "" : " correctly rounded division,");
    info->exactness[strlen(info->exactness) - 1] = 0;
  }
}

static void describe_device(cdl_DeviceInfo *info) {
  cl_device_id id = info->id;
  device_string(id, CL_DEVICE_NAME, info->name);
  device_string(id, CL_DEVICE_VENDOR, info->vendor);
  device_string(id, CL_DRIVER_VERSION, info->driver);
  device_string(id, CL_DEVICE_VERSION, info->version);
  device_string(id, CL_DEVICE_OPENCL_C_VERSION, info->c_version);
  info->type = device_number(id, CL_DEVICE_TYPE);
  info->compute_units = device_number(id, CL_DEVICE_MAX_COMPUTE_UNITS);
  info->native_float_width = device_number(id, CL_DEVICE_NATIVE_VECTOR_WIDTH_FLOAT);
  info->global_mem = device_number(id, CL_DEVICE_GLOBAL_MEM_SIZE);
  info->max_alloc = device_number(id, CL_DEVICE_MAX_MEM_ALLOC_SIZE);
  info->local_mem = device_number(id, CL_DEVICE_LOCAL_MEM_SIZE);
  info->max_group = device_number(id, CL_DEVICE_MAX_WORK_GROUP_SIZE);
  info->fp_config = device_number(id, CL_DEVICE_SINGLE_FP_CONFIG);
  info->has_fma = !!(info->fp_config & CL_FP_FMA);
  info->has_denorms = !!(info->fp_config & CL_FP_DENORM);
  info->has_correct_divide = !!(info->fp_config & CL_FP_CORRECTLY_ROUNDED_DIVIDE_SQRT);
  info->unified_memory = !!device_number(id, CL_DEVICE_HOST_UNIFIED_MEMORY);
  info->timer_ns = device_number(id, CL_DEVICE_PROFILING_TIMER_RESOLUTION);
  judge_use(info);
  judge_exactness(info);
}

/* The platforms of Mesa show a device only when asked to. */
static void describe_empty_platform(cdl_DeviceInfo *info, cl_int code) {
  const char *cure = "its hardware or driver was not found";
  if (strcasestr(info->platform, "rusticl"))
    cure = "set RUSTICL_ENABLE=llvmpipe for its CPU device";
  if (strcasestr(info->platform, "clover"))
    cure = "LP_CL=1 shows its CPU device, whose OpenCL is too old to be used";
  info->index = -1;
  snprintf(info->unusable, sizeof info->unusable, "no device (%s): %s", cl_error_name(code), cure);
  snprintf(info->exactness, sizeof info->exactness, "cannot be used");
}

typedef struct InfoList {
  cdl_DeviceInfo *items;
  size_t count;
  int next_index;
} InfoList;

static cdl_DeviceInfo *list_add(InfoList *list, cl_platform_id platform) {
  cdl_DeviceInfo *more = realloc(list->items, (list->count + 1) * sizeof *more);
  if (!more) return NULL;
  list->items = more;
  cdl_DeviceInfo *info = &more[list->count++];
  memset(info, 0, sizeof *info);
  info->platform_id = platform;
  platform_string(platform, CL_PLATFORM_NAME, info->platform);
  platform_string(platform, CL_PLATFORM_VERSION, info->platform_version);
  return info;
}

static int list_platform(InfoList *list, cl_platform_id platform) {
  cl_device_id ids[MAX_DEVICES];
  cl_uint count = 0;
  cl_int code = clGetDeviceIDs(platform, CL_DEVICE_TYPE_ALL, MAX_DEVICES, ids, &count);
  if (code || !count) {
    cdl_DeviceInfo *info = list_add(list, platform);
    if (info) describe_empty_platform(info, code ? code : CL_DEVICE_NOT_FOUND);
    return info != NULL;
  }
  for (cl_uint i = 0; i < count && i < MAX_DEVICES; i++) {
    cdl_DeviceInfo *info = list_add(list, platform);
    if (!info) return 0;
    info->index = list->next_index++;
    info->id = ids[i];
    describe_device(info);
  }
  return 1;
}

cdl_Status device_list(const cdl_Log *log, cdl_DeviceInfo **items, size_t *count) {
  cl_platform_id platforms[MAX_PLATFORMS];
  cl_uint platform_count = 0;
  InfoList list = {0};
  *items = NULL;
  *count = 0;
  cdl_Status status = device_prepare(log);
  if (status) return status;
  /* Without a platform the loader returns an error of its own; that is an empty list. */
  if (clGetPlatformIDs(MAX_PLATFORMS, platforms, &platform_count)) return CDL_OK;
  for (cl_uint i = 0; i < platform_count && i < MAX_PLATFORMS; i++) {
    if (list_platform(&list, platforms[i])) continue;
    free(list.items);
    return log_fail(log, CDL_DEVICE, "not enough memory to list the OpenCL devices");
  }
  *items = list.items;
  *count = list.count;
  return CDL_OK;
}
