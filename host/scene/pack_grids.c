#include <stdlib.h>
#include <string.h>

#include "core/log.h"
#include "scene/blackbody.h"
#include "scene/pack_parts.h"

/* Room that all grids need together. */
typedef struct Room {
  uint64_t entries, most, bricks; /* bricks: of CDL_GRID_VALUES each */
} Room;

static void lay_out(const cdl_SceneGrid *from, Room *room, cdl_Grid *to) {
  uint64_t entries = 1, blocks = 1;
  for (int c = 0; c < 3; c++) {
    to->size[c] = from->size[c];
    to->bricks[c] = from->bricks[c];
    to->blocks[c] = (from->bricks[c] + CDL_GRID_BLOCK - 1) / CDL_GRID_BLOCK;
    entries *= to->bricks[c];
    blocks *= to->blocks[c];
  }
  to->channels = from->channels;
  to->first_brick = (uint32_t)room->entries;
  to->first_block = (uint32_t)room->most; /* of blocks alone, so far */
  room->entries += entries;
  room->most += blocks;
  room->bricks += (uint64_t)from->brick_count * from->channels;
}

/* The largest value of each block. */
static void fill_blocks(const cdl_Grid *grid, float *most) {
  const float *brick = most + grid->first_brick;
  float *block = most + grid->first_block;
  for (uint32_t z = 0; z < grid->bricks[2]; z++)
    for (uint32_t y = 0; y < grid->bricks[1]; y++)
      for (uint32_t x = 0; x < grid->bricks[0]; x++, brick++) {
        uint32_t at =
            (z / CDL_GRID_BLOCK * grid->blocks[1] + y / CDL_GRID_BLOCK) * grid->blocks[0] +
            x / CDL_GRID_BLOCK;
        if (*brick > block[at]) block[at] = *brick;
      }
}

static uint32_t fill(const cdl_SceneGrid *from, uint32_t first_number, const cdl_Grid *to,
                     cdl_Pack *pack) {
  size_t entries = (size_t)to->bricks[0] * to->bricks[1] * to->bricks[2];
  size_t numbers = (size_t)from->brick_count * from->channels;
  for (size_t i = 0; i < entries; i++)
    pack->grid_table[to->first_brick + i] =
        from->table[i] == CDL_NONE ? CDL_NONE : first_number + from->table[i] * from->channels;
  memcpy(pack->grid_most + to->first_brick, from->most, entries * sizeof *from->most);
  memcpy(pack->grid_values + (size_t)first_number * CDL_GRID_VALUES, from->values,
         numbers * CDL_GRID_VALUES * sizeof *from->values);
  fill_blocks(to, pack->grid_most);
  return first_number + (uint32_t)numbers;
}

static cdl_Status pack_blackbody(const cdl_Log *log, const cdl_Scene *scene, cdl_Pack *pack) {
  int hot = 0;
  for (uint32_t i = 0; i < scene->medium_count; i++) hot |= scene->media[i].temperature != CDL_NONE;
  pack->blackbody_count = hot ? 3 * (size_t)CDL_BLACKBODY_COUNT : 0;
  pack->blackbody = pack_array(log, "black body", pack->blackbody_count, sizeof *pack->blackbody);
  if (!pack->blackbody) return CDL_BAD_INPUT;
  for (size_t i = 0; i < pack->blackbody_count; i += 3)
    blackbody_radiance(CDL_BLACKBODY_STEP * (float)(i / 3), pack->blackbody + i);
  return CDL_OK;
}

cdl_Status pack_grids(const cdl_Log *log, const cdl_Scene *scene, cdl_Pack *pack) {
  Room room = {0, 0, 0};
  pack->grid_count = scene->grid_count;
  pack->features.grids = scene->grid_count > 0;
  pack->grids = pack_array(log, "grids", pack->grid_count, sizeof *pack->grids);
  if (!pack->grids) return CDL_BAD_INPUT;
  for (uint32_t i = 0; i < scene->grid_count; i++)
    lay_out(&scene->grids[i], &room, &pack->grids[i]);
  if (room.entries + room.most > UINT32_MAX || room.bricks >= CDL_NONE)
    return log_fail(log, CDL_BAD_INPUT,
                    "%s: the grids of its media are more than fit; use coarser ones", scene->path);
  pack->grid_entries = room.entries;
  pack->grid_most_count = room.entries + room.most;
  pack->grid_value_count = room.bricks * CDL_GRID_VALUES;
  pack->grid_table = pack_array(log, "grids", pack->grid_entries, sizeof *pack->grid_table);
  pack->grid_most = pack_array(log, "grids", pack->grid_most_count, sizeof *pack->grid_most);
  pack->grid_values = pack_array(log, "grids", pack->grid_value_count, sizeof *pack->grid_values);
  if (!pack->grid_table || !pack->grid_most || !pack->grid_values) return CDL_BAD_INPUT;
  for (uint32_t i = 0, number = 0; i < scene->grid_count; i++) {
    pack->grids[i].first_block += (uint32_t)room.entries;
    number = fill(&scene->grids[i], number, &pack->grids[i], pack);
  }
  return pack_blackbody(log, scene, pack);
}
