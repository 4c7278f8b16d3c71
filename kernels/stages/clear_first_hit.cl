/* clear_first_hit: AOVs of paths that meet no surface. */
#include "lib/stage.h"

#include "abi/params.h"
#include "lib/state.h"

__kernel void clear_first_hit(CDL_CONSTANT cdl_Wave *restrict wave, CDL_GLOBAL uint *slots) {
  CDL_FOR_EACH_ITEM(i) {
    for (uint field = CDL_SLOT_ALBEDO; field < CDL_SLOT_FIELDS; field++)
      state_set_float(slots, field, wave->slots, i, field == CDL_SLOT_DEPTH ? CDL_INFINITY : 0.0f);
  }
}
