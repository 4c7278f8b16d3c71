/* material_params.c: reads a model's own parameters, factor and texture, from tables. */
#include <string.h>

#include "scene/material_params.h"

static cdl_Status add_texture(Builder *builder, const char *at, const json_t *info,
                              const ParamMember *member, uint32_t first, uint32_t words,
                              cdl_SceneMaterial *material) {
  if (material->texture_count == CDL_PARAM_TEXTURES_MAX)
    return document_fail(builder->doc, at, "VALUE_NOT_IN_RANGE", "more than %d textures.",
                         (int)CDL_PARAM_TEXTURES_MAX);
  cdl_SceneParamTexture *texture = &material->textures[material->texture_count];
  *texture = (cdl_SceneParamTexture){.param = first,
                                     .words = words,
                                     .channel = member->channel,
                                     .is_color = member->channel == CHANNELS_COLOR};
  if (texture->is_color) texture->channel = 0;
  memcpy(texture->scale, material->param + first, words * sizeof(float));
  cdl_Status status = build_texture_ref(builder, at, info, &texture->texture);
  if (!status && texture->texture.texture != CDL_NONE) material->texture_count++;
  return status;
}

/* A colour's texture has a channel for each word; that of a number, or of a pair, one for all. */
static cdl_Status read_texture(Builder *builder, const char *at, const json_t *json,
                               const ParamMember *member, cdl_SceneMaterial *material) {
  const json_t *info = member->texture ? json_object_get(json, member->texture) : NULL;
  cdl_Status status = CDL_OK;
  if (!info) return CDL_OK;
  if (member->channel == CHANNELS_COLOR)
    return add_texture(builder, at, info, member, member->param, member->words, material);
  for (uint32_t k = 0; k < member->words && !status; k++)
    status = add_texture(builder, at, info, member, member->param + k, 1, material);
  return status;
}

cdl_Status build_params(Builder *builder, const char *at, const json_t *json,
                        const ParamMember *members, cdl_SceneMaterial *material) {
  cdl_Status status = CDL_OK;
  for (const ParamMember *m = members; m->name && !status; m++) {
    memcpy(material->param + m->param, m->value, m->words * sizeof(float));
    if (json) json_get_numbers(json, m->name, m->words, material->param + m->param);
    if (json) status = read_texture(builder, at, json, m, material);
  }
  return status;
}
