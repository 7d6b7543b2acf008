"""Writers of the files: glTF's binary form, PNG, Radiance HDR. All of them write the same bytes for the
same content."""

import json
import math
import struct
import zlib

FLOAT, USHORT, UBYTE = 5126, 5123, 5121
_KINDS = {1: "SCALAR", 2: "VEC2", 3: "VEC3", 4: "VEC4"}


def png(width, height, texels):
    """8 bits a channel; texels, row after row from the top, are tuples of 3 or 4 numbers of 0 to 255.
    A picture of few colours is stored by a palette."""
    channels = len(texels[0])
    colors = sorted(set(texels))
    if len(colors) <= 256 and channels == 3:
        place = {color: i for i, color in enumerate(colors)}
        rows = [bytes([0]) + bytes(place[t] for t in texels[y * width : (y + 1) * width]) for y in range(height)]
        kind, palette = 3, [(b"PLTE", b"".join(map(bytes, colors)))]
    else:
        rows, above = [], bytes(width * channels)
        for y in range(height):
            row = b"".join(map(bytes, texels[y * width : (y + 1) * width]))
            # Filter 2: the difference from the row above, which is small in smooth pictures.
            rows.append(bytes([2]) + bytes((a - b) & 255 for a, b in zip(row, above)))
            above = row
        kind, palette = {3: 2, 4: 6}[channels], []
    chunks = [(b"IHDR", struct.pack(">2I5B", width, height, 8, kind, 0, 0, 0)), *palette,
              (b"IDAT", zlib.compress(b"".join(rows), 9)), (b"IEND", b"")]
    return b"\x89PNG\r\n\x1a\n" + b"".join(
        struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))
        for name, data in chunks)


def _run_lengths(values):
    """A channel of a row as Radiance packs it: runs of four and more, and what lies between them."""
    packed, i = bytearray(), 0
    plain = bytearray()
    while i <= len(values):
        run = 1
        while i + run < len(values) and values[i + run] == values[i] and run < 127:
            run += 1
        if plain and (i == len(values) or run >= 4 or len(plain) == 128):
            packed += bytes([len(plain)]) + plain
            plain = bytearray()
        if i == len(values):
            break
        if run >= 4:
            packed += bytes([128 + run, values[i]])
            i += run
        else:
            plain.append(values[i])
            i += 1
    return packed


def hdr(width, height, radiance):
    """Radiance's RGBE with run lengths; width is 8 at least."""
    out = bytearray(b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y %d +X %d\n" % (height, width))
    for y in range(height):
        channels = [bytearray() for _ in range(4)]
        for color in radiance[y * width : (y + 1) * width]:
            mantissa, exponent = math.frexp(max(color))
            for channel, value in zip(channels, color):
                channel.append(int(math.ldexp(value, 8 - exponent)) if mantissa else 0)
            channels[3].append(exponent + 128 if mantissa else 0)
        out += struct.pack(">2BH", 2, 2, width)
        for channel in channels:
            out += _run_lengths(channel)
    return bytes(out)


class Gltf:
    """A document with one scene and one binary buffer, which grows as things are added."""

    def __init__(self, title):
        self.document = {
            "asset": {"version": "2.0", "generator": "scene/generate/gltf"},
            "scene": 0, "scenes": [{"name": title, "nodes": []}], "nodes": [],
        }
        self.binary = bytearray()

    def add(self, kind, content):
        """The number of a new element of an array such as "materials"."""
        array = self.document.setdefault(kind, [])
        array.append(content)
        return len(array) - 1

    def use(self, *extensions):
        used = set(self.document.get("extensionsUsed", [])) | set(extensions)
        if used:
            self.document["extensionsUsed"] = sorted(used)

    def bytes(self, data):
        self.binary += bytes(-len(self.binary) % 4)
        view = self.add("bufferViews", {"buffer": 0, "byteOffset": len(self.binary), "byteLength": len(data)})
        self.binary += data
        return view

    def accessor(self, rows, kind, normalized=False, bounds=False):
        """Rows are tuples of numbers. Those of floats are rounded to a millionth first, so that how a
        machine rounds sines does not change the file."""
        width = len(rows[0])
        letter = {FLOAT: "f", USHORT: "H", UBYTE: "B"}[kind]
        if kind == FLOAT:
            rows = [tuple(round(x, 6) + 0.0 for x in row) for row in rows]
        data = struct.pack(f"<{len(rows) * width}{letter}", *(x for row in rows for x in row))
        content = {"bufferView": self.bytes(data), "componentType": kind, "count": len(rows),
                   "type": _KINDS[width]}
        if normalized:
            content["normalized"] = True
        if bounds:
            exact = [[struct.unpack("<f", struct.pack("<f", x))[0] for x in column] for column in zip(*rows)]
            content["min"], content["max"] = [min(c) for c in exact], [max(c) for c in exact]
        return self.add("accessors", content)

    def texture(self, picture, **sampler):
        source = self.add("images", {"bufferView": self.bytes(picture), "mimeType": "image/png"})
        content = {"source": source}
        if sampler:
            content["sampler"] = self.add("samplers", sampler)
        return self.add("textures", content)

    def material(self, name, base=(1, 1, 1, 1), metallic=0, roughness=1, pbr=None, extensions=None, **rest):
        """Extensions are named without their prefix "KHR_materials_"."""
        named = {f"KHR_materials_{key}": value for key, value in (extensions or {}).items()}
        self.use(*named)
        content = {"name": name,
                   "pbrMetallicRoughness": {"baseColorFactor": list(base), "metallicFactor": metallic,
                                            "roughnessFactor": roughness, **(pbr or {})}, **rest}
        if named:
            content["extensions"] = named
        return self.add("materials", content)

    def place(self, name, mesh, material, **transform):
        """A node in the scene that shows a mesh of shapes.py with a material."""
        attributes = {"POSITION": self.accessor(mesh.positions, FLOAT, bounds=True)}
        if mesh.normals:
            attributes["NORMAL"] = self.accessor(mesh.normals, FLOAT)
        if mesh.uvs:
            attributes["TEXCOORD_0"] = self.accessor(mesh.uvs, FLOAT)
        if mesh.colors:
            attributes["COLOR_0"] = self.accessor(mesh.colors, UBYTE, normalized=True)
        indices = self.accessor([(i,) for triangle in mesh.triangles for i in triangle], USHORT)
        shown = self.add("meshes", {"name": name, "primitives": [
            {"attributes": attributes, "indices": indices, "material": material}]})
        self.node(name, mesh=shown, **transform)

    def camera(self, name, yfov, position, target):
        lens = self.add("cameras", {"name": name, "type": "perspective",
                                    "perspective": {"yfov": yfov, "aspectRatio": 4 / 3, "znear": 0.01}})
        back = [p - t for p, t in zip(position, target)]
        turn = math.atan2(back[0], back[2]) / 2
        rise = -math.atan2(back[1], math.hypot(back[0], back[2])) / 2
        # The quaternion of the turn about y after the rise about x.
        rotation = [math.cos(turn) * math.sin(rise), math.sin(turn) * math.cos(rise),
                    -math.sin(turn) * math.sin(rise), math.cos(turn) * math.cos(rise)]
        self.node(name, camera=lens, translation=list(position), rotation=[round(q, 9) for q in rotation])

    def node(self, name, **content):
        self.document["scenes"][0]["nodes"].append(self.add("nodes", {"name": name, **content}))

    def glb(self):
        self.document["buffers"] = [{"byteLength": len(self.binary)}]
        text = json.dumps(self.document, separators=(",", ":")).encode()
        text += b" " * (-len(text) % 4)
        binary = bytes(self.binary) + bytes(-len(self.binary) % 4)
        return (struct.pack("<3I", 0x46546C67, 2, 28 + len(text) + len(binary))
                + struct.pack("<I", len(text)) + b"JSON" + text
                + struct.pack("<I", len(binary)) + b"BIN\0" + binary)
