"""A glTF scene with two sets of materials, an animation of two seconds, and a camera: a square before a lamp's light."""

import base64
import json
import struct


def floats(*numbers):
    return struct.pack(f"<{len(numbers)}f", *numbers)


def write(path):
    corners = floats(-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0)
    indices = struct.pack("<6H", 0, 1, 2, 0, 2, 3)
    times, moves = floats(0, 2), floats(0, 0, 0, 1.5, 0, 0)
    data, views = b"", []
    for part in (corners, indices, times, moves):
        views.append({"buffer": 0, "byteOffset": len(data), "byteLength": len(part)})
        data += part

    def material(name, color):
        return {"name": name, "doubleSided": True,
                "pbrMetallicRoughness": {"baseColorFactor": [*color, 1], "metallicFactor": 0, "roughnessFactor": 1}}

    scene = {
        "asset": {"version": "2.0"},
        "extensionsUsed": ["KHR_materials_variants"],
        "extensions": {"KHR_materials_variants": {"variants": [{"name": "red one"}, {"name": "blue"}]}},
        "scene": 0, "scenes": [{"nodes": [0, 1]}],
        "nodes": [{"mesh": 0, "name": "square"}, {"camera": 0, "translation": [0, 0, 5], "name": "front"}],
        "cameras": [{"type": "perspective", "perspective": {"yfov": 0.9, "znear": 0.1}}],
        "materials": [material("grey", (.5, .5, .5)), material("red", (.8, .05, .05)),
                      material("blue", (.05, .05, .8))],
        "meshes": [{"primitives": [{
            "attributes": {"POSITION": 0}, "indices": 1, "material": 0,
            "extensions": {"KHR_materials_variants": {"mappings": [{"material": 1, "variants": [0]},
                                                                   {"material": 2, "variants": [1]}]}}}]}],
        "animations": [{"channels": [{"sampler": 0, "target": {"node": 0, "path": "translation"}}],
                        "samplers": [{"input": 2, "output": 3}]}],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3", "min": [-1, -1, 0],
             "max": [1, 1, 0]},
            {"bufferView": 1, "componentType": 5123, "count": 6, "type": "SCALAR"},
            {"bufferView": 2, "componentType": 5126, "count": 2, "type": "SCALAR", "min": [0], "max": [2]},
            {"bufferView": 3, "componentType": 5126, "count": 2, "type": "VEC3"}],
        "bufferViews": views,
        "buffers": [{"byteLength": len(data),
                     "uri": "data:application/octet-stream;base64," + base64.b64encode(data).decode()}],
    }
    with open(path, "w", encoding="utf-8") as file:
        json.dump(scene, file)
