/* path_fields.h: the state of a path, field by field; included by abi/path.h, which makes enums of
 * it. CDL_FIELD(set, name, words); every field is a structure of arrays of 4-byte words.
 *
 * PATH fields travel with the path when paths are sorted into queues. WORK fields belong to one
 * vertex and lie beside the PATH fields of the same index. SLOT fields stay where the path began.
 */

/* Ray: origin in m, direction of unit length. */
CDL_FIELD(PATH, ORIGIN, 3)
CDL_FIELD(PATH, DIRECTION, 3)
/* What radiance found along the ray counts for in the pixel, RGB, >= 0; all 0: the path is dead. */
CDL_FIELD(PATH, THROUGHPUT, 3)
/* Solid-angle density of the direction, 1/sr; 0: it could not have been chosen otherwise (camera,
 * delta lobe), so no light sampling competes with it. */
CDL_FIELD(PATH, PDF, 1)
/* Distance along the ray, in m, of the last surface that was passed straight through; 0: none. The
 * origin stays where it was, and HIT_TRIANGLE and HIT_INSTANCE name that surface until the next
 * hit. */
CDL_FIELD(PATH, PASSED, 1)
/* Slot, see cdl_Wave; slots from path_count on are trash cans for padding. */
CDL_FIELD(PATH, SLOT, 1)
/* Scattering events so far (low 16 bits) and vertices so far, passed surfaces included (high). */
CDL_FIELD(PATH, COUNTS, 1)
/* Media entered and not left, innermost first, 16 bits each: index + 1, 0 ends the list. */
CDL_FIELD(PATH, MEDIA, 2)
/* Hit: distance in m (infinite: none), barycentrics of corners 1 and 2, global triangle, instance.
 */
CDL_FIELD(PATH, HIT_T, 1)
CDL_FIELD(PATH, HIT_U, 1)
CDL_FIELD(PATH, HIT_V, 1)
CDL_FIELD(PATH, HIT_TRIANGLE, 1)
CDL_FIELD(PATH, HIT_INSTANCE, 1)

/* The queue that the path goes to next, CDL_QUEUE_*. */
CDL_FIELD(WORK, QUEUE, 1)
/* The vertex in the world, m. */
CDL_FIELD(WORK, POSITION, 3)
/* Geometric and shading normal, unit, both on the side that the path comes from. */
CDL_FIELD(WORK, GEOMETRIC_NORMAL, 3)
CDL_FIELD(WORK, NORMAL, 3)
/* Unit tangent, orthogonal to the shading normal. */
CDL_FIELD(WORK, TANGENT, 3)
/* Unit normal of a clear coat, on the side that the path comes from. */
CDL_FIELD(WORK, COAT_NORMAL, 3)
/* Material: index, the medium behind its surface, base colour, and the parameters of its model
 * (abi/param_fields.h), textures applied. */
CDL_FIELD(WORK, MATERIAL, 1)
CDL_FIELD(WORK, MEDIUM, 1)
CDL_FIELD(WORK, BASE, 3)
CDL_FIELD(WORK, PARAM, CDL_PARAM_MAX)
/* Bits: CDL_VERTEX_*. */
CDL_FIELD(WORK, VERTEX, 1)
/* A point on a light as seen from here: unit direction, distance in m (infinite: environment),
 * radiance over probability, and density in 1/sr (0: delta light). */
CDL_FIELD(WORK, LIGHT_DIRECTION, 3)
CDL_FIELD(WORK, LIGHT_DISTANCE, 1)
CDL_FIELD(WORK, LIGHT_WEIGHT, 3)
CDL_FIELD(WORK, LIGHT_PDF, 1)
/* What the light adds to the pixel if nothing is in between; 0: no shadow ray. */
CDL_FIELD(WORK, SHADOW_ORIGIN, 3)
/* Media that the shadow ray begins in, as PATH_MEDIA. */
CDL_FIELD(WORK, SHADOW_MEDIA, 2)
CDL_FIELD(WORK, SHADOW_RADIANCE, 3)
/* 1 if a shadow ray is traced for this vertex, else 0. */
CDL_FIELD(WORK, SHADOW_COUNT, 1)

/* Radiance of the sample, RGB. */
CDL_FIELD(SLOT, RADIANCE, 3)
/* Of the first surface, for AOVs: colour, shading normal, distance from the camera plane in m,
 * position in m, emitted radiance, glTF node and material + 1 (0: none), as whole floats. */
CDL_FIELD(SLOT, ALBEDO, 3)
CDL_FIELD(SLOT, AOV_NORMAL, 3)
CDL_FIELD(SLOT, DEPTH, 1)
CDL_FIELD(SLOT, AOV_POSITION, 3)
CDL_FIELD(SLOT, AOV_EMISSION, 3)
CDL_FIELD(SLOT, OBJECT, 1)
CDL_FIELD(SLOT, MATERIAL_ID, 1)
