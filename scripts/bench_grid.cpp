#include "bench_grid.h"

#include <nanovdb/util/GridBuilder.h>

#include <cstdlib>
#include <cstring>

void *bench_nanovdb(int side, size_t *size) {
  nanovdb::GridBuilder<float> builder(0.0f, nanovdb::GridClass::FogVolume);
  builder([side](const nanovdb::Coord &at) { return bench_smoke(side, at[0], at[1], at[2]); },
          nanovdb::CoordBBox(nanovdb::Coord(0), nanovdb::Coord(side - 1)));
  auto handle = builder.getHandle<>();
  *size = handle.size();
  void *data = aligned_alloc(64, (*size + 63) / 64 * 64);
  if (!data) abort();
  memcpy(data, handle.data(), *size);
  return data;
}
