"""Meshes: y is up, the unit is a metre, triangles are counter-clockwise seen from outside."""

import math


class Mesh:
    def __init__(self):
        self.positions, self.normals, self.uvs, self.colors, self.triangles = [], [], [], [], []

    def append(self, other):
        first = len(self.positions)
        self.positions += other.positions
        self.normals += other.normals
        self.uvs += other.uvs
        self.colors += other.colors
        self.triangles += [tuple(first + i for i in triangle) for triangle in other.triangles]
        return self

    def moved(self, x, y, z):
        self.positions = [(a + x, b + y, c + z) for a, b, c in self.positions]
        return self


def sub(a, b):
    return tuple(x - y for x, y in zip(a, b))


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def unit(a):
    length = math.sqrt(sum(x * x for x in a))
    return tuple(x / length for x in a)


def quad(corner, edge_u, edge_v, uvs=((0, 1), (1, 1), (1, 0), (0, 0))):
    """Normal: edge_u x edge_v. The picture stands upright along edge_v."""
    mesh = Mesh()
    mesh.positions = [tuple(c + a * u + b * v for c, a, b in zip(corner, edge_u, edge_v))
                      for u, v in ((0, 0), (1, 0), (1, 1), (0, 1))]
    mesh.normals = [unit(cross(edge_u, edge_v))] * 4
    mesh.uvs = list(uvs)
    mesh.triangles = [(0, 1, 2), (0, 2, 3)]
    return mesh


def box(low, high, repeat=(1, 1)):
    """A picture on each side, repeated so many times on the largest ones (up and down)."""
    x, y, z = sub(high, low)
    u, v = repeat
    mesh = Mesh()
    for corner, edge_u, edge_v, u1, v1 in (
            ((low[0], high[1], high[2]), (x, 0, 0), (0, 0, -z), u, v),
            ((low[0], low[1], low[2]), (x, 0, 0), (0, 0, z), u, v),
            ((low[0], low[1], high[2]), (x, 0, 0), (0, y, 0), u, v * y / z),
            ((high[0], low[1], low[2]), (-x, 0, 0), (0, y, 0), u, v * y / z),
            ((high[0], low[1], high[2]), (0, 0, -z), (0, y, 0), u * z / x, v * y / z),
            ((low[0], low[1], low[2]), (0, 0, z), (0, y, 0), u * z / x, v * y / z)):
        mesh.append(quad(corner, edge_u, edge_v, ((0, v1), (u1, v1), (u1, 0), (0, 0))))
    return mesh


def grid(columns, rows, at, textured=True):
    """The surface at(u, v) for u and v in [0, 1]; its normal is that of du x dv. Where that has no
    length, as at poles, it is taken a little further inside."""
    step = 1e-4

    def normal(u, v):
        a, b = min(u + step, 1), max(u - step, 0)
        c, d = min(v + step, 1), max(v - step, 0)
        n = cross(sub(at(a, v), at(b, v)), sub(at(u, c), at(u, d)))
        if sum(x * x for x in n) < 1e-24:
            return normal(u, v + (step if v < 0.5 else -step))
        return unit(n)

    mesh = Mesh()
    for j in range(rows + 1):
        for i in range(columns + 1):
            u, v = i / columns, j / rows
            mesh.positions.append(at(u, v))
            mesh.normals.append(normal(u, v))
            if textured:
                mesh.uvs.append((u, 1 - v))
    for j in range(rows):
        for i in range(columns):
            a = j * (columns + 1) + i
            b, c, d = a + 1, a + columns + 2, a + columns + 1
            corners = [mesh.positions[k] for k in (a, b, c, d)]
            # At a pole one edge has no length, and one of the two triangles no area.
            if math.dist(corners[0], corners[1]) > 1e-9:
                mesh.triangles.append((a, b, c))
            if math.dist(corners[2], corners[3]) > 1e-9:
                mesh.triangles.append((a, c, d))
    return mesh


def lathe(profile, segments, textured=True):
    """Turns a line of (radius, height) about the y axis. Upwards along the line, the outside is away
    from the axis. Corners of the line that are to be sharp are there twice."""
    mesh = Mesh()
    start = 0
    lengths = [math.dist(a, b) for a, b in zip(profile, profile[1:])]
    total, done = sum(lengths), 0.0
    for end in range(1, len(profile) + 1):
        if end < len(profile) and lengths[end - 1] > 0:
            continue
        part = profile[start:end]
        mesh.append(_turned(part, segments, textured, done / total, sum(lengths[start : end - 1]) / total))
        done += sum(lengths[start : end - 1])
        start = end
    return mesh


def _turned(part, segments, textured, v0, v_length):
    """A smooth part of a lathe's line: its normals are those of the line's chords, averaged."""
    chords = [unit((b[1] - a[1], a[0] - b[0])) for a, b in zip(part, part[1:])]
    slopes = [chords[0]] + [unit((a[0] + b[0], a[1] + b[1])) for a, b in zip(chords, chords[1:])] + [chords[-1]]
    # A line that ends on the axis meets it at right angles, unless it is straight: a cone.
    for end, k in ((0, 0), (-1, len(part) - 1)):
        if part[k][0] == 0 and len(part) > 2:
            slopes[k] = (0, math.copysign(1, slopes[k][1]))
    lengths = [math.dist(a, b) for a, b in zip(part, part[1:])]
    mesh = Mesh()
    for j, ((radius, height), (out, up)) in enumerate(zip(part, slopes)):
        v = v0 + v_length * sum(lengths[:j]) / sum(lengths)
        for i in range(segments + 1):
            angle = 2 * math.pi * (i % segments) / segments
            sine, cosine = math.sin(angle), math.cos(angle)
            mesh.positions.append((radius * sine, height, radius * cosine))
            mesh.normals.append((out * sine, up, out * cosine))
            if textured:
                mesh.uvs.append((i / segments, 1 - v))
    for j in range(len(part) - 1):
        for i in range(segments):
            a = j * (segments + 1) + i
            b, c, d = a + 1, a + segments + 2, a + segments + 1
            if part[j][0] > 0:
                mesh.triangles.append((a, b, c))
            if part[j + 1][0] > 0:
                mesh.triangles.append((a, c, d))
    return mesh


def arc(center, radius, start, end, steps):
    """Points of a lathe's line on a circle; angles in degrees, 0: outwards, 90: up."""
    angles = [math.radians(start + (end - start) * i / steps) for i in range(steps + 1)]
    points = [(center[0] + radius * math.cos(a), center[1] + radius * math.sin(a)) for a in angles]
    return [(0.0 if abs(r) < 1e-9 else r, h) for r, h in points]


def tube(points, radius, sides):
    """A thin stem along points; its ends are open."""
    mesh = Mesh()
    for k, point in enumerate(points):
        along = unit(sub(points[min(k + 1, len(points) - 1)], points[max(k - 1, 0)]))
        right = unit(cross(along, (0, 0, 1)))
        front = cross(right, along)
        for i in range(sides):
            angle = 2 * math.pi * i / sides
            normal = tuple(r * math.cos(angle) + f * math.sin(angle) for r, f in zip(right, front))
            mesh.positions.append(tuple(p + radius * n for p, n in zip(point, normal)))
            mesh.normals.append(normal)
    for k in range(len(points) - 1):
        for i in range(sides):
            a, b = k * sides + i, k * sides + (i + 1) % sides
            mesh.triangles += [(a, b, b + sides), (a, b + sides, a + sides)]
    return mesh
