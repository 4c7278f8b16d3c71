"""Reading the EXR files that the renderer writes, and writing PNG and EXR for its textures."""
import struct
import zlib

import numpy as np

TYPES = {0: ("<u4", 4), 1: ("<f2", 2), 2: ("<f4", 4)}


def _name(data, at):
    end = data.index(b"\0", at)
    return data[at:end].decode(), end + 1


def _header(data):
    attributes, at = {}, 8
    while data[at]:
        name, at = _name(data, at)
        kind, at = _name(data, at)
        size = struct.unpack_from("<i", data, at)[0]
        attributes[name] = (kind, data[at + 4:at + 4 + size])
        at += 4 + size
    return attributes, at + 1


def _channels(raw):
    channels, at = [], 0
    while raw[at]:
        name, at = _name(raw, at)
        channels.append((name, struct.unpack_from("<i", raw, at)[0]))
        at += 16
    return channels


def _unpack(block, size):
    """Undoes zip compression: deflate, then differences, then two halves interleaved."""
    if len(block) == size:
        return block
    b = np.frombuffer(zlib.decompress(block), np.uint8).astype(np.int64)
    b[1:] -= 128
    b = (np.cumsum(b) & 255).astype(np.uint8)
    half, out = (len(b) + 1) // 2, np.empty_like(b)
    out[0::2], out[1::2] = b[:half], b[half:]
    return out.tobytes()


def _value(kind, raw):
    if kind == "string":
        return raw.decode()
    if kind in ("int", "float"):
        return struct.unpack("<i" if kind == "int" else "<f", raw)[0]
    return raw


def read_exr(path):
    """(channels, attributes): each channel by its full name, height x width; ids as integers."""
    with open(path, "rb") as file:
        data = file.read()
    if data[:4] != b"\x76\x2f\x31\x01" or data[5] & 0x1A:
        raise ValueError("%s: not an EXR file of scanlines" % path)
    attributes, at = _header(data)
    compression = attributes["compression"][1][0]
    rows = {0: 1, 2: 1, 3: 16}[compression]
    x0, y0, x1, y1 = struct.unpack("<4i", attributes["dataWindow"][1])
    width, height = x1 - x0 + 1, y1 - y0 + 1
    channels = _channels(attributes["channels"][1])
    line = width * sum(TYPES[t][1] for _, t in channels)
    out = {name: np.empty((height, width), TYPES[t][0]) for name, t in channels}
    for offset in struct.unpack_from("<%dQ" % -(-height // rows), data, at):
        y, size = struct.unpack_from("<ii", data, offset)
        y -= y0
        count = min(rows, height - y)
        block, p = _unpack(data[offset + 8:offset + 8 + size], line * count), 0
        for row in range(y, y + count):
            for name, t in channels:
                out[name][row] = np.frombuffer(block, TYPES[t][0], width, p)
                p += width * TYPES[t][1]
    return out, {k: _value(*v) for k, v in attributes.items()}


def layer(channels, name, letters):
    """The channels of one layer, height x width x their number; float64 unless they are ids."""
    prefix = name + "." if name else ""
    planes = [channels[prefix + c] for c in letters]
    kind = np.int64 if planes[0].dtype == np.uint32 else np.float64
    return np.stack(planes, -1).astype(kind)


def exr_bytes(rgb):
    """An uncompressed EXR of three float channels; rgb: height x width x 3."""
    rgb = np.asarray(rgb, np.float32)
    height, width = rgb.shape[:2]
    window = struct.pack("<4i", 0, 0, width - 1, height - 1)
    channels = b"".join(c + b"\0" + struct.pack("<iBxxxii", 2, 0, 1, 1) for c in (b"B", b"G", b"R"))
    out = b"\x76\x2f\x31\x01\x02\0\0\0"
    for name, kind, value in ((b"channels", b"chlist", channels + b"\0"),
                              (b"compression", b"compression", b"\0"),
                              (b"dataWindow", b"box2i", window),
                              (b"displayWindow", b"box2i", window),
                              (b"lineOrder", b"lineOrder", b"\0"),
                              (b"pixelAspectRatio", b"float", struct.pack("<f", 1)),
                              (b"screenWindowCenter", b"v2f", struct.pack("<2f", 0, 0)),
                              (b"screenWindowWidth", b"float", struct.pack("<f", 1))):
        out += name + b"\0" + kind + b"\0" + struct.pack("<i", len(value)) + value
    out += b"\0"
    size = 12 * width
    first = len(out) + 8 * height
    out += struct.pack("<%dQ" % height, *(first + y * (8 + size) for y in range(height)))
    for y in range(height):
        out += struct.pack("<ii", y, size) + rgb[y, :, ::-1].T.astype("<f4").tobytes()
    return out


def png_bytes(pixels):
    """A PNG of 8 or 16 bits a channel (by the array's type); pixels: height x width x 3 or 4."""
    pixels = np.asarray(pixels)
    height, width, channels = pixels.shape
    bits = 8 * pixels.dtype.itemsize
    rows = pixels.astype(">u%d" % (bits // 8))
    raw = b"".join(b"\0" + rows[y].tobytes() for y in range(height))

    def chunk(kind, data):
        body = kind + data
        return struct.pack(">I", len(data)) + body + struct.pack(">I", zlib.crc32(body))

    head = struct.pack(">IIBBBBB", width, height, bits, {3: 2, 4: 6}[channels], 0, 0, 0)
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"IDAT", zlib.compress(raw)) +
            chunk(b"IEND", b""))
