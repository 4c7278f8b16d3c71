/* pack_parts.h: the steps of pack_scene(), in order. Each fills its part of the pack. */
#ifndef CANDELA_SCENE_PACK_PARTS_H
#define CANDELA_SCENE_PACK_PARTS_H

#include "scene/pack.h"

/* Where an instance puts a point of its mesh, and whether it mirrors it. In double: what is baked
 * and what is worked out from a light's corners must agree. */
void pack_point(const float to_world[12], const float *point, float out[3]);
int pack_mirrors(const float to_world[12]);

/* calloc that reports; NULL means failure. A count of 0 gives one zeroed element, so that kernels
 * have something to point at. */
void *pack_array(const cdl_Log *log, const char *what, size_t count, size_t size);

cdl_Status pack_textures(const cdl_Log *log, const cdl_Scene *scene, cdl_Pack *pack);
cdl_Status pack_materials(const cdl_Log *log, const cdl_Scene *scene, cdl_Pack *pack);

/* The tables of bsdf/energy.h that the packed materials look things up in; none if none does. */
cdl_Status pack_energy(const cdl_Log *log, cdl_Pack *pack);

/* The parts of them for one kind of facets, energy_kind(), in `all` of ENERGY_KINDS x
 * ENERGY_KIND_WORDS floats. */
void pack_energy_metal(uint32_t kind, float *all);
void pack_energy_glass(uint32_t kind, float *all);

/* Also says what each instance holds: a grid makes another medium of every node it is placed by. */
cdl_Status pack_media(const cdl_Log *log, const cdl_Scene *scene, cdl_Pack *pack);
cdl_Status pack_grids(const cdl_Log *log, const cdl_Scene *scene, cdl_Pack *pack);

/* Also numbers the lights of emissive shapes and builds the trees. */
cdl_Status pack_geometry(const cdl_Log *log, const cdl_Scene *scene, int bvh_width, cdl_Pack *pack);

/* `power` is what a flat receiver the size of the scene gets of it, for choosing among lights. */
cdl_Status pack_environment(const cdl_Log *log, const cdl_Scene *scene, cdl_Pack *pack,
                            double *power);
cdl_Status pack_lights(const cdl_Log *log, const cdl_Scene *scene, double environment_power,
                       cdl_Pack *pack);

#endif
