"""Forms of rooms, beside those of scene/generate/gltf/shapes.py."""

import math

from shapes import Mesh, box, cross, grid, lathe, quad, sub, unit


def placed(mesh, move=(0, 0, 0), turn=0, tilt=0, roll=0, size=1):
    """A copy: scaled, rolled about z, tilted about x, turned about y (degrees), moved."""
    sines = [(math.sin(math.radians(a)), math.cos(math.radians(a))) for a in (roll, tilt, turn)]

    def turned(p):
        x, y, z = p
        (s, c), (t, d), (w, e) = sines
        x, y = x * c - y * s, x * s + y * c
        y, z = y * d - z * t, y * t + z * d
        return (x * e + z * w, y, z * e - x * w)

    copy = Mesh()
    copy.positions = [tuple(size * a + b for a, b in zip(turned(p), move)) for p in mesh.positions]
    copy.normals = [turned(n) for n in mesh.normals]
    copy.uvs, copy.triangles = list(mesh.uvs), list(mesh.triangles)
    return copy


def joined(*meshes):
    mesh = Mesh()
    for other in meshes:
        mesh.append(other)
    return mesh


def panel(corner, edge_u, edge_v, per_metre=1.0, at=(0, 0)):
    """A quad whose picture has so many repeats on a metre."""
    u, v = (math.sqrt(sum(c * c for c in edge)) * per_metre for edge in (edge_u, edge_v))
    a, b = at
    return quad(corner, edge_u, edge_v, ((a, b), (a + u, b), (a + u, b + v), (a, b + v)))


def wall(corner, along, length, height, holes=(), depth=0.0, per_metre=1.0):
    """An upright wall from a corner to the right of who sees it; holes are (left, bottom, right, top), and their
    reveals go so deep away from the viewer."""
    normal = cross(along, (0, 1, 0))
    lefts = sorted({0.0, length, *(h[0] for h in holes), *(h[2] for h in holes)})
    bottoms = sorted({0.0, height, *(h[1] for h in holes), *(h[3] for h in holes)})

    def at(u, v, back=0.0):
        return tuple(c + u * a - back * n + (v if i == 1 else 0)
                     for i, (c, a, n) in enumerate(zip(corner, along, normal)))

    mesh = Mesh()
    for u0, u1 in zip(lefts, lefts[1:]):
        for v0, v1 in zip(bottoms, bottoms[1:]):
            if not any(h[0] <= u0 and u1 <= h[2] and h[1] <= v0 and v1 <= h[3] for h in holes):
                start = at(u0, v0)
                mesh.append(panel(start, sub(at(u1, v0), start), (0, v1 - v0, 0), per_metre,
                                  (u0 * per_metre, v0 * per_metre)))
    for u0, v0, u1, v1 in holes if depth else ():
        for a, b in (((u0, v0), (u1, v0)), ((u1, v0), (u1, v1)), ((u1, v1), (u0, v1)), ((u0, v1), (u0, v0))):
            start = at(*a)
            mesh.append(panel(start, sub(at(*b), start), sub(at(*a, depth), start), per_metre))
    return mesh


def smoothed(mesh):
    """Corners at one place share the mean of the normals of all triangles around."""
    sums = {}
    keys = [tuple(round(c, 6) for c in p) for p in mesh.positions]
    for a, b, c in mesh.triangles:
        n = cross(sub(mesh.positions[b], mesh.positions[a]), sub(mesh.positions[c], mesh.positions[a]))
        for k in (a, b, c):
            sums[keys[k]] = tuple(x + y for x, y in zip(sums.get(keys[k], (0, 0, 0)), n))
    mesh.normals = [unit(sums[k]) if any(sums.get(k, ())) else n for k, n in zip(keys, mesh.normals)]
    return mesh


def cushion(size, radius, steps=3, inner=4, puff=0.0, per_metre=4.0):
    """A box about the origin with round edges, which is thicker in the middle by puff along y."""
    half = [s / 2 for s in size]

    def line(h):
        bend = [radius * math.tan(math.radians(45 * (1 - i / steps))) for i in range(steps + 1)]
        flat = h - radius
        return ([-flat - b for b in bend] + [-flat + 2 * flat * i / inner for i in range(1, inner)]
                + [flat + b for b in reversed(bend)])

    def surface(q):
        core = [max(-(h - radius), min(h - radius, c)) for h, c in zip(half, q)]
        n = unit(sub(q, core))
        p = [c + radius * d for c, d in zip(core, n)]
        p[1] += puff * n[1] * max(0.0, 1 - (p[0] / half[0]) ** 2) * max(0.0, 1 - (p[2] / half[2]) ** 2)
        return tuple(p), n

    mesh = Mesh()
    for axis in range(3):
        i, j = (axis + 1) % 3, (axis + 2) % 3
        for side in (1, -1):
            us, vs = line(half[i]), line(half[j])
            first = len(mesh.positions)
            for v in vs:
                for u in us:
                    q = [0.0, 0.0, 0.0]
                    q[axis], q[i], q[j] = side * half[axis], side * u, v
                    p, n = surface(tuple(q))
                    mesh.positions.append(p)
                    mesh.normals.append(n)
                    mesh.uvs.append((u * per_metre, v * per_metre))
            for b in range(len(vs) - 1):
                for a in range(len(us) - 1):
                    k = first + b * len(us) + a
                    m = k + len(us)
                    mesh.triangles += [(k, k + 1, m + 1), (k, m + 1, m)]
    return smoothed(mesh) if puff else mesh


def pipe(points, radius, sides=10, caps=True):
    """A round rod along points; radius may be a number for each point."""
    radii = radius if isinstance(radius, (list, tuple)) else [radius] * len(points)
    mesh, right = Mesh(), None
    for k, point in enumerate(points):
        along = unit(sub(points[min(k + 1, len(points) - 1)], points[max(k - 1, 0)]))
        if right is None:
            right = unit(cross(along, (0, 0, 1) if abs(along[2]) < 0.9 else (1, 0, 0)))
        front = unit(cross(right, along))
        right = cross(along, front)
        for i in range(sides + 1):
            angle = 2 * math.pi * (i % sides) / sides
            n = tuple(r * math.cos(angle) + f * math.sin(angle) for r, f in zip(right, front))
            mesh.positions.append(tuple(p + radii[k] * c for p, c in zip(point, n)))
            mesh.normals.append(n)
            mesh.uvs.append((i / sides, k / (len(points) - 1)))
    row = sides + 1
    for k in range(len(points) - 1):
        for i in range(sides):
            a = k * row + i
            mesh.triangles += [(a, a + row + 1, a + 1), (a, a + row, a + row + 1)]
    ends = ((0, sub(points[0], points[1])), (len(points) - 1, sub(points[-1], points[-2])))
    for end, towards in ends if caps else ():
        first = len(mesh.positions)
        mesh.positions += mesh.positions[end * row : end * row + sides]
        mesh.normals += [unit(towards)] * sides
        mesh.uvs += [(0.0, 0.0)] * sides
        mesh.triangles += [(first, first + i, first + i + 1) if end == 0 else (first, first + i + 1, first + i)
                           for i in range(1, sides - 1)]
    return mesh


def curve(points, steps):
    """A smooth line through points (Catmull and Rom)."""
    line = []
    ends = [points[0], *points, points[-1]]
    for a, b, c, d in zip(ends, ends[1:], ends[2:], ends[3:]):
        for i in range(steps):
            t = i / steps
            line.append(tuple(0.5 * (2 * q + (r - p) * t + (2 * p - 5 * q + 4 * r - s) * t * t
                                     + (3 * q - p - 3 * r + s) * t**3) for p, q, r, s in zip(a, b, c, d)))
    return line + [tuple(map(float, points[-1]))]


def curtain(left, right, bottom, top, folds, depth, columns=90, rows=10, gather=0.0):
    """Hanging cloth from (x, z) to (x, z), whose folds are deeper below."""
    (x0, z0), (x1, z1) = left, right
    length = math.hypot(x1 - x0, z1 - z0)
    along, across = ((x1 - x0) / length, (z1 - z0) / length), (-(z1 - z0) / length, (x1 - x0) / length)

    def at(u, v):
        drop = 1 - v
        narrow = 1 - gather * math.sin(math.pi * min(1.0, drop * 0.9)) ** 2
        s = length * (0.5 + (u - 0.5) * narrow)
        wave = math.sin(2 * math.pi * folds * u + 0.9 * math.sin(5 * u + 2 * drop))
        out = depth * (0.45 + 0.55 * drop) * (wave + 0.3 * math.sin(2 * math.pi * 2.3 * folds * u + 1 + 3 * drop))
        return (x0 + along[0] * s + across[0] * out, bottom + (top - bottom) * v, z0 + along[1] * s + across[1] * out)

    return grid(columns, rows, at)


def leaf_blade(length, width, droop, columns=8, rows=4, fold=0.25):
    """A leaf along x that bends down, with its outline as its edge."""
    def at(u, v):
        side = (2 * v - 1) * width / 2 * max(0.02, math.sin(math.pi * min(1.0, 0.02 + u) ** 0.8)) ** 0.8
        x = length * u
        return (x * (1 - 0.18 * droop * u), droop * length * (0.55 * u - u * u) + fold * abs(side) * (1 - u / 2), side)

    return grid(columns, rows, lambda u, v: at(u, 1 - v))


def frame(low, high, width, thickness):
    """Four bars about a rectangle of x and y, to the front of z = 0."""
    (x0, y0), (x1, y1) = low, high
    return joined(box((x0, y0, 0), (x0 + width, y1, thickness)), box((x1 - width, y0, 0), (x1, y1, thickness)),
                  box((x0 + width, y0, 0), (x1 - width, y0 + width, thickness)),
                  box((x0 + width, y1 - width, 0), (x1 - width, y1, thickness)))


def turned_ring(center_radius, radius, sides=24, around=40):
    """A ring about y."""
    return grid(
        around, sides, lambda u, v: ((center_radius + radius * math.cos(2 * math.pi * v)) * math.sin(
            2 * math.pi * u), radius * math.sin(2 * math.pi * v),
                                     (center_radius + radius * math.cos(2 * math.pi * v)) * math.cos(2 * math.pi * u)))


__all__ = ["Mesh", "box", "cross", "cushion", "curtain", "curve", "frame", "grid", "joined", "lathe", "leaf_blade",
           "panel", "pipe", "placed", "quad", "smoothed", "sub", "turned_ring", "unit", "wall"]
