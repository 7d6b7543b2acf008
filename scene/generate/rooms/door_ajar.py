"""scene/library/door_ajar.xml: a dark room with three vessels on a table; all its light comes through a door that is
ajar, from the lamps of a corridor."""

import math

from forms import box, curve, cushion, frame, grid, lathe, panel, pipe, placed, quad, wall
from materials import brass, diffuse, glass, metal, panel_lamp, principled, varnished
from room import Room
from shapes import arc
from surfaces import floor_boards, landscape, stone, tile_relief, wallpaper

LEFT, RIGHT, BACK, FRONT, HEIGHT = -2.1, 2.1, -1.6, 2.9, 2.6
DOOR_LEFT, DOOR_RIGHT, DOOR_TOP = -1.25, -0.35, 2.08  # in x
WALL = 0.18


def materials(room):
    room.material("paper", diffuse(room.picture("paper", wallpaper((0.86, 0.82, 0.70), (0.60, 0.66, 0.55)))))
    room.material("wainscot", varnished((0.70, 0.68, 0.62), 0.25))
    room.material("ceiling", diffuse((0.80, 0.79, 0.76)))
    room.material("floor",
                  varnished(room.picture("floor", floor_boards((0.66, 0.47, 0.30), (0.43, 0.27, 0.16), 31)), 0.15))
    room.material("door", varnished((0.50, 0.47, 0.40), 0.2))
    room.material(
        "oak", varnished(room.picture("table", floor_boards((0.60, 0.41, 0.26), (0.40, 0.25, 0.15), 47, 256, 2)), 0.1))
    room.material("brass", brass(0.12))
    room.material("iron", metal("Cr", 0.2))
    room.material("earthenware", diffuse((0.55, 0.30, 0.18)))
    room.material("glass", glass(1.5))
    room.material("silver", metal("Ag", 0.06))
    room.material("corridor", diffuse((0.84, 0.79, 0.70)))
    room.material("tiles", varnished(room.picture("tiles", stone((0.82, 0.79, 0.73), (0.62, 0.58, 0.52), 3, 192)), 0.12,
                                     room.picture("tiles_relief", tile_relief(3, 0.015, 8, 192))))
    room.material("fruit", principled((0.55, 0.10, 0.03), roughness=0.35, clearcoat=0.6))
    room.material("cloth", principled((0.62, 0.60, 0.55), roughness=0.95, specular=0.1, sheen=0.4))
    room.material("picture", varnished(room.picture("picture", landscape(5)), 0.3))
    room.material("seat", principled((0.30, 0.06, 0.05), roughness=0.8, sheen=0.8))


def shell(room):
    width, length = RIGHT - LEFT, FRONT - BACK
    hole = ((DOOR_LEFT - LEFT, 0, DOOR_RIGHT - LEFT, DOOR_TOP),)
    rail = 0.95
    for name, bottom, top in (("wainscot", 0, rail), ("paper", rail, HEIGHT)):
        def upright(corner, along, reach, holes=(), name=name, bottom=bottom, top=top):
            cut = [(a, max(0.0, b - bottom), c, min(d, top) - bottom) for a, b, c, d in holes]
            room.add(name, wall((corner[0], bottom, corner[1]), along, reach, top - bottom, cut, 0, 1.6), flat=True)

        upright((LEFT, BACK), (1, 0, 0), width, hole)
        upright((LEFT, FRONT), (0, 0, -1), length)
        upright((RIGHT, BACK), (0, 0, 1), length)
        upright((RIGHT, FRONT), (-1, 0, 0), width)
    room.add("ceiling", quad((LEFT, HEIGHT, BACK), (width, 0, 0), (0, 0, length)), flat=True)
    room.add("floor", panel((LEFT, 0, FRONT), (width, 0, 0), (0, 0, -length), 0.7), flat=True)
    for y0, y1, out in ((0, 0.13, 0.022), (rail - 0.05, rail, 0.03)):
        room.add("wainscot", box((LEFT, y0, BACK), (DOOR_LEFT - 0.08, y1, BACK + out)), flat=True)
        room.add("wainscot", box((DOOR_RIGHT + 0.08, y0, BACK), (RIGHT, y1, BACK + out)), flat=True)
        room.add("wainscot", box((LEFT, y0, BACK), (LEFT + out, y1, FRONT)), flat=True)
        room.add("wainscot", box((RIGHT - out, y0, BACK), (RIGHT, y1, FRONT)), flat=True)
    for k in range(5):  # panels of the wainscot
        x = -0.12 + 0.44 * k
        room.add("wainscot", placed(frame((0, 0.2), (0.38, 0.84), 0.03, 0.014), (x, 0, BACK)), flat=True)
    room.add("ceiling", box((LEFT, HEIGHT - 0.07, BACK), (RIGHT, HEIGHT, BACK + 0.07)), flat=True)
    room.add("ceiling", box((RIGHT - 0.07, HEIGHT - 0.07, BACK), (RIGHT, HEIGHT, FRONT)), flat=True)
    room.add("ceiling", box((LEFT, HEIGHT - 0.07, BACK), (LEFT + 0.07, HEIGHT, FRONT)), flat=True)


def door(room, angle):
    """It opens into the corridor; its hinges are on the right."""
    for x0, x1, y1 in ((DOOR_LEFT - 0.09, DOOR_LEFT, DOOR_TOP + 0.09), (DOOR_RIGHT, DOOR_RIGHT + 0.09, DOOR_TOP + 0.09),
                       (DOOR_LEFT - 0.09, DOOR_RIGHT + 0.09, DOOR_TOP + 0.09)):
        bottom = DOOR_TOP if x1 - x0 > 0.5 else 0
        room.add("door", box((x0, bottom, BACK - WALL), (x1, y1, BACK + 0.025)), flat=True)
    width, height, t = DOOR_RIGHT - DOOR_LEFT - 0.008, DOOR_TOP - 0.01, 0.04
    leaf = box((0, 0.006, -t), (width, height, 0))
    for x in (0.11, 0.49):
        for y0, y1 in ((0.16, 0.82), (0.98, 1.92)):
            for side in (0, -t - 0.008):
                leaf.append(placed(frame((x, y0), (x + 0.30, y1), 0.025, 0.008), (0, 0, side)))
                leaf.append(placed(box((x + 0.06, y0 + 0.06, 0), (x + 0.24, y1 - 0.06, 0.005)), (0, 0, side + 0.0015)))
    move, turn = (DOOR_RIGHT - 0.004, 0, BACK - 0.14), 180 - angle
    room.add("door", placed(leaf, move, turn), flat=True)
    for side in (1, -1):
        z = 0.0 if side > 0 else -t
        lever = [(width - 0.06, 1.02, z), (width - 0.06, 1.02, z + 0.05 * side), (width - 0.09, 1.02, z + 0.06 * side),
                 (width - 0.19, 1.015, z + 0.055 * side)]
        room.add("brass", placed(pipe(curve(lever, 6), 0.008, 12), move, turn))
        plate = box((width - 0.085, 0.90, min(z, z + 0.004 * side)), (width - 0.035, 1.09, max(z, z + 0.004 * side)))
        room.add("brass", placed(plate, move, turn), flat=True)


def corridor(room):
    """Beyond the door: bright walls, tiles, three lamps at its ceiling, of which the room sees none."""
    x0, x1, z0, z1, height = -3.2, 1.4, BACK - 1.75, BACK - WALL, 2.5
    hole = ((x1 - DOOR_RIGHT, 0, x1 - DOOR_LEFT, DOOR_TOP),)
    room.add("corridor", wall((x0, 0, z0), (1, 0, 0), x1 - x0, height), flat=True)
    room.add("corridor", wall((x1, 0, z1), (-1, 0, 0), x1 - x0, height, hole), flat=True)
    room.add("corridor", wall((x0, 0, z1), (0, 0, -1), z1 - z0, height), flat=True)
    room.add("corridor", wall((x1, 0, z0), (0, 0, 1), z1 - z0, height), flat=True)
    room.add("corridor", quad((x0, height, z0), (x1 - x0, 0, 0), (0, 0, z1 - z0)), flat=True)
    room.add("tiles", panel((x0, 0, BACK), (x1 - x0, 0, 0), (0, 0, z0 - BACK), 0.8), flat=True)
    for x in (-2.5, -1.75, 0.6):
        room.raw.append(panel_lamp((x, height - 0.02, (z0 + z1) / 2), (0.30, 0.16), 90, (420, 350, 260)))


def pot(room, name, place, turn, tall, hollow=False):
    """A vessel with lid, spout and handle. Glass is hollow: its line goes up outside and down inside."""
    body = [(0, 0), (0.052, 0), (0.056, 0.004), (0.052, 0.010)]
    body += [(0.052 + 0.062 * math.sin(math.pi * t) ** 0.8 - 0.012 * t, 0.010 + tall * t) for t in
             [k / 24 for k in range(1, 24)]] + [(0.042, 0.010 + tall), (0.044, 0.014 + tall)]
    if hollow:
        inside = [(r - 0.005, h) for r, h in reversed(body[4:-2])]
        body += [(0.040, 0.016 + tall), (0.037, 0.012 + tall)] + inside + [(0.044, 0.014), (0, 0.013)]
    room.add(name, placed(lathe(body, 52, False), place, turn, size=1.4))
    top = 0.0152 + tall
    lid = [(0.046, top), (0.046, top + 0.004), (0.034, top + 0.016), (0.012, top + 0.022), (0.007, top + 0.028)]
    lid = [(0, top - 0.001)] + lid + arc((0, top + 0.037), 0.0115, -50, 90, 10)
    room.add(name, placed(lathe(lid, 36, False), place, turn, size=1.4))
    middle = 0.010 + tall * 0.5
    handle = [(-0.086, middle + 0.036, 0), (-0.135, middle + 0.046, 0), (-0.150, middle + 0.012, 0),
              (-0.132, middle - 0.022, 0), (-0.092, middle - 0.026, 0)]
    spout = [(0.088, middle - 0.018, 0), (0.128, middle - 0.004, 0), (0.146, middle + 0.03, 0),
             (0.176, middle + 0.058, 0)]
    if not hollow:
        room.add(name, placed(pipe(curve(handle, 8), 0.0075, 16), place, turn, size=1.4))
        line = curve(spout, 8)
        room.add(
            name,
            placed(pipe(line, [0.024 - 0.014 * (k / (len(line) - 1))**0.7 for k in range(len(line))], 20),
                   place,
                   turn,
                   size=1.4))
    else:
        line = curve([(-0.108, middle + 0.036, 0), *handle[1:4], (-0.112, middle - 0.030, 0)], 8)
        room.add(name, placed(pipe(line, 0.0065, 16), place, turn, size=1.4))


def table(room, x, z):
    width, depth, top = 1.5, 0.8, 0.74
    room.add("oak",
             placed(box((-width / 2, -0.03, -depth / 2), (width / 2, 0, depth / 2), (1.4, 1)), (x, top, z)),
             flat=True)
    room.add("oak",
             placed(box((-width / 2 + 0.08, -0.11, -depth / 2 + 0.07), (width / 2 - 0.08, -0.03, depth / 2 - 0.07)),
                    (x, top, z)),
             flat=True)
    leg = [(0.018, 0), (0.026, 0.03), (0.016, 0.06), (0.030, 0.30), (0.022, 0.46), (0.034, 0.50), (0.024, 0.54),
           (0.034, 0.58), (0.034, 0.63)]
    for a in (-1, 1):
        for b in (-1, 1):
            room.add("oak", placed(lathe(leg, 24), (x + a * (width / 2 - 0.11), 0, z + b * (depth / 2 - 0.10))))
    pot(room, "earthenware", (x - 0.46, top, z - 0.02), 24, 0.15)
    pot(room, "glass", (x - 0.02, top, z + 0.04), 150, 0.165, hollow=True)
    pot(room, "silver", (x + 0.44, top, z - 0.03), 160, 0.145)

    def runner(u, v):
        s = (v - 0.5) * 1.14
        wave = 0.002 * (1 + math.sin(9 * u + 3 * v))
        flat = depth / 2 + 0.002
        out = min(abs(s), flat)
        drop = max(0.0, abs(s) - flat)
        return (x + 0.46 * (0.5 - u) + 0.32, top + 0.0015 + wave - drop,
                z + math.copysign(out + (0.004 + wave if drop else 0), s))

    room.add("cloth", grid(20, 40, runner))
    dish = [(0, 0.004), (0.05, 0.004), (0.052, 0), (0.055, 0.004), (0.10, 0.030), (0.102, 0.033), (0.099, 0.033),
            (0.052, 0.009), (0, 0.009)]
    at = (x + 0.12, top, z + 0.24)
    room.add("brass", placed(lathe(dish, 48), at))
    apple = [(0, 0.008)] + [(0.036 * math.sin(math.radians(a))**0.85, 0.032 - 0.031 * math.cos(math.radians(a)))
                            for a in range(16, 165, 12)] + [(0.006, 0.056), (0, 0.052)]
    for dx, dz, turn in ((-0.035, 0.01, 0), (0.038, 0.018, 40), (0.004, -0.04, 80)):
        room.add("fruit", placed(lathe(apple, 28), (at[0] + dx, at[1] + 0.007, at[2] + dz), turn))
        room.add(
            "iron",
            pipe([(at[0] + dx, at[1] + 0.058, at[2] + dz), (at[0] + dx + 0.005, at[1] + 0.078, at[2] + dz)], 0.0015, 6))


def chair(room, move, turn):
    parts = []
    for x in (-0.19, 0.19):
        parts.append(pipe([(x, 0, 0.19), (x, 0.44, 0.19)], [0.014, 0.02], 12))
        parts.append(
            pipe(curve([(x, 0, -0.22), (x, 0.44, -0.18), (x, 0.75, -0.20), (x * 0.95, 0.98, -0.26)], 6), 0.017, 12))
        parts.append(pipe([(x, 0.2, 0.19), (x, 0.2, -0.2)], 0.009, 8))
    for y, z in ((0.62, -0.19), (0.78, -0.205), (0.94, -0.245)):
        parts.append(placed(cushion((0.38, 0.075, 0.018), 0.008, 2, 2), (0, y, z), tilt=-8))
    parts.append(placed(cushion((0.44, 0.04, 0.43), 0.015, 2, 2), (0, 0.445, 0)))
    for part in parts:
        room.add("oak", placed(part, move, turn))
    room.add("seat", placed(placed(cushion((0.40, 0.06, 0.39), 0.025, puff=0.012), (0, 0.49, 0)), move, turn))


def door_ajar():
    room = Room("door_ajar",
                "A dark room, three vessels on a table: all light comes from a corridor, by a door that is ajar.")
    room.camera((0.85, 1.32, 2.1), (-0.12, 0.86, -0.8), 58)
    materials(room)
    shell(room)
    door(room, 32)
    corridor(room)
    table(room, 0.62, -0.5)
    chair(room, (-0.42, 0, -0.1), 118)
    room.add("picture", quad((0.25, 1.28, BACK + 0.012), (1.0, 0, 0), (0, 0.75, 0)), flat=True)
    room.add("brass", placed(frame((-0.05, -0.05), (1.05, 0.80), 0.055, 0.035), (0.25, 1.28, BACK)), flat=True)
    return room
