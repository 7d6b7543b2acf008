"""scene/library/atrium.xml: a court with two storeys of arcades under sun and sky, made of instances of a column, an
arch, a baluster and of potted plants."""

import math
import random

from columns import column
from forms import box, cushion, frame, grid, joined, lathe, panel, pipe, placed, quad, turned_ring, wall
from materials import both_sides, brass, bsdf, color, cut_out, diffuse, sun_and_sky, varnished
from room import Room
from shapes import Mesh, arc
from surfaces import ashlar, banner, stone, twig_color, twig_opacity, tiles

BAY = 2.4  # from column to column
LONG, SHORT = 7, 4  # bays of the court
STOREY = (4.2, 3.7)  # from floor to floor
COLUMN = (2.45, 2.0)
WALK = 2.3  # depth of the arcades
HALF_X, HALF_Z = LONG * BAY / 2, SHORT * BAY / 2
TOP = sum(STOREY)


def materials(room):
    room.material("stone", diffuse(room.picture("stone", stone((0.90, 0.86, 0.77), (0.76, 0.70, 0.60), 17))))
    room.material("carved", diffuse((0.66, 0.60, 0.49)))
    room.material("ashlar", diffuse(room.picture("ashlar", ashlar((0.89, 0.81, 0.68), (0.76, 0.66, 0.52), 29))))
    room.material("plaster", diffuse((0.72, 0.56, 0.38)))
    room.material("vault", diffuse((0.70, 0.66, 0.58)))
    room.material(
        "paving",
        varnished(
            room.picture(
                "paving",
                tiles([(0.82, 0.76, 0.66), (0.76, 0.69, 0.58), (0.79, 0.73, 0.63), (0.66, 0.50, 0.40)],
                      (0.48, 0.43, 0.37), 6, 0.03, 4)), 0.3))
    room.material("beams", diffuse((0.20, 0.12, 0.07)))
    room.material("roof", diffuse((0.50, 0.22, 0.12)))
    room.material("clay", diffuse((0.52, 0.24, 0.13)))
    room.material("soil", diffuse((0.05, 0.035, 0.025)))
    room.material("bark", diffuse((0.16, 0.11, 0.075)))
    leaf = both_sides(bsdf("diffuse", color("reflectance", room.picture("twig", twig_color()))))
    room.material("twigs", cut_out(room.picture("twig_opacity", twig_opacity()), leaf))
    for k, (field, charge) in enumerate(
        (((0.62, 0.12, 0.10), (0.90, 0.74, 0.36)), ((0.14, 0.27, 0.50), (0.90, 0.86, 0.74)), ((0.16, 0.40, 0.27),
                                                                                              (0.90, 0.74, 0.36)))):
        room.material(f"banner_{k}", diffuse(room.picture(f"banner_{k}", banner(field, charge, 60 + k))))
    room.material("bronze", brass(0.2))


def arch(group, rise_from, wall_top, depth, radius):
    """Along x between two columns: a round arch with a moulded front to both sides, and the wall above it."""
    steps, half = 28, BAY / 2
    points = [(radius * math.cos(math.pi * k / steps), rise_from + radius * math.sin(math.pi * k / steps))
              for k in range(steps + 1)]
    front = Mesh()
    for k in range(steps):
        (xa, ya), (xb, yb) = points[k], points[k + 1]
        front.append(flat_quad((xb, yb), (xa, ya), (xa, wall_top), (xb, wall_top), depth / 2))
        front.append(placed(flat_quad((xb, yb), (xa, ya), (xa, wall_top), (xb, wall_top), depth / 2), turn=180))
    for side in (0, 180):
        front.append(
            placed(flat_quad((radius, rise_from), (half, rise_from), (half, wall_top), (radius, wall_top), depth / 2),
                   turn=side))
        front.append(
            placed(flat_quad((-half, rise_from), (-radius, rise_from), (-radius, wall_top), (-half, wall_top),
                             depth / 2),
                   turn=side))
        front.append(placed(quad((radius, rise_from, -depth / 2), (half - radius, 0, 0), (0, 0, depth)), turn=side))
    group.add("ashlar", front, flat=True)
    group.add(
        "stone",
        grid(
            steps, 1, lambda u, v: (radius * math.cos(math.pi * u), rise_from + radius * math.sin(math.pi * u), depth *
                                    (v - 0.5))))
    profile = [(0.0, 0.0), (0.0, 0.035), (0.05, 0.045), (0.06, 0.03), (0.12, 0.03), (0.13, 0.05), (0.17, 0.06),
               (0.19, 0.04), (0.20, 0.0)]

    def moulding(u, v):
        k = min(int(v * 8 + 1e-9), 7)
        (a, b), (c, d) = profile[k], profile[k + 1]
        t = v * 8 - k
        r, out = radius + a + (c - a) * t, b + (d - b) * t
        return (r * math.cos(math.pi * (1 - u)), rise_from + r * math.sin(math.pi * (1 - u)), depth / 2 + out)

    ring = grid(44, 16, moulding)
    group.add("carved", ring).add("carved", placed(ring, turn=180))
    stone_key = box((-0.09, rise_from + radius - 0.05, -depth / 2 - 0.09),
                    (0.09, rise_from + radius + 0.27, depth / 2 + 0.09))
    group.add("stone", stone_key, flat=True)
    for y, high, out in ((wall_top - 0.06, 0.06, 0.14), (wall_top - 0.12, 0.06, 0.10), (wall_top - 0.26, 0.05, 0.05)):
        group.add("carved", box((-half, y, -depth / 2 - out), (half, y + high, depth / 2 + out)), flat=True)
    for k in range(12):  # dentils under the cornice
        x = -half + (k + 0.5) * BAY / 12
        for z in (depth / 2, -depth / 2 - 0.075):
            group.add("carved", box((x - 0.05, wall_top - 0.20, z), (x + 0.05, wall_top - 0.12, z + 0.075)), flat=True)


def flat_quad(a, b, c, d, z):
    mesh = Mesh()
    mesh.positions = [(x, y, z) for x, y in (a, b, c, d)]
    mesh.normals = [(0, 0, 1)] * 4
    mesh.uvs = [(0.4 * x + 0.5, -0.4 * y) for x, y in (a, b, c, d)]
    mesh.triangles = [(0, 1, 2), (0, 2, 3)]
    return mesh


def baluster(group):
    line = [(0, 0), (0.062, 0), (0.062, 0), (0.062, 0.05), (0.062, 0.05), (0.042, 0.055)] + arc(
        (0.042, 0.07), 0.014, -80, 80, 5)
    line += [(0.034, 0.09), (0.034, 0.10)] + [(0.034 + 0.038 * math.sin(math.pi * t**0.75)**1.3, 0.10 + 0.32 * t)
                                              for t in [k / 16 for k in range(1, 17)]]
    line += arc((0.034, 0.44), 0.016, -80, 80, 5) + [(0.036, 0.47), (0.05, 0.50), (0.06, 0.51), (0.06, 0.51),
                                                     (0.06, 0.56), (0.06, 0.56), (0, 0.56)]
    group.add("stone", lathe(line, 28))


def rail(group):
    """What a bay of the balustrade has beside its balusters; and its floor's edge."""
    group.add("stone", box((-BAY / 2 + 0.2, 0, -0.11), (BAY / 2 - 0.2, 0.09, 0.11)), flat=True)
    group.add("stone", placed(cushion((BAY - 0.4, 0.10, 0.26), 0.03, 2, 1), (0, 0.09 + 0.56 + 0.05, 0)))


def plant(group, dice):
    """A small tree in a pot; its leaves are quads with twigs cut out."""
    pot = [(0, 0), (0.20, 0), (0.20, 0), (0.27, 0.10), (0.31, 0.34), (0.30, 0.40), (0.30, 0.40), (0.35, 0.42),
           (0.35, 0.48), (0.31, 0.49), (0.29, 0.44)]
    group.add("clay", lathe(pot, 48))
    group.add("clay", placed(turned_ring(0.312, 0.012, 8, 48), (0, 0.28, 0)))
    group.add("soil", lathe([(0.295, 0.45), (0, 0.46)], 24))
    ends = []
    group.add("bark", pipe([(0, 0.4, 0), (0.02, 0.75, 0.01), (0, 1.1, 0)], [0.045, 0.034, 0.026], 12))
    for k in range(11):
        turn, up = 137.5 * k, dice.uniform(0.25, 1.1)
        reach = dice.uniform(0.3, 0.5)
        foot = (0, 0.95 + 0.02 * k, 0)
        end = (reach * math.cos(math.radians(turn)), foot[1] + up * 0.8, reach * math.sin(math.radians(turn)))
        middle = (end[0] * 0.5, (foot[1] + end[1]) / 2 + 0.06, end[2] * 0.5)
        group.add("bark", pipe([foot, middle, end], [0.016, 0.010, 0.004], 6))
        ends += [(end, turn), (middle, turn + 60)]
    for (x, y, z), turn in ends:
        for k in range(17):
            size = dice.uniform(0.24, 0.38)
            blade = grid(
                3, 2, lambda u, v: (size * u, -0.10 * size * u * u * 3 + 0.1 * size * abs(2 * v - 1), size * 0.5 *
                                    (0.5 - v)))
            group.add(
                "twigs",
                placed(blade,
                       (x + dice.uniform(-0.06, 0.06), y + dice.uniform(-0.06, 0.1), z + dice.uniform(-0.06, 0.06)),
                       turn=dice.uniform(0, 360),
                       roll=dice.uniform(-35, 60),
                       tilt=dice.uniform(-25, 25)))


def sides():
    """The court's four sides as (middle of a bay, turn), with +z of a bay towards the court, and its columns."""
    bays, columns = [], []
    for k in range(LONG):
        x = -HALF_X + (k + 0.5) * BAY
        bays += [((x, -HALF_Z), 0), ((x, HALF_Z), 180)]
    for k in range(SHORT):
        z = -HALF_Z + (k + 0.5) * BAY
        bays += [((-HALF_X, z), 90), ((HALF_X, z), 270)]
    for k in range(LONG + 1):
        columns += [(-HALF_X + k * BAY, -HALF_Z), (-HALF_X + k * BAY, HALF_Z)]
    for k in range(1, SHORT):
        columns += [(-HALF_X, -HALF_Z + k * BAY), (HALF_X, -HALF_Z + k * BAY)]
    return bays, columns


def arcades(room):
    lower, upper = room.group("column_below"), room.group("column_above")
    column(lower, COLUMN[0], 0.20, 20)
    column(upper, COLUMN[1], 0.16, 18)
    arches = room.group("arch_below"), room.group("arch_above")
    arch(arches[0], COLUMN[0], STOREY[0], 0.42, 0.96)
    arch(arches[1], COLUMN[1], STOREY[1], 0.36, 0.99)
    small, bar = room.group("baluster"), room.group("rail")
    baluster(small)
    rail(bar)
    bays, columns = sides()
    for x, z in columns:
        room.place(lower, (x, 0, z))
        room.place(upper, (x, STOREY[0], z))
    for (x, z), turn in bays:
        sine, cosine = math.sin(math.radians(turn)), math.cos(math.radians(turn))
        room.place(arches[0], (x, 0, z), turn)
        room.place(arches[1], (x, STOREY[0], z), turn)
        room.place(bar, (x, STOREY[0], z), turn)
        for k in range(8):
            along = (k - 3.5) * 0.25
            room.place(small, (x + along * cosine, STOREY[0] + 0.09, z - along * sine), turn)


def shell(room):
    """Pavings, the walls and ceilings of the walks, doors, beams, the roof's edge."""
    x, z = HALF_X + WALK, HALF_Z + WALK
    room.add("paving", panel((-x, 0, z), (2 * x, 0, 0), (0, 0, -2 * z), 0.36), flat=True)
    for (a, b), along, length in (((-x, -z), (1, 0, 0), 2 * x), ((x, z), (-1, 0, 0), 2 * x),
                                  ((-x, z), (0, 0, -1), 2 * z), ((x, -z), (0, 0, 1), 2 * z)):
        room.add("plaster", wall((a, 1.0, b), along, length, TOP - 1.0), flat=True)
        room.add("ashlar", wall((a, 0, b), along, length, 1.0, (), 0, 0.4), flat=True)
    outer, inner = (x, z), (HALF_X - 0.15, HALF_Z - 0.15)
    for level in (STOREY[0] - 0.30, STOREY[0] - 0.02, TOP - 0.25, TOP + 0.05):
        for low, high in (((-outer[0], -outer[1]), (outer[0], -inner[1])), ((-outer[0], inner[1]), (outer[0],
                                                                                                    outer[1])),
                          ((-outer[0], -inner[1]), (-inner[0], inner[1])), ((inner[0], -inner[1]), (outer[0],
                                                                                                    inner[1]))):
            size = (high[0] - low[0], high[1] - low[1])
            name = "paving" if level == STOREY[0] - 0.02 else "vault" if level < TOP else "roof"
            room.add(name, panel((low[0], level, high[1]), (size[0], 0, 0), (0, 0, -size[1]), 0.36), flat=True)
    for k in range(2 * LONG + 1):
        a = -HALF_X + k * BAY / 2
        for level in (STOREY[0] - 0.30, TOP - 0.25):
            for s in (-1, 1):
                room.add("beams",
                         box((a - 0.07, level - 0.16, min(s * HALF_Z, s * z)),
                             (a + 0.07, level, max(s * HALF_Z, s * z))),
                         flat=True)
    for k in range(2 * SHORT + 1):
        a = -HALF_Z + k * BAY / 2
        for level in (STOREY[0] - 0.30, TOP - 0.25):
            for s in (-1, 1):
                room.add("beams",
                         box((min(s * HALF_X, s * x), level - 0.16, a - 0.07),
                             (max(s * HALF_X, s * x), level, a + 0.07)),
                         flat=True)


def doors(room):
    bays, _ = sides()
    for k, ((x, z), turn) in enumerate(bays):
        if k % 3 == 1:
            continue
        for level in (0, STOREY[0]):
            sine, cosine = math.sin(math.radians(turn)), math.cos(math.radians(turn))
            move = (x - WALK * sine, level, z - WALK * cosine)
            parts = placed(box((-0.5, 0, 0), (0.5, 2.1, 0.03)), move, turn)
            room.add("beams", parts, flat=True)
            room.add("carved",
                     placed(
                         joined(frame((-0.62, 0), (0.62, 2.24), 0.12, 0.07), box((-0.75, 2.24, 0), (0.75, 2.34, 0.14))),
                         move, turn),
                     flat=True)
            for a in (-0.44, 0.03):
                for b in (0.15, 1.12):
                    room.add("beams",
                             placed(placed(frame((a, b), (a + 0.41, b + 0.85), 0.05, 0.02), (0, 0, 0.03)), move, turn),
                             flat=True)


def cornice(room):
    """Tiles of the roof over the court's edge, above the upper arches."""
    for (a, b, turn, count) in ((-HALF_X, -HALF_Z, 0, 80), (HALF_X, HALF_Z, 180, 80), (-HALF_X, HALF_Z, 90, 46),
                                (HALF_X, -HALF_Z, 270, 46)):
        length = 2 * (HALF_X if count == 80 else HALF_Z)
        row = grid(
            count * 3, 2, lambda u, v:
            (length * u, TOP + 0.10 + 0.55 * v + 0.05 * abs(math.sin(math.pi * (count * u + 0.01))), 0.35 - 1.2 * v))
        room.add("roof", placed(row, (a, 0, b), turn))


def hang(room, k, x, z, turn, level, width, height, dice):
    """A banner from a bronze rod at the balustrade, moved a little by the wind."""
    phase = dice.uniform(0, 6)

    def at(u, v):
        down = 1 - v
        wave = 0.06 * down * math.sin(5 * u + 4 * down + phase) + 0.03 * down * math.sin(11 * u - 3 * down)
        return (width * (u - 0.5) * (1 - 0.05 * math.sin(math.pi * down)), level - height * down,
                0.30 + wave + 0.06 * down * down)

    room.add(f"banner_{k}", placed(grid(16, 30, at), (x, 0, z), turn))
    rod = pipe([(-width / 2 - 0.1, level + 0.01, 0.30), (width / 2 + 0.1, level + 0.01, 0.30)], 0.018, 10)
    room.add("bronze", placed(rod, (x, 0, z), turn))
    for side in (-1, 1):
        room.add(
            "bronze",
            placed(lathe(arc((0, 0), 0.035, -90, 90, 8), 16), rod_end(x, z, turn, side * (width / 2 + 0.1),
                                                                      level + 0.01)))
        room.add(
            "bronze",
            placed(pipe([(side * width * 0.4, level + 0.01, 0.1), (side * width * 0.4, level + 0.01, 0.30)], 0.012, 8),
                   (x, 0, z), turn))


def rod_end(x, z, turn, along, y):
    sine, cosine = math.sin(math.radians(turn)), math.cos(math.radians(turn))
    return (x + along * cosine + 0.30 * sine, y, z - along * sine + 0.30 * cosine)


def fountain(room):
    rim = [(0, 0.0), (1.35, 0.0), (1.35, 0.0), (1.30, 0.06), (1.22, 0.08), (1.20, 0.36), (1.26, 0.42), (1.34, 0.45),
           (1.35, 0.50), (1.30, 0.53), (1.16, 0.53), (1.12, 0.50), (1.10, 0.12), (1.10, 0.12), (0, 0.12)]
    room.add("stone", lathe(rim, 96))
    foot = [(0.30, 0.12), (0.28, 0.2), (0.16, 0.3), (0.13, 0.55), (0.19, 0.66), (0.15, 0.72),
            (0.13, 0.95), (0.22, 1.05), (0.52, 1.16), (0.62, 1.26), (0.63, 1.30), (0.58, 1.31), (0.50, 1.22),
            (0.15, 1.13), (0.09, 1.2), (0.07, 1.42), (0.12, 1.48), (0.10, 1.53), (0, 1.58)]
    room.add("stone", lathe(foot, 64))
    room.add("paving", lathe([(1.095, 0.13), (0.0, 0.13)], 48))


def atrium():
    dice = random.Random(99)
    room = Room(
        "atrium",
        "A court of two storeys of arcades under sun and sky: a million triangles by instances, banners, plants.")
    room.camera((7.3, 1.75, 3.1), (-3.0, 3.0, -1.9), 72)
    materials(room)
    arcades(room)
    shell(room)
    doors(room)
    cornice(room)
    fountain(room)
    small_tree = room.group("small_tree")
    plant(small_tree, dice)
    for k in range(1, LONG, 1):
        for s in (-1, 1):
            room.place(small_tree, (-HALF_X + k * BAY + dice.uniform(-0.1, 0.1), 0, s * (HALF_Z - 0.85)),
                       dice.uniform(0, 360), dice.uniform(0.85, 1.15))
    for k in range(1, SHORT):
        room.place(small_tree, (-HALF_X + 0.85, 0, -HALF_Z + k * BAY), dice.uniform(0, 360), dice.uniform(0.85, 1.15))
    bays, _ = sides()
    for k, ((x, z), turn) in enumerate(bays):
        if k in (2, 6, 10, 15, 19, 14, 3, 7, 11):
            hang(room, k % 3, x, z, turn, STOREY[0] + 0.62, 1.05, 2.3, dice)
    room.head.append(sun_and_sky((0.30, 0.92, 0.45), 6))
    return room
