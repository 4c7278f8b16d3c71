#include <string.h>
#include "scene/build.h"
int metal_index(const char *name, float eta[3], float k[3]) {
  (void)name;
  (void)eta;
  (void)k;
  return 0;
}
