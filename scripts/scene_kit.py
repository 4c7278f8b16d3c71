"""What make_scenes.py builds its scenes from: vectors, shapes, pictures and a glTF document.

A shape is a dict: "position" and "index" (triangles, counter-clockwise from the front) and, where
it has them, "normal", "uv", "uv1" and "color", all lists of tuples. Metres, +Y up.
"""
import base64
import json
import math
import struct
import zlib

# ---- Vectors and turns


def add(a, b):
    return tuple(x + y for x, y in zip(a, b))


def sub(a, b):
    return tuple(x - y for x, y in zip(a, b))


def times(a, s):
    return tuple(x * s for x in a)


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def unit(a):
    return times(a, 1 / math.sqrt(sum(x * x for x in a)))


def turn(axis, degrees):
    """A rotation as a quaternion x, y, z, w."""
    half = math.radians(degrees) / 2
    return [*times(unit(axis), math.sin(half)), math.cos(half)]


def looking(eye, target):
    """The matrix, by columns, of a camera or light at `eye` that looks at `target`."""
    z = unit(sub(eye, target))
    x = unit(cross((0, 1, 0) if abs(z[1]) < 0.999 else (0, 0, -1), z))
    return [*x, 0, *cross(z, x), 0, *z, 0, *eye, 1]


# ---- Shapes


def lattice(columns, rows, point, index=None):
    """A grid of (columns + 1) x (rows + 1) points, point(u, v) with u and v in 0 … 1. Quads that
    have shrunk to a line at a pole give one triangle or none."""
    shape = {"position": [], "index": []}
    for r in range(rows + 1):
        for c in range(columns + 1):
            for key, value in point(c / columns, r / rows).items():
                shape.setdefault(key, []).append(value)
    p = shape["position"]
    for r in range(rows):
        for c in range(columns):
            a = r * (columns + 1) + c
            b, d = a + 1, a + columns + 1
            for t in ((a, d, d + 1), (a, d + 1, b)):
                if len({p[k] for k in t}) == 3:
                    shape["index"].append(t)
    return shape


def circle(u):
    """Cosine and sine of u turns; bitwise equal at 0 and 1, so that seams close."""
    angle = 2 * math.pi * (u % 1)
    return math.cos(angle), math.sin(angle)


def lathe(profile, columns=96):
    """Turns a profile about +Y: (radius, height, normal radius, normal height), downwards."""

    def point(u, v):
        r, y, nr, ny = profile[round(v * (len(profile) - 1))]
        c, s = circle(u)
        return {"position": (r * c, y, -r * s), "normal": (nr * c, ny, -nr * s)}

    return lattice(columns, len(profile) - 1, point)


def sphere(columns=80, rows=40):
    """Radius 1; u runs about +Y, v from the top down. Its normals are its positions."""

    def ring(v):
        return (1e-9 < v < 1 - 1e-9) * math.sin(math.pi * v)

    def point(u, v):
        c, s = circle(u)
        return {"position": (ring(v) * c, math.cos(math.pi * v), -ring(v) * s), "uv": (u, v)}

    shape = lattice(columns, rows, point)
    shape["normal"] = shape["position"]
    return shape


def rounded_cylinder(radius, height, bevel, columns=80):
    """From y = 0 up, with a quarter circle for its upper rim; open below."""
    rim = []
    for k in range(7):
        c, s = math.cos(math.pi / 12 * k), math.sin(math.pi / 12 * k)
        rim.append((radius - bevel + bevel * s, height - bevel + bevel * c, s, c))
    return lathe([(0, height, 0, 1), *rim, (radius, 0, 1, 0)], columns)


def torus(ring, tube, columns=96, rows=32):
    def point(u, v):
        (c, s), (d, t) = circle(u), circle(v)
        return {"position": ((ring + tube * d) * c, tube * t, -(ring + tube * d) * s),
                "normal": (d * c, t, -d * s)}

    return flipped(lattice(columns, rows, point))


def flipped(shape):
    return dict(shape, index=[(a, c, b) for a, b, c in shape["index"]])


def quad(corner, right, up, uv=((0, 1), (1, 0))):
    """A rectangle from its lower left corner, seen from the front; uv of that and the opposite."""
    (u0, v0), (u1, v1) = uv
    return {"position": [corner, add(corner, right), add(add(corner, right), up), add(corner, up)],
            "normal": [unit(cross(right, up))] * 4,
            "uv": [(u0, v0), (u1, v0), (u1, v1), (u0, v1)],
            "index": [(0, 1, 2), (0, 2, 3)]}


def merged(*shapes):
    whole = {"position": [], "index": []}
    for shape in shapes:
        first = len(whole["position"])
        whole["index"] += [tuple(first + k for k in t) for t in shape["index"]]
        for key, values in shape.items():
            if key != "index":
                whole.setdefault(key, [])
                whole[key] = whole[key] + list(values)
    return whole


def box(low, high):
    (a, b, c), (d, e, f) = low, high
    x, y, z = (d - a, 0, 0), (0, e - b, 0), (0, 0, f - c)
    return merged(quad((a, b, f), x, y), quad((d, b, c), times(x, -1), y),
                  quad((d, b, f), times(z, -1), y), quad((a, b, c), z, y),
                  quad((a, e, f), x, times(z, -1)), quad((a, b, c), x, z))


def check_sides(shape):
    """Normals and the order of corners must agree on which side is the front."""
    p, n = shape["position"], shape.get("normal")
    for a, b, c in shape["index"] if n else ():
        face = cross(sub(p[b], p[a]), sub(p[c], p[a]))
        if sum(x * y for x, y in zip(face, add(add(n[a], n[b]), n[c]))) < 0:
            raise ValueError("a triangle's corners and normals disagree")


# ---- Pictures


def png(width, height, pixel):
    """A PNG of pixel(x, y), 3 or 4 values in 0 … 1 that are stored as they are."""
    rows, channels = bytearray(), len(pixel(0, 0))
    for y in range(height):
        rows.append(0)
        for x in range(width):
            rows += bytes(round(255 * min(max(c, 0), 1)) for c in pixel(x, y))

    def chunk(kind, data):
        body = kind + data
        return struct.pack(">I", len(data)) + body + struct.pack(">I", zlib.crc32(body))

    header = struct.pack(">IIBBBBB", width, height, 8, 2 if channels == 3 else 6, 0, 0, 0)
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) +
            chunk(b"IDAT", zlib.compress(bytes(rows), 9)) + chunk(b"IEND", b""))


def encoded(linear):
    """Colours as sRGB has them in pictures."""
    return tuple(12.92 * c if c < 0.0031308 else 1.055 * c ** (1 / 2.4) - 0.055 for c in linear)


def radiance_hdr(width, height, radiance):
    """A Radiance picture of radiance(x, y): three mantissas and their exponent for each pixel."""
    data = bytearray()
    for y in range(height):
        for x in range(width):
            rgb = radiance(x, y)
            exponent = math.frexp(max(*rgb, 1e-9))[1]
            data += bytes([*(int(256 * math.ldexp(c, -exponent)) for c in rgb), exponent + 128])
    head = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y %d +X %d\n" % (height, width)
    return head.encode() + bytes(data)


def mixed(a, b, t):
    return tuple(x + (y - x) * t for x, y in zip(a, b))


# ---- The document

FLOAT, USHORT, UINT = 5126, 5123, 5125
CLAMP, MIRROR, REPEAT = 33071, 33648, 10497
NEAREST = 9728
ATTRIBUTES = (("position", "POSITION"), ("normal", "NORMAL"), ("uv", "TEXCOORD_0"),
              ("uv1", "TEXCOORD_1"), ("color", "COLOR_0"))




def data_uri(data, kind):
    return "data:%s;base64,%s" % (kind, base64.b64encode(data).decode())


class Document:
    """A glTF document in the making. Methods add an entry and return its index."""

    def __init__(self, about):
        self.blob, self.accessors_of, self.used = bytearray(), {}, set()
        self.gltf = {"asset": {"version": "2.0", "generator": "make_scenes.py",
                               "extras": {"exercises": about}},
                     "scene": 0, "scenes": [{"nodes": []}]}

    def entry(self, kind, value):
        self.gltf.setdefault(kind, []).append(value)
        return len(self.gltf[kind]) - 1

    def extend(self, owner, name, value):
        self.used.add(name)
        owner.setdefault("extensions", {})[name] = value
        return owner

    def accessor(self, values, component, kind, limits=False):
        key = id(values), component
        if key in self.accessors_of:
            return self.accessors_of[key][0]
        numbers = [x for row in values for x in row]
        code = {FLOAT: "f", USHORT: "H", UINT: "I"}[component]
        data = struct.pack("<%d%s" % (len(numbers), code), *numbers)
        self.blob += b"\0" * (-len(self.blob) % 4)
        view = self.entry("bufferViews", {"buffer": 0, "byteOffset": len(self.blob),
                                          "byteLength": len(data)})
        self.blob += data
        count = len(numbers) // {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4}[kind]
        found = {"bufferView": view, "componentType": component, "count": count, "type": kind}
        if limits:
            stored = [struct.unpack("<3f", struct.pack("<3f", *r)) for r in values]
            found["min"], found["max"] = [list(map(f, zip(*stored))) for f in (min, max)]
        index = self.entry("accessors", found)
        self.accessors_of[key] = index, values  # keeps the list, so that its id stays its own
        return index

    def primitive(self, shape, material):
        check_sides(shape)
        attributes = {}
        for key, name in ATTRIBUTES:
            if key in shape:
                kind = "VEC%d" % len(shape[key][0])
                attributes[name] = self.accessor(shape[key], FLOAT, kind, key == "position")
        component = USHORT if len(shape["position"]) < 65536 else UINT
        return {"attributes": attributes, "material": material,
                "indices": self.accessor(shape["index"], component, "SCALAR")}

    def mesh(self, shape, material):
        return self.entry("meshes", {"primitives": [self.primitive(shape, material)]})

    def node(self, at=None, size=None, turned=None, root=True, **members):
        if at is not None:
            members["translation"] = list(at)
        if size is not None:
            members["scale"] = [size] * 3 if isinstance(size, (int, float)) else list(size)
        if turned is not None:
            members["rotation"] = turned
        index = self.entry("nodes", members)
        if root:
            self.gltf["scenes"][0]["nodes"].append(index)
        return index

    def put(self, shape, material, **placed):
        return self.node(mesh=self.mesh(shape, material), **placed)

    def texture(self, picture, wrap=REPEAT, **sampling):
        image = self.entry("images", {"uri": data_uri(picture, "image/png")})
        sampler = self.entry("samplers", {"wrapS": wrap, "wrapT": wrap, **sampling})
        return self.entry("textures", {"source": image, "sampler": sampler})

    def textured(self, texture, transform=None, **members):
        """A textureInfo."""
        info = {"index": texture, **members}
        return self.extend(info, "KHR_texture_transform", transform) if transform else info

    def material(self, name, color=(0.8, 0.8, 0.8), metallic=0.0, roughness=1.0, pbr=(),
                 model=None, medium=None, glow=None, **members):
        """glTF's own material; `model` is a CDL_material, `medium` a CDL_medium, `glow` the
        radiance that it emits."""
        material = {"name": name, **members}
        material["pbrMetallicRoughness"] = {
            "baseColorFactor": [*color, 1][:4], "metallicFactor": metallic,
            "roughnessFactor": roughness, **dict(pbr)}
        if glow:
            strength = max(*glow, 1)
            material["emissiveFactor"] = list(times(glow, 1 / strength))
            self.extend(material, "KHR_materials_emissive_strength",
                        {"emissiveStrength": strength})
        for name, value in (("CDL_material", model), ("CDL_medium", medium)):
            if value:
                self.extend(material, name, value)
        return self.entry("materials", material)

    def light(self, kind, color, intensity, matrix=None, at=None, **members):
        lights = self.gltf.setdefault("extensions", {}).setdefault("KHR_lights_punctual",
                                                                   {"lights": []})["lights"]
        lights.append({"type": kind, "color": list(color), "intensity": intensity, **members})
        placed = {"matrix": matrix} if matrix else {"at": at}
        index = self.node(**placed)
        self.extend(self.gltf["nodes"][index], "KHR_lights_punctual", {"light": len(lights) - 1})
        self.used.add("KHR_lights_punctual")

    def panel_light(self, eye, target, width, height, radiance):
        """A rectangle that glows towards `target`."""
        material = self.material("light", (0, 0, 0), glow=radiance)
        shape = flipped(quad((-width / 2, -height / 2, 0), (width, 0, 0), (0, height, 0)))
        shape["normal"] = [(0, 0, -1)] * 4
        self.node(mesh=self.mesh(shape, material), matrix=looking(eye, target))

    def camera(self, eye, target, yfov, aspect=16 / 9, lens=None):
        camera = {"type": "perspective", "perspective": {
            "yfov": math.radians(yfov), "aspectRatio": aspect, "znear": 0.01}}
        if lens:
            self.extend(camera, "CDL_camera", lens)
        self.node(camera=self.entry("cameras", camera), matrix=looking(eye, target))

    def flat_camera(self, eye, target, width, height):
        """An orthographic one that sees width x height metres."""
        camera = {"type": "orthographic", "orthographic": {
            "xmag": width / 2, "ymag": height / 2, "znear": 0.01, "zfar": 1000}}
        self.node(camera=self.entry("cameras", camera), matrix=looking(eye, target))

    def scene(self, name, value):
        self.extend(self.gltf["scenes"][0], name, value)

    def write(self, path):
        uri = data_uri(self.blob, "application/octet-stream")
        self.gltf["buffers"] = [{"byteLength": len(self.blob), "uri": uri}]
        self.gltf["extensionsUsed"] = sorted(self.used)
        text = json.dumps(rounded(self.gltf), separators=(",", ":"))
        with open(path, "w") as file:
            file.write(text + "\n")
        return len(text) + 1


def rounded(value):
    """Numbers as the nearest single would print them: nine digits."""
    if isinstance(value, float):
        short = float("%.9g" % value)
        return int(short) if short == int(short) else short
    if isinstance(value, dict):
        return {k: rounded(v) for k, v in value.items()}
    if isinstance(value, (list, tuple)):
        return [rounded(v) for v in value]
    return value
