/* surface: geometry and base colour of every surface that was hit, for the kernels after it. */
#include "lib/stage.h"

#include "abi/params.h"
#include "lib/dimensions.h"
#include "lib/material.h"
#include "lib/state.h"
#include "lib/surface.h"

__kernel void surface(CDL_CONSTANT cdl_Params *restrict params,
                      CDL_CONSTANT cdl_Wave *restrict wave,
                      CDL_GLOBAL const cdl_BvhInstance *bvh_instances,
                      CDL_GLOBAL const cdl_Triangle *triangles, CDL_GLOBAL const cdl_Shape *shapes,
                      CDL_GLOBAL const float *attributes, CDL_GLOBAL const cdl_Material *materials,
                      CDL_GLOBAL const cdl_Texture *textures, CDL_GLOBAL const uint *texels,
                      CDL_GLOBAL const float *srgb, CDL_GLOBAL const uint *path,
                      CDL_GLOBAL uint *work) {
  CDL_FOR_EACH_ITEM(i) {
    size_t stride = wave->stride;
    uint triangle_index = state_uint(path, CDL_PATH_HIT_TRIANGLE, stride, i);
    uint instance_index = state_uint(path, CDL_PATH_HIT_INSTANCE, stride, i);
    float u = state_float(path, CDL_PATH_HIT_U, stride, i);
    float v = state_float(path, CDL_PATH_HIT_V, stride, i);
    vec3 wo = v3_neg(state_vec3(path, CDL_PATH_DIRECTION, stride, i));

    CDL_GLOBAL const cdl_Triangle *triangle = triangles + triangle_index;
    CDL_GLOBAL const cdl_Shape *shape = shapes + triangle->shape;
    uint material_index = shape->material;
    CDL_GLOBAL const cdl_Material *material = materials + material_index;
#ifdef CDL_MOTION
    MotionTime time = path_time(params, wave, state_uint(path, CDL_PATH_SLOT, stride, i));
#else
    (void)params;
#endif
    SurfacePoint point = surface_point(bvh_instances + instance_index, shape, attributes, triangle,
                                       u, v CDL_TIME(time));

    vec3 normal = point.normal;
    TextureCoords uv;
#ifdef CDL_TEXTURES
    uv = shape_texture_coords(shape, attributes, triangle, u, v);
    normal = material_normal(&material->normal_texture, material->normal_scale, point, uv, textures,
                             texels, srgb);
    uv = texture_coords_after(normal.x, uv);
#else
    uv.u0 = uv.v0 = uv.u1 = uv.v1 = uv.pad = 0.0f;
#endif
    Texel base =
        material_base(material, shape, attributes, triangle, u, v, uv, textures, texels, srgb);

    int front = v3_dot(point.geometric, wo) >= 0.0f;
    vec3 geometric = v3_select(front, point.geometric, v3_neg(point.geometric));
    normal = surface_face_path(v3_select(front, normal, v3_neg(normal)), wo);
    uint vertex = front ? CDL_VERTEX_FRONT : 0u;
    vertex |= material->model == CDL_MODEL_INTERFACE ? CDL_VERTEX_INTERFACE : 0u;
    vertex |= (point.handedness > 0.0f) == front ? 0u : CDL_VERTEX_MIRRORED;
    vertex |= material->flags << CDL_VERTEX_FLAGS;

    state_set_vec3(work, CDL_WORK_POSITION, stride, i, point.position);
    state_set_vec3(work, CDL_WORK_GEOMETRIC_NORMAL, stride, i, geometric);
    state_set_vec3(work, CDL_WORK_NORMAL, stride, i, normal);
    state_set_vec3(work, CDL_WORK_TANGENT, stride, i, frame_from_tangent(normal, point.tangent).x);
    state_set_uint(work, CDL_WORK_MATERIAL, stride, i, material_index);
    state_set_uint(work, CDL_WORK_MEDIUM, stride, i,
                   surface_medium(shape, bvh_instances + instance_index));
    state_set_vec3(work, CDL_WORK_BASE, stride, i, v3(base.r, base.g, base.b));
    state_set_uint(work, CDL_WORK_VERTEX, stride, i, vertex);
  }
}
