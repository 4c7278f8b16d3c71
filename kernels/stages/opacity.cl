/* opacity: lets paths through holes and, by chance, through what is half transparent. */
#include "lib/stage.h"

#include "lib/dimensions.h"
#include "lib/material.h"
#include "lib/state.h"

__kernel void opacity(CDL_CONSTANT cdl_Params *restrict params,
                      CDL_CONSTANT cdl_Wave *restrict wave,
                      CDL_GLOBAL const cdl_Triangle *triangles, CDL_GLOBAL const cdl_Shape *shapes,
                      CDL_GLOBAL const float *attributes, CDL_GLOBAL const cdl_Material *materials,
                      CDL_GLOBAL const cdl_Texture *textures, CDL_GLOBAL const uint *texels,
                      CDL_GLOBAL const float *srgb, CDL_GLOBAL const uint *path,
                      CDL_GLOBAL uint *work) {
  CDL_FOR_EACH_ITEM(i) {
    size_t stride = wave->stride;
    uint queue = state_uint(work, CDL_WORK_QUEUE, stride, i);
    int on_surface = (queue >= CDL_QUEUE_MODELS) & (queue < CDL_QUEUE_MEDIUM);
    on_surface &= queue != CDL_QUEUE_EXIT;
    uint hit = state_uint(path, CDL_PATH_HIT_TRIANGLE, stride, i);
    CDL_GLOBAL const cdl_Triangle *triangle = triangles + (on_surface ? hit : 0u);
    CDL_GLOBAL const cdl_Shape *shape = shapes + triangle->shape;
    CDL_GLOBAL const cdl_Material *material = materials + shape->material;
    float u = state_float(path, CDL_PATH_HIT_U, stride, i);
    float v = state_float(path, CDL_PATH_HIT_V, stride, i);
    TextureCoords uv = shape_texture_coords(shape, attributes, triangle, u, v);
    Texel base =
        material_base(material, shape, attributes, triangle, u, v, uv, textures, texels, srgb);

    PathRandom random = path_random(params, wave, state_uint(path, CDL_PATH_SLOT, stride, i));
    uint counts = state_uint(path, CDL_PATH_COUNTS, stride, i);
    float chance, unused;
    vertex_random(random, counts_vertex(counts), CDL_PAIR_OPACITY, &chance, &unused);
    int through = on_surface & (chance >= material_opacity(material, base.a));
    state_set_uint(work, CDL_WORK_QUEUE, stride, i, through ? CDL_QUEUE_PASS : queue);
  }
}
