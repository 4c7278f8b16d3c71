/* bench_rays.c: ray queries of the kernels against Embree's single rays, in one process: the same
 * triangles, the same rays, the same number of threads, runs in turn, medians.
 *
 *   bench_rays [-d DEVICE] [-w WIDTH,…] [-n RAYS] [-r RUNS] [-s DETAIL]
 *
 * The scene is a hilly ground with 25 rough spheres, 1.6 million triangles at DETAIL 1. Camera rays
 * are in image order; diffuse bounces start where those hit, cosine-distributed; shadow rays go
 * from there to points of a square above. The last column counts rays on which both do not agree;
 * they graze edges, where Embree rounds differently. */
#include <embree3/rtcore.h>
#include <math.h>
#include <omp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "bvh/bvh.h"
#include "core/clock.h"
#include "device/buffer.h"
#include "device/program.h"
#include "device/queue.h"
#include "bench_rays_scene.h"

enum { RUNS_MAX = 99, KIND_CAMERA = 0, KIND_BOUNCE, KIND_SHADOW, KINDS };

static const char *const kind_names[KINDS] = {"camera", "bounce", "shadow"};

static const char kernel_text[] =
    "#include \"bvh/traverse.h\"\n"
    "__kernel void trace(__global const BvhNode *nodes, __global const BvhTriangle *triangles,\n"
    "                    __global const cdl_BvhInstance *instances, __global const float *rays,\n"
    "                    __global float *hits, uint root, uint n) {\n"
    "  uint i = get_global_id(0);\n"
    "  if (i >= n) return;\n"
    "  vec3 o = v3(rays[i], rays[i + n], rays[i + 2 * n]);\n"
    "  vec3 d = v3(rays[i + 3 * n], rays[i + 4 * n], rays[i + 5 * n]);\n"
    "#ifdef BENCH_ANY\n"
    "  hits[i] = bvh_occluded(nodes, triangles, instances, root, o, d, rays[i + 6 * n],\n"
    "                         CDL_MASK_ALL) ? -INFINITY : rays[i + 6 * n];\n"
    "#else\n"
    "  Hit hit = bvh_closest(nodes, triangles, instances, root, o, d, rays[i + 6 * n],\n"
    "                        CDL_MASK_ALL);\n"
    "  hits[i] = hit.t;\n"
    "  hits[i + n] = hit.u;\n"
    "  hits[i + 2 * n] = hit.v;\n"
    "  hits[i + 3 * n] = as_float(hit.primitive);\n"
    "#endif\n"
    "}\n";

/* Rays and distances as structure of arrays: o x y z, d x y z, tmax. */
typedef struct Rays {
  float *data, *hits;
  uint32_t count;
} Rays;

static void print_message(void *user, cdl_LogLevel level, const char *message) {
  (void)user;
  if (level == CDL_LOG_ERROR) fprintf(stderr, "bench_rays: %s\n", message);
}

static const cdl_Log log_to_stderr = {print_message, NULL};

static void need_ok(cdl_Status status) {
  if (status != CDL_OK) exit((int)status);
}

/* --- Rays */

static void set_ray(Rays *rays, uint32_t i, const float o[3], const float d[3], float tmax) {
  for (uint32_t k = 0; k < 3; k++) {
    rays->data[i + k * (size_t)rays->count] = o[k];
    rays->data[i + (k + 3) * (size_t)rays->count] = d[k];
  }
  rays->data[i + 6 * (size_t)rays->count] = tmax;
}

static Rays make_rays(uint32_t count) {
  return (Rays){need(7 * (size_t)count * 4), need(4 * (size_t)count * 4), count};
}

static void normalize(float v[3]) {
  float l = sqrtf(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
  for (int i = 0; i < 3; i++) v[i] /= l;
}

static void camera_ray(uint32_t i, uint32_t side, float o[3], float d[3]) {
  float x = ((float)(i % side) + random_of(2 * i)) / (float)side - 0.5f;
  float y = 0.5f - ((float)(i / side) + random_of(2 * i + 1)) / (float)side;
  const float eye[3] = {0.5f, 7.0f, 11.0f}, tilt = -0.55f;
  memcpy(o, eye, sizeof eye);
  d[0] = 1.1f * x;
  d[1] = 1.1f * y * cosf(tilt) + sinf(tilt);
  d[2] = 1.1f * y * sinf(tilt) - cosf(tilt);
  normalize(d);
}

static struct RTCRayHit embree_ray(const Rays *rays, uint32_t i) {
  const float *r = rays->data + i;
  size_t n = rays->count;
  struct RTCRayHit q;
  memset(&q, 0, sizeof q);
  q.ray = (struct RTCRay){.org_x = r[0],
                          .org_y = r[n],
                          .org_z = r[2 * n],
                          .dir_x = r[3 * n],
                          .dir_y = r[4 * n],
                          .dir_z = r[5 * n],
                          .tfar = r[6 * n],
                          .mask = ~0u};
  q.hit.geomID = q.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  return q;
}

/* From where a camera ray hits: a cosine-distributed direction, and a point of the light. Camera
 * rays that miss give rays that miss. */
static void secondary_rays(RTCScene scene, const Rays *camera, Rays *bounce, Rays *shadow) {
#pragma omp parallel for schedule(dynamic, 1024)
  for (uint32_t i = 0; i < camera->count; i++) {
    struct RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    struct RTCRayHit q = embree_ray(camera, i);
    rtcIntersect1(scene, &context, &q);
    float d[3] = {q.ray.dir_x, q.ray.dir_y, q.ray.dir_z}, up[3] = {0, 1, 0}, o[3], l[3], length;
    float n[3] = {q.hit.Ng_x, q.hit.Ng_y, q.hit.Ng_z};
    int hit = q.hit.geomID != RTC_INVALID_GEOMETRY_ID;
    if (!hit) memcpy(n, up, sizeof n);
    normalize(n);
    float side = n[0] * d[0] + n[1] * d[1] + n[2] * d[2] > 0.0f ? -1.0f : 1.0f;
    float z = 2.0f * random_of(3 * i) - 1.0f, phi = 6.2831853f * random_of(3 * i + 1);
    float s = sqrtf(fmaxf(0.0f, 1.0f - z * z)), sphere[3] = {s * cosf(phi), s * sinf(phi), z};
    float light[3] = {6.0f * random_of(5 * i) - 3.0f, 9.0f, 6.0f * random_of(5 * i + 1) - 3.0f};
    float t = hit ? q.ray.tfar : 100.0f, origin[3] = {q.ray.org_x, q.ray.org_y, q.ray.org_z};
    for (int k = 0; k < 3; k++) {
      o[k] = origin[k] + t * d[k] + 1e-4f * side * n[k];
      d[k] = side * n[k] + 0.999f * sphere[k];
      l[k] = light[k] - o[k];
    }
    normalize(d);
    length = sqrtf(l[0] * l[0] + l[1] * l[1] + l[2] * l[2]);
    normalize(l);
    set_ray(bounce, i, o, d, INFINITY);
    set_ray(shadow, i, o, l, length * 0.999f);
  }
}

/* --- The two contestants */

static ssize_t embree_bytes;

static bool count_memory(void *user, ssize_t bytes, bool post) {
  (void)user;
  (void)post;
  __atomic_add_fetch(&embree_bytes, bytes, __ATOMIC_RELAXED);
  return true;
}

static RTCScene embree_build(RTCDevice device, const Mesh *mesh, double *seconds) {
  double start = clock_now();
  rtcSetDeviceMemoryMonitorFunction(device, count_memory, NULL);
  RTCScene scene = rtcNewScene(device);
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
  rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                             mesh->positions, 0, 12, mesh->vertices);
  rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, mesh->indices, 0,
                             12, mesh->triangles);
  rtcSetSceneBuildQuality(scene, RTC_BUILD_QUALITY_HIGH);
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(scene, geometry);
  rtcReleaseGeometry(geometry);
  rtcCommitScene(scene);
  *seconds = clock_now() - start;
  return scene;
}

static double embree_run(RTCScene scene, Rays *rays, int any) {
  double start = clock_now();
#pragma omp parallel for schedule(dynamic, 1024)
  for (uint32_t i = 0; i < rays->count; i++) {
    struct RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    struct RTCRayHit q = embree_ray(rays, i);
    if (any)
      rtcOccluded1(scene, &context, &q.ray);
    else
      rtcIntersect1(scene, &context, &q);
    rays->hits[i] = q.ray.tfar;
    rays->hits[i + (size_t)rays->count] = q.hit.u;
    rays->hits[i + 2 * (size_t)rays->count] = q.hit.v;
    memcpy(rays->hits + i + 3 * (size_t)rays->count, &q.hit.primID, 4);
  }
  return clock_now() - start;
}

/* A tree on the device with its two kernels. */
typedef struct Traced {
  cdl_Device *device;
  cdl_Bvh bvh;
  cdl_Buffer nodes, triangles, instances;
  cl_kernel closest, any;
} Traced;

static void traced_open(Traced *traced, cdl_Device *device, const Mesh *mesh, int width) {
  cdl_BvhPart part = {mesh->positions, mesh->indices, mesh->triangles, 0, 0, 0};
  cdl_BvhMesh one = {&part, 1};
  cdl_BvhPlacement placement = {.to_world = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0},
                                .mask = CDL_MASK_ALL};
  cdl_BvhOptions options = {.width = width};
  char flags[64], line[512];
  traced->device = device;
  need_ok(bvh_build(&log_to_stderr, &one, 1, &placement, 1, &options, &traced->bvh));
  bvh_statistics_line(&traced->bvh.statistics, width, line, sizeof line);
  puts(line);
  cdl_Bvh *b = &traced->bvh;
  need_ok(buffer_wrap(device, "nodes", b->node_bytes, b->nodes, &traced->nodes));
  need_ok(buffer_wrap(device, "triangles", b->triangle_bytes, b->triangles, &traced->triangles));
  need_ok(buffer_wrap(device, "instances", b->instance_bytes, b->instances, &traced->instances));
  snprintf(flags, sizeof flags, "-DCDL_BVH_WIDTH=%d", width);
  need_ok(device_kernel_from_text(device, kernel_text, "trace", flags, &traced->closest));
  snprintf(flags, sizeof flags, "-DCDL_BVH_WIDTH=%d -DBENCH_ANY", width);
  need_ok(device_kernel_from_text(device, kernel_text, "trace", flags, &traced->any));
}

static void traced_close(Traced *traced) {
  clReleaseKernel(traced->closest);
  clReleaseKernel(traced->any);
  buffer_free(&traced->nodes);
  buffer_free(&traced->triangles);
  buffer_free(&traced->instances);
  bvh_free(&traced->bvh);
}

static double traced_run(Traced *traced, cdl_Buffer *rays, cdl_Buffer *hits, uint32_t count,
                         int any) {
  cl_kernel kernel = any ? traced->any : traced->closest;
  cl_mem buffers[5] = {traced->nodes.mem, traced->triangles.mem, traced->instances.mem, rays->mem,
                       hits->mem};
  for (cl_uint i = 0; i < 5; i++) clSetKernelArg(kernel, i, sizeof(cl_mem), buffers + i);
  clSetKernelArg(kernel, 5, 4, &traced->bvh.root);
  clSetKernelArg(kernel, 6, 4, &count);
  double start = clock_now();
  need_ok(device_run_kernel(traced->device, kernel, 0, count));
  need_ok(device_finish(traced->device));
  return clock_now() - start;
}

/* --- Comparison */

static uint32_t count_differences(const Rays *rays, const float *hits, int any) {
  uint32_t differ = 0;
  for (uint32_t i = 0; i < rays->count; i++) {
    float a = rays->hits[i], b = hits[i];
    differ += any ? a != b : !(a == b || fabsf(a - b) <= 1e-4f * fabsf(a));
  }
  return differ;
}

static int ascending(const void *a, const void *b) {
  double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

static double median(double *values, int count) {
  qsort(values, (size_t)count, sizeof *values, ascending);
  return values[count / 2];
}

static void compare(Traced *traced, RTCScene scene, Rays *rays, int kind, int runs) {
  double ours[RUNS_MAX], theirs[RUNS_MAX];
  cdl_Buffer data, hits;
  size_t n = rays->count;
  int any = kind == KIND_SHADOW;
  float *result = need(4 * n * 4);
  need_ok(buffer_create(traced->device, "rays", 7 * n * 4, rays->data, &data));
  need_ok(buffer_create(traced->device, "hits", 4 * n * 4, NULL, &hits));
  traced_run(traced, &data, &hits, rays->count, any);
  embree_run(scene, rays, any);
  for (int i = 0; i < runs; i++) {
    ours[i] = traced_run(traced, &data, &hits, rays->count, any);
    theirs[i] = embree_run(scene, rays, any);
  }
  need_ok(buffer_read(&hits, 0, n * 4, result));
  double a = (double)n * 1e-6 / median(ours, runs), b = (double)n * 1e-6 / median(theirs, runs);
  printf("BVH%d %-7s %8.2f Mray/s   Embree %8.2f Mray/s   ratio %5.2f   %u of %zu differ\n",
         traced->bvh.width, kind_names[kind], a, b, a / b, count_differences(rays, result, any), n);
  buffer_free(&data);
  buffer_free(&hits);
  free(result);
}

typedef struct Settings {
  const char *device, *widths;
  uint32_t side;
  int runs;
  float detail;
} Settings;

static Settings parse(int argc, char **argv) {
  Settings s = {NULL, "2,8", 1024, 5, 1.0f};
  for (int c; (c = getopt(argc, argv, "d:w:n:r:s:")) != -1;) {
    if (c == 'd')
      s.device = optarg;
    else if (c == 'w')
      s.widths = optarg;
    else if (c == 'n')
      s.side = (uint32_t)sqrt(atof(optarg));
    else if (c == 'r')
      s.runs = atoi(optarg);
    else if (c == 's')
      s.detail = (float)atof(optarg);
    else
      exit(2);
  }
  if (s.runs < 1 || s.runs > RUNS_MAX || s.side < 1 || !(s.detail > 0.0f)) die("bad argument");
  return s;
}

static void bench_widths(const Settings *s, const Mesh *mesh, RTCScene scene, Rays rays[KINDS]) {
  cdl_Device *device;
  need_ok(device_open(&log_to_stderr, s->device, &device));
  printf("%s, %u compute units; Embree with %d threads\n", device_info(device)->name,
         device_info(device)->compute_units, omp_get_max_threads());
  for (int width = 2; width <= 8; width += 6) {
    Traced traced;
    if (!strchr(s->widths, '0' + width)) continue;
    traced_open(&traced, device, mesh, width);
    for (int kind = 0; kind < KINDS; kind++) compare(&traced, scene, rays + kind, kind, s->runs);
    traced_close(&traced);
  }
  device_close(device);
}

int main(int argc, char **argv) {
  Settings s = parse(argc, argv);
  Mesh mesh = make_mesh(s.detail);
  Rays rays[KINDS];
  double seconds;
  RTCDevice embree = rtcNewDevice(NULL);
  RTCScene scene = embree_build(embree, &mesh, &seconds);
  printf("Embree: %u triangles, built in %.3f s, %.1f MiB (%.0f bytes a triangle, vertices and "
         "indices not counted)\n",
         mesh.triangles, seconds, (double)embree_bytes / 1048576.0,
         (double)embree_bytes / mesh.triangles);
  for (int kind = 0; kind < KINDS; kind++) rays[kind] = make_rays(s.side * s.side);
  for (uint32_t i = 0; i < s.side * s.side; i++) {
    float o[3], d[3];
    camera_ray(i, s.side, o, d);
    set_ray(&rays[KIND_CAMERA], i, o, d, INFINITY);
  }
  secondary_rays(scene, &rays[KIND_CAMERA], &rays[KIND_BOUNCE], &rays[KIND_SHADOW]);
  bench_widths(&s, &mesh, scene, rays);
  for (int kind = 0; kind < KINDS; kind++) {
    free(rays[kind].data);
    free(rays[kind].hits);
  }
  rtcReleaseScene(scene);
  rtcReleaseDevice(embree);
  free(mesh.positions);
  free(mesh.indices);
  return 0;
}
