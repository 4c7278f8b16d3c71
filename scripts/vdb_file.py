"""Volume files in OpenVDB's format, written from dense arrays without its library: version 224,
trees of 5, 4 and 3 bits, nothing compressed. Voxels of 0 are not active, blocks of 8^3 of them not
in the file."""
import base64
import struct

import numpy as np


def _text(value):
    return struct.pack("<I", len(value)) + value.encode()


def _mask(bits):
    return np.packbits(np.asarray(bits, bool), bitorder="little").tobytes()


def _values(values):
    return b"\6" + np.ascontiguousarray(values, "<f4").tobytes()  # 6: all of them follow


def _blocks(array, side):
    """A dense [x, y, z, …] array in cubes of `side`: those that are not black, by place."""
    grown = np.pad(array, [(0, -n % side) for n in array.shape[:3]] + [(0, 0)])
    found = {}
    for x in range(0, grown.shape[0], side):
        for y in range(0, grown.shape[1], side):
            for z in range(0, grown.shape[2], side):
                cube = grown[x:x + side, y:y + side, z:z + side]
                if np.any(cube):
                    found[x // side, y // side, z // side] = cube
    return found


def _inner(cubes, bits, width):
    """Masks and values of an inner node of (2^bits)^3 children; z fastest."""
    held = np.zeros((1 << bits,) * 3, bool)
    for place in cubes:
        held[place] = True
    count = held.size
    return _mask(held.ravel()) + bytes(count // 8) + _values(np.zeros((count, width)))


def _leaf_mask(cube):
    return _mask(np.any(cube != 0, -1).ravel())


def _tree(array):
    """Topology and buffers; the array begins at voxel 0 and ends before 4096."""
    width = array.shape[3]
    nodes = _blocks(array, 128)
    topology = struct.pack("<I", 1) + bytes(4 * width) + struct.pack("<5i", 0, 1, 0, 0, 0)
    topology += _inner(nodes, 5, width)
    buffers = b""
    for place in sorted(nodes):
        leaves = _blocks(nodes[place], 8)
        topology += _inner(leaves, 4, width)
        for leaf in sorted(leaves):
            topology += _leaf_mask(leaves[leaf])
            buffers += _leaf_mask(leaves[leaf]) + _values(leaves[leaf])
    return topology, buffers


def _grid(array, voxel, start):
    """What follows a grid's descriptor, from `start` on; voxels of `voxel` metres."""
    topology, buffers = _tree(array)
    place = np.diag([voxel, voxel, voxel, 1.0])
    head = struct.pack("<II", 0, 0) + _text("AffineMap") + place.astype("<f8").tobytes() + topology
    return head + buffers, start, start + len(head), start + len(head) + len(buffers)


def vdb_bytes(grids, voxel=1.0):
    """A file of {name: array}: [x, y, z] of numbers or [x, y, z, 3] of colours, float32."""
    out = struct.pack("<qIII", 0x56444220, 224, 10, 0) + b"\1"
    out += b"00000000-0000-0000-0000-000000000000" + struct.pack("<II", 0, len(grids))
    for name, array in grids.items():
        array = np.asarray(array, np.float32)
        array = array[..., None] if array.ndim == 3 else array
        out += _text(name) + _text("Tree_float_5_4_3" if array.shape[3] == 1 else
                                   "Tree_vec3s_5_4_3") + _text("")
        body, *places = _grid(array, voxel, len(out) + 24)
        out += struct.pack("<3q", *places) + body
    return out


def vdb_uri(grids, voxel=1.0):
    data = base64.b64encode(vdb_bytes(grids, voxel)).decode()
    return "data:application/octet-stream;base64," + data
