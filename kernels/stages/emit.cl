/* emit: paths that reached an emissive surface add its radiance, weighed against light sampling. */
#include "lib/stage.h"

#include "abi/bvh.h"
#include "abi/params.h"
#include "bsdf/clearcoat.h"
#include "lib/material.h"
#include "lib/state.h"
#include "light/triangle.h"

__kernel void emit(CDL_CONSTANT cdl_Wave *restrict wave,
                   CDL_GLOBAL const cdl_BvhInstance *bvh_instances,
                   CDL_GLOBAL const cdl_Triangle *triangles, CDL_GLOBAL const cdl_Shape *shapes,
                   CDL_GLOBAL const float *attributes, CDL_GLOBAL const cdl_Material *materials,
                   CDL_GLOBAL const cdl_Texture *textures, CDL_GLOBAL const uint *texels,
                   CDL_GLOBAL const float *srgb, CDL_GLOBAL const cdl_Light *lights,
                   CDL_GLOBAL const uint *path, CDL_GLOBAL const uint *work,
                   CDL_GLOBAL uint *slots) {
  CDL_FOR_EACH_ITEM(i) {
    size_t stride = wave->stride;
    uint triangle_index = state_uint(path, CDL_PATH_HIT_TRIANGLE, stride, i);
    uint instance_index = state_uint(path, CDL_PATH_HIT_INSTANCE, stride, i);
    CDL_GLOBAL const cdl_Triangle *triangle = triangles + triangle_index;
    CDL_GLOBAL const cdl_Shape *shape = shapes + triangle->shape;
    CDL_GLOBAL const cdl_Material *material = materials + shape->material;
    TextureCoords uv;
    uv.u0 = uv.v0 = uv.u1 = uv.v1 = uv.pad = 0.0f;
#ifdef CDL_EMISSION_TEXTURES
    uv = shape_texture_coords(shape, attributes, triangle,
                              state_float(path, CDL_PATH_HIT_U, stride, i),
                              state_float(path, CDL_PATH_HIT_V, stride, i));
#endif
    vec3 radiance = material_emission(material, uv, textures, texels, srgb);
#ifdef CDL_GLTF_CLEARCOAT
    float coat = state_float(work, CDL_WORK_PARAM + CDL_GLTF_LAYERED_CLEARCOAT, stride, i);
    vec3 coat_normal = state_vec3(work, CDL_WORK_COAT_NORMAL, stride, i);
    float coat_cosine = v3_dot(coat_normal, state_vec3(path, CDL_PATH_DIRECTION, stride, i));
    float passes = 1.0f - clearcoat_fresnel(coat, coat_cosine);
    radiance = v3_scale(radiance, material->model == CDL_MODEL_GLTF_LAYERED ? passes : 1.0f);
#endif
    uint front = state_uint(work, CDL_WORK_VERTEX, stride, i) & CDL_VERTEX_FRONT;
    int lit = (front | (material->flags & CDL_MATERIAL_DOUBLE_SIDED)) != 0u;

    uint instance_light = bvh_instances[instance_index].first_light;
    uint first_light = shape->first_light != CDL_NONE ? shape->first_light : instance_light;
    uint light =
        first_light != CDL_NONE ? first_light + triangle_index - shape->first_triangle : 0u;
    vec3 direction = state_vec3(path, CDL_PATH_DIRECTION, stride, i);
    vec3 normal = state_vec3(work, CDL_WORK_GEOMETRIC_NORMAL, stride, i);
    float distance = state_float(path, CDL_PATH_HIT_T, stride, i);
    float light_pdf = light_triangle_pdf(lights + light, distance, v3_dot(normal, direction));
    light_pdf = first_light != CDL_NONE ? light_pdf : 0.0f;
    float pdf = state_float(path, CDL_PATH_PDF, stride, i);
    float weight = mis_power_or_alone(pdf, light_pdf);

    vec3 throughput = state_vec3(path, CDL_PATH_THROUGHPUT, stride, i);
    vec3 add = v3_scale(v3_mul(throughput, radiance), lit ? weight : 0.0f);
    state_add_radiance(slots, wave->slots, state_uint(path, CDL_PATH_SLOT, stride, i), add);
  }
}
