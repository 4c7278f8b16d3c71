/* pack.h: a scene laid out as the kernels read it.
 *
 * Meshes that stand in the scene once are baked into the world and share two trees, one of what
 * stops light and one of what light may pass straight through; meshes that stand there more often
 * keep their own tree and are placed by instances. Triangles are numbered shape by shape. */
#ifndef CANDELA_SCENE_PACK_H
#define CANDELA_SCENE_PACK_H

#include "abi/geometry.h"
#include "abi/grid.h"
#include "abi/light.h"
#include "abi/material.h"
#include "abi/medium.h"
#include "abi/params.h"
#include "abi/texture.h"
#include "bvh/bvh.h"
#include "scene/scene.h"

/* What a scene holds, so that kernels are built without what it does not. */
typedef struct cdl_PackFeatures {
  int textures, float_textures, emission_textures, vertex_colors;
  int passable; /* surfaces that light may pass straight through */
  int opacity;  /* holes and half transparent surfaces among them */
  int motion;   /* things or cameras move while the shutter is open */
  int media;    /* any medium that is not vacuum */
  int walks;    /* and inside of a subsurface material */
  int draine;   /* and with a phase function other than Henyey and Greenstein's */
  int grids;    /* and with a density that a grid gives */
  int triangle_lights, punctual_lights, environment;
  uint32_t gltf_layers; /* CDL_GLTF_LAYER_* */
  int dispersion;       /* glass that disperses */
  int energy_compensation;
  int normal_maps;
  int models[CDL_MODEL_COUNT]; /* 1: used; 2: and emissive */
} cdl_PackFeatures;

typedef struct cdl_Pack {
  cdl_Triangle *triangles;
  cdl_Shape *shapes;
  float *attributes;
  cdl_Material *materials;
  cdl_ParamTexture *param_textures; /* of all materials */
  cdl_Texture *textures;            /* two for each of the scene's: as data, and as colour */
  uint32_t *texels;
  float srgb[256]; /* linear value of each sRGB code */
  cdl_Light *lights;
  cdl_AliasEntry *light_table;
  float *environment; /* RGB and a pad for each texel */
  cdl_AliasEntry *environment_cells;
  cdl_Medium *media;
  uint32_t *instance_media; /* of each instance of the scene: what its closed surface holds */
  cdl_Grid *grids;
  uint32_t *grid_table;
  float *grid_most, *grid_values;
  float *blackbody;    /* abi/grid.h; zeros unless a grid gives a temperature */
  float *energy_table; /* bsdf/energy.h; NULL unless features.energy_compensation */
  size_t triangle_count, shape_count, attribute_count, material_count, param_texture_count,
      texture_count, texel_count, light_count, environment_count, cell_count, medium_count,
      grid_count, grid_entries, grid_most_count, grid_value_count, blackbody_count, energy_count;
  uint32_t scene_medium;
  uint32_t motion_keys;  /* times at which moving things are known; below 2: nothing moves */
  uint32_t camera_keys;  /* where in the attributes the cameras' matrices at those times begin */
  uint32_t *mesh_shapes; /* of each mesh of the trees that is placed by instances: its shape */
  cdl_EnvironmentParams environment_params;
  cdl_PackFeatures features;
  cdl_Bvh bvh;
} cdl_Pack;

/* Packs the scene and builds its trees. The scene is only read, and not needed afterwards. Too
 * large a scene, or too little memory, is CDL_BAD_INPUT. Free with pack_free(), also after a
 * failure. */
cdl_Status pack_scene(const cdl_Log *log, const cdl_Scene *scene, int bvh_width, cdl_Pack *pack);

/* Whether paths through the material go on with one colour channel each. */
int material_disperses(const cdl_Material *material);

/* Radius of the sphere around the world's bounds, m. */
double pack_scene_radius(const cdl_Pack *pack);

/* Frees and zeroes it; fine for an all-zero one. */
void pack_free(cdl_Pack *pack);

#endif
