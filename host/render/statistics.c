#include "render/statistics.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>

#include "core/clock.h"

static const char *const schedules[] = {"auto", "wavefront", "fused"};

static json_t *device_json(const cdl_Session *session) {
  const cdl_DeviceInfo *info = device_info(session->device);
  return json_pack("{s:s, s:s, s:s, s:s, s:i}", "platform", info->platform, "name", info->name,
                   "driver", info->driver, "version", info->version, "compute_units",
                   (int)info->compute_units);
}

static json_t *settings_json(const cdl_Session *session) {
  const cdl_Settings *s = &session->settings;
  json_t *json = json_pack(
      "{s:i, s:i, s:i, s:i, s:i, s:[i,i,i,i], s:s, s:i, s:I, s:f, s:f, s:s, s:i, s:s}", "width",
      (int)s->width, "height", (int)s->height, "spp", (int)s->samples, "first_sample",
      (int)s->first_sample, "sample_count", (int)s->sample_count, "crop", (int)s->crop[0],
      (int)s->crop[1], (int)s->crop[2], (int)s->crop[3], "camera", session->camera, "max_depth",
      (int)s->max_depth, "seed", (json_int_t)s->seed, "time_limit_s", s->time_limit, "noise_target",
      s->noise_target, "schedule", schedules[s->schedule], "bvh_width", (int)s->bvh_width, "math",
      s->fast_math ? "fast" : "exact");
  json_t *aovs = json_array();
  for (unsigned i = 0; i < CDL_AOV_COUNT; i++)
    if (session->film->aovs & AOV_BIT(i))
      json_array_append_new(aovs, json_string(aov_table[i].name));
  json_object_set_new(json, "aovs", aovs);
  return json;
}

static json_t *times_json(const cdl_Session *session) {
  const cdl_RenderStats *s = &session->stats;
  const double wall = session->scene->load_s + clock_now() - session->start_s;
  return json_pack("{s:f, s:f, s:f, s:f, s:f, s:f, s:f, s:f}", "load_s", session->scene->load_s,
                   "bvh_s", s->bvh_s, "compile_s", s->compile_s, "upload_s", s->upload_s,
                   "render_s", s->render_s, "render_cpu_s", s->render_cpu_s, "write_s", s->write_s,
                   "wall_s", wall);
}

static json_int_t peak_rss_bytes(void) {
  struct rusage usage;
  getrusage(RUSAGE_SELF, &usage);
  return (json_int_t)usage.ru_maxrss * 1024;
}

json_t *statistics_of_session(const cdl_Session *session) {
  const cdl_RenderStats *s = &session->stats;
  json_t *json =
      json_pack("{s:s, s:s, s:s, s:o, s:o, s:I, s:I, s:I, s:s, s:o, s:I, s:{s:I, s:I, s:I}, "
                "s:{s:I, s:I}, s:I, s:I, "
                "s:I, s:b}",
                "version", CDL_VERSION, "scene", session->scene->path, "scene_sha256",
                session->scene->sha256, "device", device_json(session), "settings",
                settings_json(session), "triangles", (json_int_t)s->triangles, "instances",
                (json_int_t)s->instances, "lights", (json_int_t)s->lights, "bvh", s->bvh_line,
                "times", times_json(session), "paths", (json_int_t)s->paths, "rays", "camera",
                (json_int_t)s->rays_camera, "bounce", (json_int_t)s->rays_bounce, "shadow",
                (json_int_t)s->rays_shadow, "collisions", "real", (json_int_t)s->real_collisions,
                "null", (json_int_t)s->null_collisions, "bad_samples", (json_int_t)s->bad_samples,
                "device_peak_bytes", (json_int_t)device_peak_allocated(session->device),
                "peak_rss_bytes", peak_rss_bytes(), "interrupted", session->interrupted);
  json_t *kernels = session->profile ? profile_json(session->profile) : json_array();
  if (!json || json_object_set_new(json, "kernels", kernels) ||
      statistics_finish(json, session->film)) {
    json_decref(json);
    return NULL;
  }
  return json;
}

static double number(const json_t *object, const char *name) {
  return json_number_value(json_object_get(object, name));
}

cdl_Status statistics_finish(json_t *statistics, const cdl_Film *film) {
  uint32_t least, most;
  char digest[65];
  cdl_Status status = film_sha256(film, digest);
  if (status) return status;
  film_sample_range(film, &least, &most);
  const json_t *rays = json_object_get(statistics, "rays");
  const double traced = number(rays, "camera") + number(rays, "bounce") + number(rays, "shadow");
  const double seconds = number(json_object_get(statistics, "times"), "render_s");
  const double noise = film_noise(film);
  json_object_set_new(statistics, "mrays_per_s",
                      json_real(seconds > 0 ? 1e-6 * traced / seconds : 0));
  json_object_set_new(statistics, "samples",
                      json_pack("{s:i, s:i}", "least", (int)least, "most", (int)most));
  json_object_set_new(statistics, "noise", isfinite(noise) ? json_real(noise) : json_null());
  json_object_set_new(statistics, "film_sha256", json_string(digest));
  return CDL_OK;
}

static void sum_member(json_t *sum, const json_t *part, const char *name) {
  const json_t *a = json_object_get(sum, name), *b = json_object_get(part, name);
  if (json_is_integer(a) && json_is_integer(b))
    json_object_set_new(sum, name, json_integer(json_integer_value(a) + json_integer_value(b)));
  else if (json_is_number(a) && json_is_number(b))
    json_object_set_new(sum, name, json_real(json_number_value(a) + json_number_value(b)));
}

static void sum_members(json_t *sum, const json_t *part) {
  const char *name;
  json_t *value;
  json_object_foreach((json_t *)part, name, value) sum_member(sum, part, name);
}

static void set_number(json_t *object, const char *name, double value) {
  json_object_set_new(object, name, json_real(value));
}

static void add_kernel(json_t *sum, const json_t *part) {
  const double a = number(sum, "launches"), b = number(part, "launches");
  const double median =
      a + b > 0 ? (a * number(sum, "median_s") + b * number(part, "median_s")) / (a + b) : 0;
  set_number(sum, "min_s", fmin(number(sum, "min_s"), number(part, "min_s")));
  set_number(sum, "median_s", median);
  set_number(sum, "max_s", fmax(number(sum, "max_s"), number(part, "max_s")));
  set_number(sum, "first_s", fmax(number(sum, "first_s"), number(part, "first_s")));
  for (const char *const *name =
           (const char *const[]){"launches", "items", "total_s", "rays", NULL};
       *name; name++)
    sum_member(sum, part, *name);
  if (json_object_get(sum, "mrays_per_s") && number(sum, "total_s") > 0)
    set_number(sum, "mrays_per_s", 1e-6 * number(sum, "rays") / number(sum, "total_s"));
}

static void add_kernels(json_t *sum, const json_t *part) {
  size_t i, j;
  json_t *kernel, *known;
  json_array_foreach((json_t *)part, i, kernel) {
    int found = 0;
    json_array_foreach(sum, j, known) {
      if (!json_equal(json_object_get(known, "name"), json_object_get(kernel, "name"))) continue;
      add_kernel(known, kernel);
      found = 1;
    }
    if (!found) json_array_append_new(sum, json_deep_copy(kernel));
  }
}

void statistics_add(json_t *sum, const json_t *part) {
  const json_t *a = json_object_get(sum, "peak_rss_bytes");
  const json_t *b = json_object_get(part, "peak_rss_bytes");
  if (json_integer_value(b) > json_integer_value(a))
    json_object_set(sum, "peak_rss_bytes", (json_t *)b);
  sum_member(sum, part, "paths");
  sum_member(sum, part, "bad_samples");
  sum_members(json_object_get(sum, "times"), json_object_get(part, "times"));
  sum_members(json_object_get(sum, "rays"), json_object_get(part, "rays"));
  sum_members(json_object_get(sum, "collisions"), json_object_get(part, "collisions"));
  add_kernels(json_object_get(sum, "kernels"), json_object_get(part, "kernels"));
}
