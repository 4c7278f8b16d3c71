/* test_compressed_fuzz.c: streams with bytes changed, cut and put together at random. The decoders
 * end, in time, within the memory that they are allowed, and read nothing behind a stream: it lies
 * before a page that cannot be read. CDL_SOAK makes it fifty times as long. */
#include <meshoptimizer.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>

#include <cmocka.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <unistd.h>

#include "../unit/scene_text.h"
#include "core/clock.h"
#include "draco_encode.h"
#include "grid.h"
#include "meshopt_v1.h"
#include "scene/accessor.h"
#include "scene/compression.h"

enum { INPUTS = 12000, ROOM = 1 << 20, BUDGET = 32 << 20, STREAMS = 16, SMALL = 10 };

typedef struct Stream {
  uint8_t data[1 << 14];
  size_t size, count, stride;
  const char *mode, *filter;
  uint32_t ids[4];
} Stream;

static Stream streams[STREAMS];
static uint32_t stream_count;
static uint8_t *guarded; /* ROOM bytes, then a page without access */
static Grid grid;
static uint32_t faces[2 * (SMALL - 1) * (SMALL - 1)][3];
static uint64_t seed = 1;

/* PCG: O'Neill 2014. */
static uint32_t below(uint32_t n) {
  uint64_t old = seed;
  seed = old * 6364136223846793005u + 1442695040888963407u;
  uint32_t x = (uint32_t)(((old >> 18) ^ old) >> 27), r = (uint32_t)(old >> 59);
  return (x >> r | x << (-r & 31)) % n;
}

/* A changed stream, at the end of what can be read. */
static uint8_t *change(const Stream *from, size_t *size) {
  static uint8_t bytes[ROOM];
  uint32_t changes = below(8), how = below(16);
  *size = from->size;
  memcpy(bytes, from->data, *size);
  for (uint32_t i = 0; i < changes; i++) {
    /* Counts and methods stand at the beginning, tables at the end. */
    size_t at = below(3) ? below((uint32_t)*size) : below(40) % *size;
    if (below(4) == 0) at = *size - 1 - below(40) % *size;
    uint8_t *b = bytes + at;
    *b = below(3) == 0 ? *b ^ (uint8_t)(1u << below(8))
                       : (uint8_t)(below(2) ? below(256) : 0xffu >> below(9));
  }
  if (how == 0) *size = below((uint32_t)*size) + 1;
  if (how == 1) {
    const Stream *other = &streams[below(stream_count)];
    size_t at = below((uint32_t)(*size < other->size ? *size : other->size));
    memcpy(bytes + at, other->data + at, other->size - at);
    *size = other->size;
  }
  if (how == 2)
    for (size_t i = 11; i < *size; i++) bytes[i] = (uint8_t)below(256);
  return memcpy(guarded + ROOM - *size, bytes, *size);
}

static double slowest;
static int held, refused;

static void clear_counts(void) { slowest = held = refused = stream_count = 0; }

static void check_counts(const char *what) {
  struct rusage usage;
  getrusage(RUSAGE_SELF, &usage);
  print_message("%s: %d decoded, %d refused, the slowest in %.3f s, %ld MB at most\n", what, held,
                refused, slowest, usage.ru_maxrss / 1024);
  assert_true(held > 100 && refused > 100);
  assert_true(slowest < 5);
#if !defined(__SANITIZE_ADDRESS__) /* which keeps what is freed */
  assert_true(usage.ru_maxrss < 1 << 20);
#endif
}

static void count_one(int good, double start) {
  held += good;
  refused += !good;
  slowest = fmax(slowest, clock_now() - start);
}

static int inputs(void) { return getenv("CDL_SOAK") ? 50 * INPUTS : INPUTS; }

static void add_draco(int edgebreaker, int bits, int count) {
  DracoSource sources[4] = {{0, GL_FLOAT, 3, 0, bits, grid.positions, 0},
                            {1, GL_FLOAT, 3, 0, bits, grid.normals, 0},
                            {3, GL_FLOAT, 2, 0, bits, grid.uv, 0},
                            {2, GL_UNSIGNED_BYTE, 4, 1, 0, grid.colors, 0}};
  Stream *to = &streams[stream_count++];
  to->size =
      draco_encode((const uint32_t(*)[3])faces, sizeof faces / sizeof *faces, SMALL * SMALL,
                   sources, count, edgebreaker, stream_count % 4 == 0, to->data, sizeof to->data);
  assert_true(to->size > 0);
  for (int i = 0; i < 4; i++) to->ids[i] = sources[i].id;
}

static void decode_draco(const Stream *from) {
  size_t size;
  const uint8_t *data = change(from, &size);
  DracoAttribute attributes[2] = {{from->ids[0], GL_FLOAT, 3, NULL},
                                  {from->ids[below(4)], GL_FLOAT, 2 + below(3), NULL}};
  if (below(4) == 0) attributes[1].component = GL_BYTE + below(4);
  DracoMesh mesh = {.stream = data,
                    .size = size,
                    .points = below(8) ? SMALL * SMALL : below(1 << 24),
                    .most_faces = below(2) ? sizeof faces / sizeof *faces : 1u << 24,
                    .budget = BUDGET,
                    .index_component = GL_UNSIGNED_SHORT + 2 * below(2),
                    .attributes = attributes,
                    .attribute_count = 1 + below(2)};
  double start = clock_now();
  int good = draco_decode(&mesh);
  count_one(good, start);
  assert_true(good || *mesh.error);
  for (size_t i = 0; good && mesh.index_component == GL_UNSIGNED_INT && i < 3 * mesh.faces; i++)
    assert_true(read_unsigned(mesh.indices, GL_UNSIGNED_INT, i) < mesh.points);
  free(mesh.indices);
  free(attributes[0].data);
  free(attributes[1].data);
}

static void test_draco(void **state) {
  (void)state;
  clear_counts();
  for (uint32_t i = 0; i < SMALL - 1; i++)
    for (uint32_t k = 0; k < SMALL - 1; k++) {
      uint32_t a = i * SMALL + k, n = 2 * (i * (SMALL - 1) + k);
      const uint32_t both[2][3] = {{a, a + 1, a + SMALL}, {a + 1, a + SMALL + 1, a + SMALL}};
      memcpy(faces[n], both, sizeof both);
    }
  for (int i = 0; i < 16; i++) add_draco(i & 1, i & 2 ? 11 : 0, 1 + i / 4);
  for (int i = 0; i < inputs(); i++) decode_draco(&streams[below(stream_count)]);
  check_counts("Draco");
}

static Stream *new_stream(size_t count, size_t stride, const char *mode, const char *filter) {
  Stream *to = &streams[stream_count++];
  to->count = count, to->stride = stride, to->mode = mode, to->filter = filter;
  return to;
}

static void add_attributes(const void *data, size_t count, size_t stride, const char *filter) {
  Stream *to = new_stream(count, stride, "ATTRIBUTES", filter);
  to->size = meshopt_encodeVertexBuffer(to->data, sizeof to->data, data, count, stride);
}

static void add_bytes(const uint8_t *data, size_t size, size_t count, size_t stride) {
  Stream *to = new_stream(count, stride, "ATTRIBUTES", stride == 12 ? "EXPONENTIAL" : "COLOR");
  memcpy(to->data, data, size);
  to->size = size;
}

static void add_indices(size_t stride, int triangles) {
  const uint32_t *from = &grid.indices[0][0];
  Stream *to = new_stream(900, stride, triangles ? "TRIANGLES" : "INDICES", "NONE");
  to->size = triangles ? meshopt_encodeIndexBuffer(to->data, sizeof to->data, from, 900)
                       : meshopt_encodeIndexSequence(to->data, sizeof to->data, from, 900);
}

static void quiet(void *user, cdl_LogLevel level, const char *message) {
  (void)user, (void)level, (void)message;
}

/* A view of a document that has nothing else; counts are changed as well. */
static void decode_meshopt(const Stream *from) {
  size_t size, count = below(4) ? from->count : below(2) ? below(5000) + 1 : below(1u << 31);
  const uint8_t *data = change(from, &size);
  const cdl_Log log = {quiet, NULL};
  Bytes buffer = {data, size, NULL};
  BufferView view = {.length = count * from->stride};
  Document doc = {
      .log = &log, .path = "fuzz", .buffers = &buffer, .buffer_count = 1, .decode_left = BUDGET};
  json_t *json =
      json_pack("{s:{s:{s:f,s:f,s:f,s:f,s:s,s:s}}}", "extensions", "KHR_meshopt_compression",
                "buffer", 0.0, "byteLength", (double)size, "byteStride", (double)from->stride,
                "count", (double)count, "mode", from->mode, "filter", from->filter);
  double start = clock_now();
  cdl_Status status = meshopt_view(&doc, 0, json, &view);
  count_one(status == CDL_OK, start);
  for (size_t i = 0; status == CDL_OK && i < view.length; i += 997)
    assert_true(view.data[i] <= 255); /* read, so that the sanitizers look */
  json_decref(json);
  free(view.owned);
}

static void test_meshopt(void **state) {
  (void)state;
  clear_counts();
  meshopt_encodeIndexVersion(1);
  add_attributes(grid.positions, 300, 12, "NONE");
  add_attributes(grid.positions, 300, 12, "EXPONENTIAL");
  add_attributes(grid.colors, 300, 4, "OCTAHEDRAL");
  add_attributes(grid.tangents, 300, 8, "OCTAHEDRAL");
  add_attributes(grid.tangents, 100, 8, "QUATERNION");
  add_attributes(grid.tangents, 40, 256, "NONE");
  add_bytes(v1_floats, sizeof v1_floats, 300, 12);
  add_bytes(v1_shorts, sizeof v1_shorts, 100, 8);
  add_bytes(v1_bytes, sizeof v1_bytes, 40, 4);
  add_bytes(v1_words, sizeof v1_words, 64, 8);
  for (int i = 0; i < 4; i++) add_indices(i & 1 ? 2 : 4, i & 2);
  for (int i = 0; i < inputs(); i++) decode_meshopt(&streams[below(stream_count)]);
  check_counts("meshopt");
}

/* A file of both extensions: a mesh in a Draco stream, another in streams of meshoptimizer. */
static int make_file(char *text, size_t room, const Stream *draco, const Stream *indices,
                     const Stream *points) {
  uint8_t bytes[1 << 15];
  size_t at = draco->size, end = at + indices->size;
  memcpy(bytes, draco->data, at);
  memcpy(bytes + at, indices->data, indices->size);
  memcpy(bytes + end, points->data, points->size);
  scene_write("mesh.bin", bytes, end + points->size);
  return snprintf(
      text, room,
      "{\"asset\":{\"version\":\"2.0\"},\"extensionsUsed\":[\"KHR_draco_mesh_compression\","
      "\"KHR_meshopt_compression\"],\"scenes\":[{\"nodes\":[0]}],\"nodes\":[{\"mesh\":0}],"
      "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"indices\":1,\"mode\":4,"
      "\"extensions\":{\"KHR_draco_mesh_compression\":{\"bufferView\":0,\"attributes\":{"
      "\"POSITION\":0}}}},{\"attributes\":{\"POSITION\":3},\"indices\":2}]}],\"accessors\":["
      "{\"componentType\":5126,\"count\":%d,\"type\":\"VEC3\",\"min\":[0,0,0],"
      "\"max\":[1,1,1]},{\"componentType\":5123,\"count\":%zu,\"type\":\"SCALAR\"},"
      "{\"bufferView\":1,\"componentType\":5125,\"count\":900,\"type\":\"SCALAR\"},"
      "{\"bufferView\":2,\"componentType\":5126,\"count\":300,\"type\":\"VEC3\","
      "\"min\":[0,0,0],\"max\":[1,1,1]}],\"bufferViews\":[{\"buffer\":0,\"byteLength\":%zu},"
      "{\"buffer\":1,\"byteLength\":3600,\"extensions\":{\"KHR_meshopt_compression\":{"
      "\"buffer\":0,\"byteOffset\":%zu,\"byteLength\":%zu,\"byteStride\":4,\"count\":900,"
      "\"mode\":\"TRIANGLES\"}}},{\"buffer\":1,\"byteLength\":3600,\"extensions\":{"
      "\"KHR_meshopt_compression\":{\"buffer\":0,\"byteOffset\":%zu,\"byteLength\":%zu,"
      "\"byteStride\":12,\"count\":300,\"mode\":\"ATTRIBUTES\",\"filter\":\"EXPONENTIAL\"}}}],"
      "\"buffers\":[{\"uri\":\"mesh.bin\",\"byteLength\":%zu},{\"byteLength\":3600,"
      "\"extensions\":{\"KHR_meshopt_compression\":{\"fallback\":true}}}]}",
      SMALL * SMALL, sizeof faces / 4, draco->size, at, indices->size, end, points->size,
      end + points->size);
}

/* Numbers of the whole file changed: what the extensions declare, against what is there. */
static void test_files(void **state) {
  (void)state;
  char text[4096], changed[4096];
  uint8_t filtered[3600];
  static Stream filtered_points;
  Stream *points = &filtered_points;
  clear_counts();
  add_draco(1, 11, 1);
  add_indices(4, 1);
  meshopt_encodeFilterExp(filtered, 300, 12, 16, grid.positions[0]);
  points->size = meshopt_encodeVertexBuffer(points->data, sizeof points->data, filtered, 300, 12);
  int length = make_file(text, sizeof text, &streams[0], &streams[1], points);
  assert_true(length > 0 && length < (int)sizeof text);
  for (int i = 0; i < inputs() / 4; i++) {
    memcpy(changed, text, (size_t)length);
    for (uint32_t n = i ? 1 + below(3) : 0; n > 0; n--) {
      uint32_t at = below((uint32_t)length);
      while (changed[at] < '0' || changed[at] > '9') at = below((uint32_t)length);
      changed[at] = (char)('0' + below(10));
      if (below(4) == 0) changed[at + 1] = (char)('0' + below(10));
    }
    scene_write("fuzz.gltf", changed, (size_t)length);
    double start = clock_now();
    struct cdl_Scene *scene = scene_open("fuzz.gltf", -1);
    if (i == 0 && !scene) print_message("%s", scene_errors);
    assert_true(i || scene);
    assert_int_equal(scene_status, scene ? CDL_OK : CDL_BAD_INPUT);
    assert_int_equal(scene_error_count, scene ? 0 : 1);
    count_one(scene != NULL, start);
    scene_free(scene);
  }
  check_counts("files");
}

static int set_up(void **state) {
  size_t page = (size_t)sysconf(_SC_PAGESIZE);
  grid_make(&grid);
  if (scene_folder_make(state)) return -1;
  guarded = mmap(NULL, ROOM + page, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  return guarded == MAP_FAILED || mprotect(guarded + ROOM, page, PROT_NONE);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_draco), cmocka_unit_test(test_meshopt),
                                     cmocka_unit_test(test_files)};
  return cmocka_run_group_tests(tests, set_up, scene_folder_remove);
}
