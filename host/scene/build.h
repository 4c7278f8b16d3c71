/* build.h: a scene under construction from a checked document. */
#ifndef CANDELA_SCENE_BUILD_H
#define CANDELA_SCENE_BUILD_H

#include "scene/document.h"
#include "scene/matrix.h"
#include "scene/scene.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct Builder {
  Document *doc;
  struct cdl_Scene *scene;
  uint32_t variant;        /* of KHR_materials_variants, or CDL_NONE */
  int shapes_only;         /* what moves alone: no images, no environment */
  uint32_t *texture_map;   /* glTF texture -> scene texture, or CDL_NONE */
  uint32_t *image_map;     /* glTF image -> scene image, or CDL_NONE */
  uint32_t *image_sources; /* scene image -> glTF image, or CDL_NONE: not of glTF */
  uint32_t default_material;
} Builder;

/* Makes room for one more element in an array of `count`: zeroed, and *array moved where needed.
 * Returns the new element, or NULL when memory is short. */
void *array_push(void **array, uint32_t count, size_t size);

/* Copies a string; NULL becomes "". */
char *string_copy(const char *text);

/* Says of an extension how it fared; the worst of several calls stays. */
cdl_Status extension_mark(Builder *builder, const char *name, cdl_ExtensionState state);

/* What is generally done with an extension; 0 and `unsupported` when its name is not known. */
int extension_state(const char *name, cdl_ExtensionState *state);

/* Lists extensionsUsed, each with what is generally done with it. */
cdl_Status build_extensions(Builder *builder);

/* material.c: all of glTF's materials, in their order, with the textures and images they use. */
cdl_Status build_materials(Builder *builder);

/* The index of glTF's default material, which is made on first use; CDL_NONE: no memory. */
uint32_t build_default_material(Builder *builder);

/* material_cdl.c: CDL_material over what glTF's own material says. */
cdl_Status build_cdl_material(Builder *builder, uint32_t index, const json_t *json,
                              cdl_SceneMaterial *material);

/* material_khr.c: the extensions that add layers and lobes to glTF's material, over what the core
 * says. */
cdl_Status build_gltf_layers(Builder *builder, uint32_t index, const json_t *json,
                             cdl_SceneMaterial *material);

/* medium.c: CDL_medium, the inside of the CDL_material `subsurface`, and KHR_materials_volume with
 * KHR_materials_volume_scatter; *index is CDL_NONE for none. */
cdl_Status build_medium(Builder *builder, const char *pointer, const json_t *json, uint32_t *index);
cdl_Status build_subsurface_medium(Builder *builder, const json_t *json, uint32_t *index);

/* Lengthens the mean free paths of a subsurface material to those of isotropic scattering. */
void subsurface_stretch(const json_t *json, const float albedo[3], float radius[3]);
cdl_Status build_volume(Builder *builder, const json_t *volume, const json_t *scatter,
                        uint32_t *index);

/* phase.c: the member `phase` of the CDL_medium at `pointer`; NULL: isotropic. And the function of
 * one asymmetry, which counts as 0.99999 at most. */
cdl_Status build_phase(Builder *builder, const char *pointer, const json_t *json,
                       cdl_ScenePhase *phase);
cdl_ScenePhase phase_hg(double g);

/* medium_grid.c: the grids of a medium and where they lie, over what medium.c says; NULL: none. */
cdl_Status build_medium_grid(Builder *builder, const char *pointer, const json_t *json,
                             cdl_SceneMedium *medium);

/* texture.c: a textureInfo object, or none (NULL). */
cdl_Status build_texture_ref(Builder *builder, const char *pointer, const json_t *info,
                             cdl_TextureRef *ref);
cdl_TextureRef texture_ref_none(void);

/* Decodes every image in use. */
cdl_Status build_images(Builder *builder);

/* environment.c: CDL_environment and CDL_medium of a scene object. */
cdl_Status build_scene_extensions(Builder *builder, uint32_t index, const json_t *json);

/* light.c: a light of KHR_lights_punctual placed by a node. */
cdl_Status build_light(Builder *builder, uint32_t light, const Matrix *to_world);

/* gltf.cpp: nodes, meshes and cameras, read by tinygltf. */
cdl_Status gltf_build(Builder *builder);

/* tangent.c: fills mesh->tangents from positions, normals (where present) and uv[uv_set]. */
cdl_Status mesh_make_tangents(cdl_SceneMesh *mesh, uint32_t uv_set);

/* variant.c: the index of a variant; NULL is CDL_NONE. CDL_USAGE for an unknown name lists what
 * there is. */
cdl_Status variant_find(const Document *doc, const char *name, uint32_t *index);

/* Lists the names of the variants. */
cdl_Status build_variants(Builder *builder);

/* animation.c: lists the animations. */
cdl_Status build_animations(Builder *builder);

/* The material of a primitive in a variant; `otherwise` where the variant does not change it. */
uint32_t variant_material(const json_t *primitive, uint32_t variant, uint32_t otherwise);

/* metals.c: RGB eta and k of a named metal; 0 when it is not known. */
int metal_index(const char *name, float eta[3], float k[3]);

#ifdef __cplusplus
}
#endif
#endif
