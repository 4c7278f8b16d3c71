#include "device/internal.h"

#include <pthread.h>
#include <string.h>

#define CDL_KERNEL(name, file, range, options, arguments)                                          \
  {#name, file, options, arguments, CDL_RANGE_##range},
const KernelRow kernel_rows[CDL_KERNEL_COUNT] = {
#include "device/kernels.def"
};
#undef CDL_KERNEL

#define CDL_KERNEL(name, file, range, options, arguments) #name,
static const char *const names[CDL_KERNEL_COUNT] = {
#include "device/kernels.def"
};
#undef CDL_KERNEL

enum { NAME_SIZE = 64 };

static char binding_names[CDL_MAX_BINDINGS][NAME_SIZE];
static int binding_count;
static KernelArguments arguments[CDL_KERNEL_COUNT];

const char *kernel_name(cdl_KernelId id) { return names[id]; }

const char *const *kernel_names(void) { return names; }

static int find_binding(const char *name, size_t length) {
  for (int i = 0; i < binding_count; i++)
    if (!strncmp(binding_names[i], name, length) && !binding_names[i][length]) return i;
  return -1;
}

/* The list is fixed when the program is compiled, so its limits are checked by a unit test, and
 * whatever does not fit is left out, which kernel_slot reports as a wrong number of arguments. */
static void parse_row(KernelArguments *row, const char *list) {
  for (list += strspn(list, " "); *list; list += strspn(list, " ")) {
    size_t length = strcspn(list, " ");
    int slot = length < NAME_SIZE ? find_binding(list, length) : -1;
    if (slot < 0 && length < NAME_SIZE && binding_count < CDL_MAX_BINDINGS) {
      slot = binding_count++;
      memcpy(binding_names[slot], list, length);
    }
    if (slot >= 0 && row->count < CDL_MAX_ARGUMENTS) row->slot[row->count++] = slot;
    list += length;
  }
}

static void parse_rows(void) {
  for (int i = 0; i < CDL_KERNEL_COUNT; i++) parse_row(&arguments[i], kernel_rows[i].arguments);
}

static void parse_once(void) {
  static pthread_once_t once = PTHREAD_ONCE_INIT;
  pthread_once(&once, parse_rows);
}

const KernelArguments *kernel_arguments(cdl_KernelId id) {
  parse_once();
  return &arguments[id];
}

const char *binding_name(int slot) { return binding_names[slot]; }

void bindings_set(cdl_Bindings *bindings, const char *name, const cdl_Buffer *buffer) {
  parse_once();
  int slot = find_binding(name, strlen(name));
  if (slot >= 0) bindings->mem[slot] = buffer ? buffer->mem : NULL;
}
