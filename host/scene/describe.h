/* describe.h: parts of what describe.c tells of a scene. */
#ifndef CANDELA_SCENE_DESCRIBE_H
#define CANDELA_SCENE_DESCRIBE_H

#include <jansson.h>
#include <stdio.h>

#include "scene/scene.h"

/* describe_grid.c: the grids of all media: where they are from, their sizes in voxels, the range of
 * their values, and what they take in memory. */
json_t *describe_grids(const cdl_Scene *scene);
void print_grids(FILE *out, const cdl_Scene *scene);
uint64_t grids_memory(const cdl_Scene *scene);

#endif
