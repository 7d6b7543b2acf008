"""A room as files: a scene of Mitsuba 3, meshes as PLY and pictures as PNG, the same bytes on each run."""

import struct


class Part:
    """Meshes by material: each material's are one file."""

    def __init__(self, room, name):
        self.room, self.part, self.meshes, self.raw = room, name, {}, []

    def add(self, material, mesh, flat=False):
        """A flat mesh has no normals of corners: each triangle has its own."""
        self.meshes.setdefault((material, flat), []).append(mesh)
        return self

    def xml(self, indent):
        lines = list(self.raw)
        for (material, flat), meshes in self.meshes.items():
            file = "_".join(filter(None, (self.part, material, "flat" if flat else ""))) + ".ply"
            data, count = ply(meshes, not flat, material in self.room.textured)
            self.room.files[f"{self.room.name}/{file}"] = data
            self.room.unique += count
            faces = '<boolean name="face_normals" value="true"/>' if flat else ""
            lines.append(f'<shape type="ply"><string name="filename" value="{self.room.name}/{file}"/>{faces}'
                         f'<ref id="{material}"/></shape>')
        return [indent + line for line in lines]


class Room(Part):
    def __init__(self, name, text):
        self.files, self.textured, self.unique = {}, set(), 0
        Part.__init__(self, self, "")
        self.name, self.text = name, text
        self.bsdfs, self.groups, self.places, self.head = [], [], [], []

    def picture(self, name, data):
        self.files[f"{self.name}/{name}.png"] = data
        return f"{self.name}/{name}.png"

    def material(self, name, bsdf):
        """A bsdf without its id; it has coordinates of pictures where one is in it."""
        if 'type="bitmap"' in bsdf:
            self.textured.add(name)
        self.bsdfs.append(bsdf.replace("<bsdf ", f'<bsdf id="{name}" ', 1))
        return name

    def camera(self, origin, target, fov):
        numbers = (", ".join(f"{c:g}" for c in point) for point in (origin, target))
        self.head = ['<integrator type="path"><integer name="max_depth" value="17"/></integrator>', "",
                     '<sensor type="perspective">', f'    <float name="fov" value="{fov:g}"/>',
                     '    <transform name="to_world">',
                     '        <lookat origin="%s" target="%s" up="0, 1, 0"/>' % tuple(numbers), "    </transform>",
                     '    <sampler type="independent"><integer name="sample_count" value="64"/></sampler>',
                     '    <film type="hdrfilm">', '        <integer name="width" value="640"/>',
                     '        <integer name="height" value="360"/>', '        <rfilter type="box"/>',
                     "    </film>", "</sensor>", ""]

    def group(self, name):
        self.groups.append(Part(self, name))
        return self.groups[-1]

    def place(self, group, move=(0, 0, 0), turn=0, size=1):
        """An instance: scaled, turned about the vertical, moved."""
        steps = f'<scale value="{size:.4g}"/>' if size != 1 else ""
        steps += f'<rotate y="1" angle="{turn:.5g}"/>' if turn else ""
        steps += '<translate x="%.5g" y="%.5g" z="%.5g"/>' % tuple(move)
        self.places.append(f'<shape type="instance"><ref id="{group.part}"/>'
                           f'<transform name="to_world">{steps}</transform></shape>')

    def made(self):
        """All files by their names."""
        lines = ['<?xml version="1.0" encoding="utf-8"?>', f"<!-- {self.text}",
                 "     The scene is written for this project; lengths are metres. -->", '<scene version="3.0.0">']
        body = self.head + self.bsdfs + [""]
        for group in self.groups:
            body += [f'<shape type="shapegroup" id="{group.part}">', *group.xml("    "), "</shape>"]
        body += [*self.xml(""), *self.places]
        lines += [f"    {line}" if line else "" for line in body] + ["</scene>", ""]
        self.files[f"{self.name}.xml"] = "\n".join(lines).encode()
        return self.files


def ply(meshes, normals, uvs):
    """Little-endian binary; corners that are alike are there once. Also returns the number of triangles."""
    corners, triangles = {}, []
    for mesh in meshes:
        places = []
        for k, position in enumerate(mesh.positions):
            corner = [round(c, 5) for c in position]
            if normals:
                corner += [round(c, 4) for c in mesh.normals[k]]
            if uvs:
                corner += [round(c, 4) for c in mesh.uvs[k]] if mesh.uvs else [0.0, 0.0]
            places.append(corners.setdefault(tuple(c + 0.0 for c in corner), len(corners)))
        triangles += [t for t in (tuple(places[i] for i in triangle) for triangle in mesh.triangles)
                      if len(set(t)) == 3]
    names = ["x", "y", "z"] + ["nx", "ny", "nz"] * normals + ["u", "v"] * uvs
    header = ["ply", "format binary_little_endian 1.0", f"element vertex {len(corners)}",
              *(f"property float {name}" for name in names), f"element face {len(triangles)}",
              "property list uchar int vertex_indices", "end_header", ""]
    row = struct.Struct(f"<{len(names)}f")
    return ("\n".join(header).encode() + b"".join(row.pack(*corner) for corner in corners)
            + b"".join(struct.pack("<B3i", 3, *triangle) for triangle in triangles), len(triangles))
