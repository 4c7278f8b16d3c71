/* schema_extensions.c: the members of the extensions that are read, and where each may stand. An
 * extension that is not listed here is neither checked nor shown. */
#include "scene/schema_compression.h"
#include "scene/schema_members.h"

static const char *const light_types[] = {"point", "spot", "directional", NULL};
static const char *const models[] = {"diffuse",    "oren_nayar", "mirror",    "retroreflector",
                                     "conductor",  "dielectric", "plastic",   "disney",
                                     "subsurface", "hair",       "interface", NULL};
static const char *const distributions[] = {"ggx", "beckmann", NULL};
static const char *const maskings[] = {"correlated", "separable", NULL};
static const char *const phases[] = {"isotropic", "hg",       "two_term_hg", "rayleigh",
                                     "draine",    "droplets", NULL};
static const char *const methods[] = {"random_walk", "diffusion", "dipole", NULL};

static const Member nothing[] = {END};
static SCHEMA(schema_nothing, "extension", nothing);

#define INFO(n) OBJECT(n, 0, &schema_texture_info)
#define FACTOR(n) NUMBER(n, 0, 0, 1)

/* Light, KHR_lights_punctual */
static const Member spot[] = {NUMBER("innerConeAngle", 0, 0, M_PI_2),
                              NUMBER("outerConeAngle", ABOVE, 0, M_PI_2), END};
static SCHEMA(schema_spot, "spot", spot);
static const Member light[] = {NAME,
                               COLOUR("color", 0, 1),
                               NUMBER("intensity", 0, 0, INFINITY),
                               NUMBER("range", ABOVE, 0, INFINITY),
                               CHOICE("type", REQUIRED, light_types),
                               OBJECT("spot", 0, &schema_spot),
                               END};
SCHEMA(schema_light, "light", light);
static const Member lights[] = {OBJECTS("lights", REQUIRED, &schema_light), END};
static SCHEMA(schema_lights, "KHR_lights_punctual", lights);
static const Member node_light[] = {INDEX("light", REQUIRED, "lights"), END};
static SCHEMA(schema_node_light, "KHR_lights_punctual", node_light);

/* Materials */
static const Member anisotropy[] = {FACTOR("anisotropyStrength"),
                                    ANY_NUMBER("anisotropyRotation", 0), INFO("anisotropyTexture"),
                                    END};
static SCHEMA(schema_anisotropy, "KHR_materials_anisotropy", anisotropy);
static const Member clearcoat[] = {FACTOR("clearcoatFactor"),
                                   INFO("clearcoatTexture"),
                                   FACTOR("clearcoatRoughnessFactor"),
                                   INFO("clearcoatRoughnessTexture"),
                                   OBJECT("clearcoatNormalTexture", 0, &schema_normal_info),
                                   END};
static SCHEMA(schema_clearcoat, "KHR_materials_clearcoat", clearcoat);
static const Member dispersion[] = {NUMBER("dispersion", 0, 0, INFINITY), END};
static SCHEMA(schema_dispersion, "KHR_materials_dispersion", dispersion);
static const Member strength[] = {NUMBER("emissiveStrength", 0, 0, INFINITY), END};
static SCHEMA(schema_strength, "KHR_materials_emissive_strength", strength);
/* 0 stands for an infinite index; between 0 and 1 is out of range (check_materials). */
static const Member ior[] = {NUMBER("ior", 0, 0, INFINITY), END};
static SCHEMA(schema_ior, "KHR_materials_ior", ior);
static const Member iridescence[] = {FACTOR("iridescenceFactor"),
                                     INFO("iridescenceTexture"),
                                     NUMBER("iridescenceIor", 0, 1, INFINITY),
                                     NUMBER("iridescenceThicknessMinimum", 0, 0, INFINITY),
                                     NUMBER("iridescenceThicknessMaximum", 0, 0, INFINITY),
                                     INFO("iridescenceThicknessTexture"),
                                     END};
static SCHEMA(schema_iridescence, "KHR_materials_iridescence", iridescence);
static const Member sheen[] = {COLOUR("sheenColorFactor", 0, 1), INFO("sheenColorTexture"),
                               FACTOR("sheenRoughnessFactor"), INFO("sheenRoughnessTexture"), END};
static SCHEMA(schema_sheen, "KHR_materials_sheen", sheen);
static const Member specular[] = {FACTOR("specularFactor"), INFO("specularTexture"),
                                  COLOUR("specularColorFactor", 0, INFINITY),
                                  INFO("specularColorTexture"), END};
static SCHEMA(schema_specular, "KHR_materials_specular", specular);
static const Member transmission[] = {FACTOR("transmissionFactor"), INFO("transmissionTexture"),
                                      END};
static SCHEMA(schema_transmission, "KHR_materials_transmission", transmission);
static const Member diffuse_transmission[] = {
    FACTOR("diffuseTransmissionFactor"), INFO("diffuseTransmissionTexture"),
    COLOUR("diffuseTransmissionColorFactor", 0, 1), INFO("diffuseTransmissionColorTexture"), END};
static SCHEMA(schema_diffuse_transmission, "KHR_materials_diffuse_transmission",
              diffuse_transmission);
static const Member retroreflection[] = {FACTOR("retroreflectionFactor"),
                                         INFO("retroreflectionTexture"), END};
static SCHEMA(schema_retroreflection, "KHR_materials_retroreflection", retroreflection);
static const Member volume[] = {NUMBER("thicknessFactor", 0, 0, INFINITY), INFO("thicknessTexture"),
                                NUMBER("attenuationDistance", ABOVE, 0, INFINITY),
                                COLOUR("attenuationColor", 0, 1), END};
static SCHEMA(schema_volume, "KHR_materials_volume", volume);
static const Member volume_scatter[] = {COLOUR("multiscatterColor", 0, 1),
                                        COLOUR("multiscatterColorFactor", 0, 1),
                                        NUMBER("scatterAnisotropy", ABOVE, -1, 1), END};
static SCHEMA(schema_volume_scatter, "KHR_materials_volume_scatter", volume_scatter);
static const Member glossiness[] = {
    NUMBERS("diffuseFactor", 0, 4, 4, 0, 1), INFO("diffuseTexture"),
    COLOUR("specularFactor", 0, 1),          FACTOR("glossinessFactor"),
    INFO("specularGlossinessTexture"),       END};
static SCHEMA(schema_glossiness, "KHR_materials_pbrSpecularGlossiness", glossiness);

/* Variants */
static const Member variant[] = {STRING("name", REQUIRED), END};
static SCHEMA(schema_variant, "variant", variant);
static const Member variants[] = {OBJECTS("variants", REQUIRED, &schema_variant), END};
static SCHEMA(schema_variants, "KHR_materials_variants", variants);
static const Member mapping[] = {INDICES("variants", REQUIRED, "variants"),
                                 INDEX("material", REQUIRED, "materials"), NAME, END};
static SCHEMA(schema_mapping, "mapping", mapping);
static const Member mappings[] = {OBJECTS("mappings", REQUIRED, &schema_mapping), END};
static SCHEMA(schema_mappings, "KHR_materials_variants", mappings);

/* Textures, geometry, animation */
static const Member transform[] = {
    NUMBERS("offset", 0, 2, 2, -INFINITY, INFINITY), ANY_NUMBER("rotation", 0),
    NUMBERS("scale", 0, 2, 2, -INFINITY, INFINITY), INTEGER("texCoord", 0, 0, 1e6), END};
static SCHEMA(schema_transform, "KHR_texture_transform", transform);
static const Member source[] = {INDEX("source", 0, "images"), END};
static SCHEMA(schema_source, "texture source", source);
static const Member instancing[] = {INDEX_MAP("attributes", REQUIRED, "accessors"), END};
static SCHEMA(schema_instancing, "EXT_mesh_gpu_instancing", instancing);
static const Member pointer[] = {STRING("pointer", REQUIRED), END};
static SCHEMA(schema_pointer, "KHR_animation_pointer", pointer);
static const Member visibility[] = {FLAG("visible"), END};
static SCHEMA(schema_visibility, "KHR_node_visibility", visibility);

/* Our own: what they mean is said in the documentation of the scene format. */
#define SHADE(n) COLOUR(n, EITHER, 1), INFO(n "Texture")
#define SCALAR(n, lo, hi) NUMBER(n, 0, lo, hi), INFO(n "Texture")
static const Member cdl_material[] = {CHOICE("model", REQUIRED | LISTED, models),
                                      SHADE("reflectance"),
                                      SHADE("transmittance"),
                                      SHADE("baseColor"),
                                      SHADE("albedo"),
                                      SHADE("color"),
                                      SCALAR("roughness", 0, 1),
                                      NUMBERS("alpha", EITHER, 2, 2, 0, 1),
                                      INFO("alphaTexture"),
                                      CHOICE("distribution", LISTED, distributions),
                                      CHOICE("masking", LISTED, maskings),
                                      NUMBER("ior", ABOVE, 0, 100),
                                      INFO("iorTexture"),
                                      NUMBER("abbe", ABOVE | NULLABLE, 0, INFINITY),
                                      INFO("abbeTexture"),
                                      FLAG("thin"),
                                      FLAG("energyCompensation"),
                                      STRING("metal", 0),
                                      COLOUR("eta", EITHER, 1000),
                                      COLOUR("k", EITHER, 1000),
                                      SCALAR("metallic", 0, 1),
                                      SCALAR("anisotropic", 0, 1),
                                      SCALAR("specular", 0, 1),
                                      SCALAR("specularTint", 0, 1),
                                      SCALAR("sheen", 0, 1),
                                      SCALAR("sheenTint", 0, 1),
                                      SCALAR("clearcoat", 0, 1),
                                      SCALAR("clearcoatGloss", 0, 1),
                                      SCALAR("subsurface", 0, 1),
                                      SCALAR("specTrans", 0, 1),
                                      SCALAR("diffTrans", 0, 2),
                                      SCALAR("flatness", 0, 1),
                                      COLOUR("radius", EITHER, INFINITY),
                                      NUMBER("g", 0, -1, 1),
                                      CHOICE("method", LISTED, methods),
                                      COLOUR("sigmaA", EITHER, INFINITY),
                                      NUMBER("eumelanin", 0, 0, INFINITY),
                                      NUMBER("pheomelanin", 0, 0, INFINITY),
                                      SCALAR("betaM", 0, 1),
                                      SCALAR("betaN", 0, 1),
                                      ANY_NUMBER("alphaDegrees", 0),
                                      END};
static SCHEMA(schema_cdl_material, "CDL_material", cdl_material);

static const Member phase[] = {
    CHOICE("type", LISTED, phases),   NUMBERS("g", EITHER | ABOVE, 2, 2, -1, 1),
    NUMBER("weight", 0, 0, 1),        NUMBER("alpha", 0, 0, INFINITY),
    NUMBER("diameter", ABOVE, 0, 50), END};
static SCHEMA(schema_phase, "phase", phase);
static const Member grid[] = {STRING("uri", REQUIRED),
                              STRING("density", 0),
                              STRING("temperature", NULLABLE),
                              STRING("color", NULLABLE),
                              NUMBER("temperatureScale", 0, 0, INFINITY),
                              {.name = "bounds", .type = MEMBER_ANY},
                              END};
static SCHEMA(schema_grid, "grid", grid);
static const Member cdl_medium[] = {COLOUR("absorption", EITHER, INFINITY),
                                    COLOUR("scattering", EITHER, INFINITY),
                                    COLOUR("emission", EITHER, INFINITY),
                                    NUMBER("scale", 0, 0, INFINITY),
                                    OBJECT("phase", 0, &schema_phase),
                                    OBJECT("grid", 0, &schema_grid),
                                    END};
static SCHEMA(schema_cdl_medium, "CDL_medium", cdl_medium);

static const Member cdl_environment[] = {STRING("uri", 0), COLOUR("radiance", EITHER, INFINITY),
                                         NUMBER("strength", 0, 0, INFINITY),
                                         ANY_NUMBER("rotation", 0), END};
static SCHEMA(schema_cdl_environment, "CDL_environment", cdl_environment);

static const Member cdl_camera[] = {
    NUMBER("apertureRadius", 0, 0, INFINITY), NUMBER("focusDistance", ABOVE, 0, INFINITY),
    INTEGER("blades", 0, 0, 1000), NUMBERS("shutter", 0, 2, 2, -INFINITY, INFINITY), END};
static SCHEMA(schema_cdl_camera, "CDL_camera", cdl_camera);

const ExtensionPlace schema_extensions[] = {
    {"CDL_camera", &schema_camera, &schema_cdl_camera},
    {"CDL_environment", &schema_scene, &schema_cdl_environment},
    {"CDL_material", &schema_material, &schema_cdl_material},
    {"CDL_medium", &schema_material, &schema_cdl_medium},
    {"CDL_medium", &schema_scene, &schema_cdl_medium},
    {"EXT_mesh_gpu_instancing", &schema_node, &schema_instancing},
    {"EXT_meshopt_compression", &schema_buffer, &schema_meshopt_buffer},
    {"EXT_meshopt_compression", &schema_buffer_view, &schema_meshopt_view_ext},
    {"EXT_texture_webp", &schema_texture, &schema_source},
    {"KHR_animation_pointer", &schema_animation_target, &schema_pointer},
    {"KHR_draco_mesh_compression", &schema_primitive, &schema_draco},
    {"KHR_lights_punctual", &schema_node, &schema_node_light},
    {"KHR_lights_punctual", &schema_root, &schema_lights},
    {"KHR_materials_anisotropy", &schema_material, &schema_anisotropy},
    {"KHR_materials_clearcoat", &schema_material, &schema_clearcoat},
    {"KHR_materials_diffuse_transmission", &schema_material, &schema_diffuse_transmission},
    {"KHR_materials_dispersion", &schema_material, &schema_dispersion},
    {"KHR_materials_emissive_strength", &schema_material, &schema_strength},
    {"KHR_materials_ior", &schema_material, &schema_ior},
    {"KHR_materials_iridescence", &schema_material, &schema_iridescence},
    {"KHR_materials_pbrSpecularGlossiness", &schema_material, &schema_glossiness},
    {"KHR_materials_retroreflection", &schema_material, &schema_retroreflection},
    {"KHR_materials_sheen", &schema_material, &schema_sheen},
    {"KHR_materials_specular", &schema_material, &schema_specular},
    {"KHR_materials_transmission", &schema_material, &schema_transmission},
    {"KHR_materials_unlit", &schema_material, &schema_nothing},
    {"KHR_materials_variants", &schema_primitive, &schema_mappings},
    {"KHR_materials_variants", &schema_root, &schema_variants},
    {"KHR_materials_volume", &schema_material, &schema_volume},
    {"KHR_materials_volume_scatter", &schema_material, &schema_volume_scatter},
    {"KHR_meshopt_compression", &schema_buffer, &schema_meshopt_buffer},
    {"KHR_meshopt_compression", &schema_buffer_view, &schema_meshopt_view_khr},
    {"KHR_node_visibility", &schema_node, &schema_visibility},
    {"KHR_texture_basisu", &schema_texture, &schema_source},
    {"KHR_texture_transform", &schema_normal_info, &schema_transform},
    {"KHR_texture_transform", &schema_occlusion_info, &schema_transform},
    {"KHR_texture_transform", &schema_texture_info, &schema_transform},
    {NULL, NULL, NULL}};
