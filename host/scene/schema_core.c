/* schema_core.c: the members of glTF 2.0's own objects (specification, chapter 5). */
#include "scene/schema_members.h"

static const unsigned component_types[] = {5120, 5121, 5122, 5123, 5125, 5126, ENDED};
static const unsigned index_types[] = {5121, 5123, 5125, ENDED};
static const unsigned modes[] = {0, 1, 2, 3, 4, 5, 6, ENDED};
static const unsigned targets[] = {34962, 34963, ENDED};
static const unsigned mag_filters[] = {9728, 9729, ENDED};
static const unsigned min_filters[] = {9728, 9729, 9984, 9985, 9986, 9987, ENDED};
static const unsigned wraps[] = {33071, 33648, 10497, ENDED};
static const char *const accessor_types[] = {"SCALAR", "VEC2", "VEC3", "VEC4",
                                             "MAT2",   "MAT3", "MAT4", NULL};
static const char *const alpha_modes[] = {"OPAQUE", "MASK", "BLEND", NULL};
static const char *const camera_types[] = {"perspective", "orthographic", NULL};
static const char *const interpolations[] = {"LINEAR", "STEP", "CUBICSPLINE", NULL};
static const char *const paths[] = {"translation", "rotation", "scale", "weights", "pointer", NULL};
static const char *const mime_types[] = {"image/jpeg", "image/png", "image/webp", "image/ktx2",
                                         NULL};

static const Member asset[] = {STRING("version", REQUIRED), STRING("minVersion", 0),
                               STRING("generator", 0), STRING("copyright", 0), END};
static SCHEMA(schema_asset, "asset", asset);

static const Member buffer[] = {NAME, STRING("uri", 0), INTEGER("byteLength", REQUIRED, 1, MOST),
                                END};
SCHEMA(schema_buffer, "buffer", buffer);

static const Member buffer_view[] = {NAME,
                                     INDEX("buffer", REQUIRED, "buffers"),
                                     INTEGER("byteOffset", 0, 0, MOST),
                                     INTEGER("byteLength", REQUIRED, 1, MOST),
                                     INTEGER("byteStride", 0, 4, 252),
                                     CODES("target", 0, targets),
                                     END};
SCHEMA(schema_buffer_view, "bufferView", buffer_view);

static const Member sparse_indices[] = {INDEX("bufferView", REQUIRED, "bufferViews"),
                                        INTEGER("byteOffset", 0, 0, MOST),
                                        CODES("componentType", REQUIRED, index_types), END};
static SCHEMA(schema_sparse_indices, "sparse indices", sparse_indices);

static const Member sparse_values[] = {INDEX("bufferView", REQUIRED, "bufferViews"),
                                       INTEGER("byteOffset", 0, 0, MOST), END};
static SCHEMA(schema_sparse_values, "sparse values", sparse_values);

static const Member sparse[] = {INTEGER("count", REQUIRED, 1, MOST),
                                OBJECT("indices", REQUIRED, &schema_sparse_indices),
                                OBJECT("values", REQUIRED, &schema_sparse_values), END};
static SCHEMA(schema_sparse, "sparse", sparse);

static const Member accessor[] = {NAME,
                                  INDEX("bufferView", 0, "bufferViews"),
                                  INTEGER("byteOffset", 0, 0, MOST),
                                  CODES("componentType", REQUIRED, component_types),
                                  FLAG("normalized"),
                                  INTEGER("count", REQUIRED, 1, MOST),
                                  CHOICE("type", REQUIRED | LISTED, accessor_types),
                                  NUMBERS("min", 0, 1, 16, -INFINITY, INFINITY),
                                  NUMBERS("max", 0, 1, 16, -INFINITY, INFINITY),
                                  OBJECT("sparse", 0, &schema_sparse),
                                  END};
static SCHEMA(schema_accessor, "accessor", accessor);

static const Member image[] = {NAME, STRING("uri", 0), CHOICE("mimeType", 0, mime_types),
                               INDEX("bufferView", 0, "bufferViews"), END};
SCHEMA(schema_image, "image", image);

static const Member sampler[] = {NAME,
                                 CODES("magFilter", 0, mag_filters),
                                 CODES("minFilter", 0, min_filters),
                                 CODES("wrapS", 0, wraps),
                                 CODES("wrapT", 0, wraps),
                                 END};
SCHEMA(schema_sampler, "sampler", sampler);

static const Member texture[] = {NAME, INDEX("sampler", 0, "samplers"),
                                 INDEX("source", 0, "images"), END};
SCHEMA(schema_texture, "texture", texture);

#define TEXTURE_INFO INDEX("index", REQUIRED, "textures"), INTEGER("texCoord", 0, 0, 1e6)
static const Member texture_info[] = {TEXTURE_INFO, END};
SCHEMA(schema_texture_info, "textureInfo", texture_info);

static const Member normal_info[] = {TEXTURE_INFO, ANY_NUMBER("scale", 0), END};
SCHEMA(schema_normal_info, "normalTextureInfo", normal_info);

static const Member occlusion_info[] = {TEXTURE_INFO, NUMBER("strength", 0, 0, 1), END};
SCHEMA(schema_occlusion_info, "occlusionTextureInfo", occlusion_info);

static const Member pbr[] = {NUMBERS("baseColorFactor", 0, 4, 4, 0, 1),
                             OBJECT("baseColorTexture", 0, &schema_texture_info),
                             NUMBER("metallicFactor", 0, 0, 1),
                             NUMBER("roughnessFactor", 0, 0, 1),
                             OBJECT("metallicRoughnessTexture", 0, &schema_texture_info),
                             END};
SCHEMA(schema_pbr, "pbrMetallicRoughness", pbr);

static const Member material[] = {NAME,
                                  OBJECT("pbrMetallicRoughness", 0, &schema_pbr),
                                  OBJECT("normalTexture", 0, &schema_normal_info),
                                  OBJECT("occlusionTexture", 0, &schema_occlusion_info),
                                  OBJECT("emissiveTexture", 0, &schema_texture_info),
                                  NUMBERS("emissiveFactor", 0, 3, 3, 0, 1),
                                  CHOICE("alphaMode", 0, alpha_modes),
                                  NUMBER("alphaCutoff", 0, 0, INFINITY),
                                  FLAG("doubleSided"),
                                  END};
SCHEMA(schema_material, "material", material);

static const Member perspective[] = {
    NUMBER("aspectRatio", ABOVE, 0, INFINITY), NUMBER("yfov", REQUIRED | ABOVE, 0, INFINITY),
    NUMBER("zfar", ABOVE, 0, INFINITY), NUMBER("znear", REQUIRED | ABOVE, 0, INFINITY), END};
static SCHEMA(schema_perspective, "perspective", perspective);

static const Member orthographic[] = {ANY_NUMBER("xmag", REQUIRED), ANY_NUMBER("ymag", REQUIRED),
                                      NUMBER("zfar", REQUIRED | ABOVE, 0, INFINITY),
                                      NUMBER("znear", REQUIRED, 0, INFINITY), END};
static SCHEMA(schema_orthographic, "orthographic", orthographic);

static const Member camera[] = {NAME, CHOICE("type", REQUIRED, camera_types),
                                OBJECT("perspective", 0, &schema_perspective),
                                OBJECT("orthographic", 0, &schema_orthographic), END};
SCHEMA(schema_camera, "camera", camera);

static const Member primitive[] = {INDEX_MAP("attributes", REQUIRED, "accessors"),
                                   INDEX("indices", 0, "accessors"),
                                   INDEX("material", 0, "materials"),
                                   CODES("mode", 0, modes),
                                   {.name = "targets",
                                    .type = MEMBER_INDEX_MAP,
                                    .flags = ARRAY,
                                    .shortest = 1,
                                    .target = "accessors"},
                                   END};
SCHEMA(schema_primitive, "primitive", primitive);

static const Member mesh[] = {NAME, OBJECTS("primitives", REQUIRED, &schema_primitive),
                              NUMBERS("weights", 0, 1, 0, -INFINITY, INFINITY), END};
SCHEMA(schema_mesh, "mesh", mesh);

static const Member node[] = {NAME,
                              INDEX("camera", 0, "cameras"),
                              INDICES("children", 0, "nodes"),
                              INDEX("skin", 0, "skins"),
                              NUMBERS("matrix", 0, 16, 16, -INFINITY, INFINITY),
                              INDEX("mesh", 0, "meshes"),
                              NUMBERS("rotation", 0, 4, 4, -1, 1),
                              NUMBERS("scale", 0, 3, 3, -INFINITY, INFINITY),
                              NUMBERS("translation", 0, 3, 3, -INFINITY, INFINITY),
                              NUMBERS("weights", 0, 1, 0, -INFINITY, INFINITY),
                              END};
SCHEMA(schema_node, "node", node);

static const Member scene[] = {NAME, INDICES("nodes", 0, "nodes"), END};
SCHEMA(schema_scene, "scene", scene);

static const Member skin[] = {NAME, INDEX("inverseBindMatrices", 0, "accessors"),
                              INDEX("skeleton", 0, "nodes"), INDICES("joints", REQUIRED, "nodes"),
                              END};
static SCHEMA(schema_skin, "skin", skin);

static const Member animation_target[] = {INDEX("node", 0, "nodes"),
                                          CHOICE("path", REQUIRED, paths), END};
SCHEMA(schema_animation_target, "animation target", animation_target);

static const Member channel[] = {INDEX("sampler", REQUIRED, NULL),
                                 OBJECT("target", REQUIRED, &schema_animation_target), END};
static SCHEMA(schema_channel, "animation channel", channel);

static const Member animation_sampler[] = {INDEX("input", REQUIRED, "accessors"),
                                           CHOICE("interpolation", LISTED, interpolations),
                                           INDEX("output", REQUIRED, "accessors"), END};
static SCHEMA(schema_animation_sampler, "animation sampler", animation_sampler);

static const Member animation[] = {NAME, OBJECTS("channels", REQUIRED, &schema_channel),
                                   OBJECTS("samplers", REQUIRED, &schema_animation_sampler), END};
static SCHEMA(schema_animation, "animation", animation);

static const Member root[] = {STRINGS("extensionsUsed", 0),
                              STRINGS("extensionsRequired", 0),
                              OBJECTS("accessors", 0, &schema_accessor),
                              OBJECTS("animations", 0, &schema_animation),
                              OBJECT("asset", REQUIRED, &schema_asset),
                              OBJECTS("buffers", 0, &schema_buffer),
                              OBJECTS("bufferViews", 0, &schema_buffer_view),
                              OBJECTS("cameras", 0, &schema_camera),
                              OBJECTS("images", 0, &schema_image),
                              OBJECTS("materials", 0, &schema_material),
                              OBJECTS("meshes", 0, &schema_mesh),
                              OBJECTS("nodes", 0, &schema_node),
                              OBJECTS("samplers", 0, &schema_sampler),
                              INDEX("scene", 0, "scenes"),
                              OBJECTS("scenes", 0, &schema_scene),
                              OBJECTS("skins", 0, &schema_skin),
                              OBJECTS("textures", 0, &schema_texture),
                              END};
SCHEMA(schema_root, "glTF", root);
