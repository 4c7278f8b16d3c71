#include "device/device.h"

#include "core/log.h"

#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static int contains(const char *text, const char *part) {
  size_t n = strlen(part);
  for (; *text; text++) {
    size_t i = 0;
    while (i < n && tolower((unsigned char)text[i]) == tolower((unsigned char)part[i])) i++;
    if (i == n) return 1;
  }
  return 0;
}

/* Better is higher. A GPU whose driver does not report exact arithmetic comes after every CPU: an
 * image must not change with the machine unless that was asked for. Simulators, which call
 * themselves every type at once, come last. */
static int preference(const cdl_DeviceInfo *info) {
  cl_device_type type = info->type & (CL_DEVICE_TYPE_CPU | CL_DEVICE_TYPE_GPU);
  int exact = info->exact >= CDL_EXACT_REPORTED;
  if (!info->usable) return 0;
  if (type == CL_DEVICE_TYPE_GPU && exact) return 4;
  if (type == CL_DEVICE_TYPE_CPU) return exact ? 3 : 2;
  return 1;
}

static cdl_Status select_best(const cdl_Log *log, const cdl_DeviceInfo *list, size_t count,
                              size_t *chosen) {
  int best = 0;
  for (size_t i = 0; i < count; i++) {
    if (preference(&list[i]) <= best) continue;
    best = preference(&list[i]);
    *chosen = i;
  }
  if (best) return CDL_OK;
  return log_fail(log, CDL_DEVICE,
                  "no usable OpenCL device: install PoCL (pocl-opencl-icd) to render on the CPU; "
                  "`candela devices` says what was found");
}

/* 1 if `entry` is what the selector means. */
static int matches(const cdl_DeviceInfo *entry, const char *selector) {
  char *end;
  long index = strtol(selector, &end, 10);
  if (isdigit((unsigned char)*selector) && !*end) return entry->index == index;
  return contains(entry->name, selector) || contains(entry->platform, selector);
}

cdl_Status device_select(const cdl_Log *log, const cdl_DeviceInfo *list, size_t count,
                         const char *selector, size_t *chosen) {
  if (!selector || !*selector) return select_best(log, list, count, chosen);
  const cdl_DeviceInfo *refused = NULL;
  for (size_t i = 0; i < count; i++) {
    if (!matches(&list[i], selector)) continue;
    if (list[i].usable) {
      *chosen = i;
      return CDL_OK;
    }
    if (!refused) refused = &list[i];
  }
  if (refused)
    return log_fail(log, CDL_USAGE, "device '%s' is %s%s%s, which cannot be used: %s", selector,
                    refused->platform, *refused->name ? ", " : "", refused->name,
                    refused->unusable);
  return log_fail(log, CDL_USAGE,
                  "no OpenCL device matches '%s': `candela devices` lists what there is", selector);
}
