/* check_asset.c: versions, and extensions that a file cannot do without. */
#include <stdlib.h>
#include <string.h>

#include "scene/build.h"
#include "scene/check.h"

/* "major.minor", nothing else. */
static int parse_version(const char *text, unsigned long *major, unsigned long *minor) {
  size_t first = strspn(text, "0123456789");
  if (first == 0 || text[first] != '.') return 0;
  size_t second = strspn(text + first + 1, "0123456789");
  if (second == 0 || text[first + 1 + second] != 0) return 0;
  *major = strtoul(text, NULL, 10);
  *minor = strtoul(text + first + 1, NULL, 10);
  return 1;
}

static cdl_Status check_version(Document *doc) {
  static const char *const names[] = {"version", "minVersion"};
  const json_t *asset = json_object_get(doc->root, "asset");
  unsigned long v[2][2] = {{2, 0}, {2, 0}};
  for (int i = 0; i < 2; i++) {
    const char *text = json_get_string(asset, names[i], "2.0");
    if (!parse_version(text, &v[i][0], &v[i][1]))
      return document_fail(doc, AT("/asset/%s", names[i]), "PATTERN_MISMATCH",
                           "%.40s is not of the form 2.0.", text);
  }
  if (v[0][0] != 2)
    return document_fail(doc, "/asset/version", "UNKNOWN_ASSET_MAJOR_VERSION",
                         "glTF %lu is not supported; convert it to glTF 2.0.", v[0][0]);
  if (v[1][0] > v[0][0] || (v[1][0] == v[0][0] && v[1][1] > v[0][1]))
    return document_fail(doc, "/asset/minVersion", "ASSET_MIN_VERSION_GREATER_THAN_VERSION",
                         "it is greater than the version itself.");
  if (v[1][0] != 2 || v[1][1] > 0)
    return document_fail(doc, "/asset/minVersion", "UNKNOWN_ASSET_MINOR_VERSION",
                         "a reader of at least %lu.%lu is asked for; this reads 2.0.", v[1][0],
                         v[1][1]);
  if (v[0][1] > 0)
    document_note(doc, NULL, "/asset/version",
                  "UNKNOWN_ASSET_MINOR_VERSION: it is read as glTF 2.0.");
  return CDL_OK;
}

static int is_used(const Document *doc, const char *name) {
  const json_t *used = json_object_get(doc->root, "extensionsUsed");
  for (size_t i = 0; i < json_array_size(used); i++)
    if (strcmp(json_string_value(json_array_get(used, i)), name) == 0) return 1;
  return 0;
}

cdl_Status check_asset(Document *doc) {
  const json_t *required = json_object_get(doc->root, "extensionsRequired");
  for (size_t i = 0; i < json_array_size(required); i++) {
    cdl_ExtensionState state;
    const char *name = json_string_value(json_array_get(required, i));
    extension_state(name, &state);
    if (state == CDL_EXTENSION_UNSUPPORTED)
      return document_fail(doc, AT("/extensionsRequired/%zu", i), "UNSUPPORTED_EXTENSION",
                           "the scene cannot be shown without %.80s, which is not supported; "
                           "export it without.",
                           name);
    if (!is_used(doc, name))
      return document_fail(doc, AT("/extensionsRequired/%zu", i), "UNUSED_EXTENSION_REQUIRED",
                           "%.80s is not listed in extensionsUsed.", name);
  }
  return check_version(doc);
}
