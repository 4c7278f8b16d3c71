/* gltf.cpp: hands a checked document to tinygltf and catches all that it may throw.
 *
 * tinygltf gets the graph alone: nodes, meshes, cameras, skins. Buffers and images, and with them
 * every URI, are taken out before, so that it cannot open a file or decode a picture. */
#include "scene/gltf.h"

#include <new>
#include <string>

#include "core/log.h"

namespace {

bool no_file(const std::string &, void *) { return false; }

std::string same_path(const std::string &path, void *) { return path; }

bool no_read(std::vector<unsigned char> *, std::string *, const std::string &, void *) {
  return false;
}

bool no_write(std::string *, const std::string &, const std::vector<unsigned char> &, void *) {
  return false;
}

bool no_image(tinygltf::Image *, int, std::string *, std::string *, int, int, const unsigned char *,
              int, void *) {
  return true;
}

/* Numbers that are integers are written as such: tinygltf reads `1.0` as no index. Indices of
 * primitives stay behind, as it would look for their buffer views. */
json_t *with_integers(const json_t *value) {
  if (json_is_real(value)) {
    double x = json_real_value(value);
    if (x >= -0x1p53 && x <= 0x1p53 && x == (double)(json_int_t)x)
      return json_integer((json_int_t)x);
    return json_real(x);
  }
  if (json_is_array(value)) {
    json_t *copy = json_array();
    for (size_t i = 0; i < json_array_size(value); i++)
      json_array_append_new(copy, with_integers(json_array_get(value, i)));
    return copy;
  }
  if (!json_is_object(value)) return json_deep_copy(value);
  json_t *copy = json_object();
  const char *key;
  json_t *member;
  json_object_foreach(const_cast<json_t *>(value), key, member) {
    std::string name = key;
    if (name != "extras" && name != "extensions" && name != "indices")
      json_object_set_new(copy, key, with_integers(member));
  }
  return copy;
}

std::string graph_text(const json_t *root) {
  static const char *const kept[] = {"asset",  "scene",   "scenes", "nodes",
                                     "meshes", "cameras", "skins"};
  json_t *graph = json_object();
  for (const char *name : kept)
    if (json_t *value = json_object_get(root, name))
      json_object_set_new(graph, name, with_integers(value));
  char *dumped = json_dumps(graph, JSON_COMPACT | JSON_REAL_PRECISION(17));
  json_decref(graph);
  if (!dumped) throw std::bad_alloc();
  std::string text = dumped;
  free(dumped);
  return text;
}

tinygltf::Model parse(Builder *builder) {
  tinygltf::TinyGLTF loader;
  tinygltf::Model model;
  std::string error, warning, text = graph_text(builder->doc->root);
  loader.SetFsCallbacks({no_file, same_path, no_read, no_write, nullptr});
  loader.SetImageLoader(no_image, nullptr);
  if (!loader.LoadASCIIFromString(&model, &error, &warning, text.data(), (unsigned)text.size(), "",
                                  0))
    throw Failed{
        log_fail(builder->doc->log, CDL_BAD_INPUT, "%s: %s", builder->doc->path, error.c_str())};
  return model;
}

} // namespace

cdl_Status gltf_build(Builder *builder) {
  try {
    GltfScene(builder, parse(builder)).build();
    return CDL_OK;
  } catch (const Failed &failed) {
    return failed.status;
  } catch (const std::bad_alloc &) {
    return document_out_of_memory(builder->doc);
  } catch (const std::exception &exception) {
    return log_fail(builder->doc->log, CDL_BAD_INPUT, "%s: %s", builder->doc->path,
                    exception.what());
  } catch (...) {
    return log_fail(builder->doc->log, CDL_BAD_INPUT, "%s: reading it failed.", builder->doc->path);
  }
}
