/* scene.h: the host's model of a scene, as loaded and before anything is packed for a device.
 *
 * Units and conventions: metres, seconds, right-handed, +Y up; linear RGB with Rec. 709 primaries;
 * textures are kept as stored and decoded where they are looked up. Matrices are 3x4, row-major,
 * the last column the translation. Indices refer to the arrays of cdl_Scene; CDL_NONE means none.
 * Every array belongs to the scene and is freed by scene_free(). */
#ifndef CANDELA_SCENE_SCENE_H
#define CANDELA_SCENE_SCENE_H

#include <stdint.h>

#include "abi/material.h"
#include "abi/texture.h"
#include "candela.h"
#include "image/image.h"
#include "scene/grid.h"

#ifdef __cplusplus
extern "C" {
#endif

/* An image with a sampler. Two textures may share an image. */
typedef struct cdl_SceneTexture {
  uint32_t image;
  uint32_t wrap_s, wrap_t; /* CDL_WRAP_* */
  int nearest;             /* nearest texel instead of bilinear */
} cdl_SceneTexture;

/* glTF's textureInfo: which texture, which coordinates, and KHR_texture_transform as a 2x3 matrix,
 * row-major: (u', v') = M (u, v, 1). */
typedef struct cdl_TextureRef {
  uint32_t texture; /* CDL_NONE: no texture, the factor alone */
  uint32_t uv_set;  /* 0 or 1 */
  float transform[6];
} cdl_TextureRef;

/* Bits of scene_gltf_layers(). */
enum {
  CDL_GLTF_LAYER_ANISOTROPY = 1,
  CDL_GLTF_LAYER_CLEARCOAT = 2,
  CDL_GLTF_LAYER_SHEEN = 4,
  CDL_GLTF_LAYER_IRIDESCENCE = 8,
  CDL_GLTF_LAYER_TRANSMISSION = 16,
  CDL_GLTF_LAYER_DIFFUSE_TRANSMISSION = 32,
  CDL_GLTF_LAYER_RETROREFLECTION = 64,
  CDL_GLTF_LAYER_DISPERSION = 128
};

typedef enum cdl_AlphaMode { CDL_ALPHA_OPAQUE, CDL_ALPHA_MASK, CDL_ALPHA_BLEND } cdl_AlphaMode;
typedef enum cdl_Distribution { CDL_GGX, CDL_BECKMANN } cdl_Distribution;
typedef enum cdl_Masking { CDL_MASKING_CORRELATED, CDL_MASKING_SEPARABLE } cdl_Masking;

/* A texture over words of a parameter: each is offset + scale x its channel. */
typedef struct cdl_SceneParamTexture {
  cdl_TextureRef texture;
  uint32_t param, words; /* first of cdl_SceneMaterial.param, and how many; 3 at the most */
  uint32_t channel;      /* of the first word, 0: red */
  float offset, scale[3];
  int is_color; /* decoded from sRGB */
} cdl_SceneParamTexture;

enum { CDL_PARAM_TEXTURES_MAX = 24 };

typedef struct cdl_SceneMaterial {
  char *name;     /* never NULL, may be empty */
  uint32_t model; /* CDL_MODEL_* */
  int double_sided;
  cdl_AlphaMode alpha_mode;
  float alpha_cutoff;
  float base[4];              /* base colour, reflectance or transmittance, and opacity */
  float param[CDL_PARAM_MAX]; /* the model's own parameters, abi/param_fields.h */
  cdl_SceneParamTexture textures[CDL_PARAM_TEXTURES_MAX]; /* over these */
  uint32_t texture_count;
  cdl_Distribution distribution;
  cdl_Masking masking;
  int thin;                /* a sheet, which holds no medium */
  int energy_compensation; /* light is not lost between microfacets */
  int transmits;           /* paths can go through it by scattering */
  int dipole;              /* the profile of a subsurface model */
  int anisotropic;         /* looks different along its tangents */
  float normal_scale, coat_normal_scale;
  float emission[3]; /* factor x strength, radiance */
  uint32_t medium;   /* what fills a closed surface of this material: index, or CDL_NONE: nothing */
  cdl_TextureRef base_texture, normal_texture, coat_normal_texture, emission_texture;
} cdl_SceneMaterial;

/* One glTF primitive: indexed triangles of one material. Absent attributes are NULL; normals that
 * the file leaves out are absent (flat shading, as glTF prescribes). */
typedef struct cdl_SceneMesh {
  uint32_t vertex_count, triangle_count;
  uint32_t material; /* index; the default material of glTF has an entry of its own if used */
  float *positions;  /* 3 a vertex */
  float *normals;    /* 3 a vertex, unit or zero */
  float *tangents;   /* 4 a vertex: unit tangent, handedness +-1 */
  float *uv[2];      /* 2 a vertex */
  float *colors;     /* 4 a vertex, linear RGB and opacity */
  uint32_t *indices; /* 3 a triangle, each < vertex_count */
  char *name;
} cdl_SceneMesh;

/* A mesh placed in the world. `object` numbers the glTF node (or node and GPU instance). */
typedef struct cdl_SceneInstance {
  uint32_t mesh, object;
  float to_world[12];
} cdl_SceneInstance;

typedef enum cdl_PunctualType {
  CDL_PUNCTUAL_POINT,
  CDL_PUNCTUAL_SPOT,
  CDL_PUNCTUAL_DIRECTIONAL
} cdl_PunctualType;

/* KHR_lights_punctual, placed. Light leaves along `direction`. */
typedef struct cdl_SceneLight {
  cdl_PunctualType type;
  float position[3], direction[3]; /* direction is unit */
  float intensity[3];              /* W/sr (point, spot) or W/m2 (directional), colour included */
  float range;                     /* m; 0: unlimited */
  float inner_cone, outer_cone;    /* radians, spot only */
  char *name;
} cdl_SceneLight;

typedef struct cdl_SceneCamera {
  char *name;
  int orthographic;
  float to_world[12];                    /* looks along -Z, +Y up */
  float yfov;                            /* radians */
  float xmag, ymag;                      /* half width and height, m, orthographic only */
  float aspect;                          /* width over height; 0: free */
  float aperture_radius, focus_distance; /* m; radius 0: pinhole */
  uint32_t blades;                       /* 0: round */
  float shutter[2];                      /* s */
} cdl_SceneCamera;

/* A phase function: a mixture of two lobes of Draine's (media/phase.h). */
typedef struct cdl_ScenePhase {
  float g[2];       /* asymmetry, (-1,1) */
  float alpha[2];   /* [0, 1e6]; 0: Henyey and Greenstein's */
  float second;     /* weight of the second lobe, [0,1] */
  const char *type; /* its name in the file; static */
} cdl_ScenePhase;

typedef struct cdl_SceneMedium {
  float absorption[3], scattering[3]; /* 1/m, scale included */
  float emission[3];                  /* radiance per metre */
  cdl_ScenePhase phase;
  uint32_t density;        /* grid that multiplies absorption and scattering, or CDL_NONE */
  uint32_t temperature;    /* grid whose value times temperature_scale is kelvin, or CDL_NONE */
  uint32_t color;          /* grid of 3 channels that multiplies the scattering, or CDL_NONE */
  float temperature_scale; /* K */
  int walk; /* 1: the inside of a subsurface material, whose collisions belong to one event */
  double to_index[12]; /* from the space of the node that holds the surface, or of the world for the
                          scene's medium, to the index space that all its grids share */
} cdl_SceneMedium;

typedef struct cdl_SceneEnvironment {
  int present;       /* 0: none given */
  int assumed;       /* 1: not of the file: the scene has no light */
  uint32_t image;    /* CDL_NONE: constant radiance */
  float radiance[3]; /* of the constant one; 1 otherwise */
  float strength;
  float rotation; /* degrees about +Y, counter-clockwise seen from above */
} cdl_SceneEnvironment;

typedef enum cdl_ExtensionState {
  CDL_EXTENSION_USED,
  CDL_EXTENSION_IGNORED, /* has no effect on light, or none that this renderer shows */
  CDL_EXTENSION_UNSUPPORTED
} cdl_ExtensionState;

typedef struct cdl_SceneExtension {
  char *name;
  cdl_ExtensionState state;
} cdl_SceneExtension;

/* An animation that the file has, whether it is shown or not. */
typedef struct cdl_SceneAnimation {
  char *name;        /* never NULL, may be empty */
  double begin, end; /* of its keys, s */
  uint32_t channels;
} cdl_SceneAnimation;

struct cdl_Scene {
  char *path;
  cdl_SceneMesh *meshes;
  cdl_SceneInstance *instances;
  cdl_SceneMaterial *materials;
  cdl_SceneTexture *textures;
  cdl_Image **images;
  char **image_names;
  cdl_SceneLight *lights;
  cdl_SceneCamera *cameras; /* at least one: a framing camera where the file has none */
  cdl_SceneMedium *media;
  cdl_SceneGrid *grids;
  cdl_SceneExtension *extensions;
  /* The same scene at later times of the exposure, evenly spaced up to its end, alike but for where
   * vertices, instances and cameras are; only those count. The scene itself is as it begins. */
  struct cdl_Scene **later;
  uint32_t later_count;
  char **object_names;
  cdl_SceneAnimation *animations;
  char **variants; /* names of KHR_materials_variants */
  uint32_t mesh_count, instance_count, material_count, texture_count, image_count, light_count,
      camera_count, medium_count, grid_count, extension_count, object_count, animation_count,
      variant_count;
  uint32_t medium; /* what fills the rest of the scene: index or CDL_NONE */
  cdl_SceneEnvironment environment;
  float bounds[2][3]; /* of all instances in the world; min > max when there are none */
  char sha256[65];    /* of the file and all that it refers to, hexadecimal */
  double load_s;      /* wall seconds that loading took */
};

/* Loads a .gltf or .glb with all it refers to. Files outside the scene's folder are refused. A
 * damaged file is CDL_BAD_INPUT with one line that names file, JSON pointer and the Khronos
 * validator's code; an unknown animation or variant is CDL_USAGE; what is only odd is noted. NULL
 * options are the pose at rest. *scene is set on success alone; free it with scene_free(). */
cdl_Status scene_load(const cdl_Log *log, const char *path, const cdl_SceneOptions *options,
                      struct cdl_Scene **scene);

/* Frees a scene and all it holds; NULL is nothing. */
void scene_free(struct cdl_Scene *scene);

/* The name of a CDL_MODEL_*, as in scenes. */
const char *scene_model_name(uint32_t model);

/* Words of cdl_SceneMaterial.param that a CDL_MODEL_* uses. */
uint32_t scene_model_params(uint32_t model);

/* Which layers (CDL_GLTF_LAYER_*) a material of the model GLTF_LAYERED has. */
uint32_t scene_gltf_layers(const cdl_SceneMaterial *material);

/* The framing camera for a scene's bounds: from front-right and above, all in view. */
void scene_frame_camera(const float bounds[2][3], cdl_SceneCamera *camera);

#ifdef __cplusplus
}
#endif
#endif
