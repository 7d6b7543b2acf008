"""scene/library/reading_room.xml: shelves of books, a sofa and a rug in the evening sun, which comes in by two
windows with glazing bars and between the slats of a blind."""

import math
import random

from forms import (box, cushion, curtain, frame, grid, lathe, leaf_blade, panel, pipe, placed, quad, wall)
from materials import (ball_lamp, brass, diffuse, glazed, principled, sky, translucent, varnished)
from room import Room
from shapes import Mesh, arc
from surfaces import SPINES, floor_boards, landscape, rug, spines

LEFT, RIGHT, BACK, FRONT, HEIGHT = -2.6, 2.6, -2.3, 2.5, 2.8
# Holes of the left wall, in metres from its front end: left, bottom, right, top.
WINDOWS = ((1.2, 0.55, 2.35, 2.4), (2.95, 0.55, 4.1, 2.4))
DEPTH = 0.22


def materials(room):
    room.material("walls", diffuse((0.78, 0.73, 0.62)))
    room.material("white", diffuse((0.82, 0.80, 0.76)))
    room.material("floor",
                  varnished(room.picture("floor", floor_boards((0.72, 0.52, 0.33), (0.48, 0.30, 0.17), 11)), 0.12))
    room.material("oak", varnished((0.16, 0.085, 0.04), 0.2))
    room.material("paint", glazed((0.78, 0.76, 0.71)))
    room.material("rug", principled(room.picture("rug", rug()), roughness=0.95, specular=0.1, sheen=0.6))
    room.material("spines", varnished(room.picture("spines", spines()), 0.25))
    room.material("pages", diffuse((0.74, 0.68, 0.54)))
    room.material("sofa", principled((0.10, 0.22, 0.21), roughness=0.85, specular=0.2, sheen=1.0, sheen_tint=0.6))
    room.material("pillow", principled((0.62, 0.30, 0.09), roughness=0.9, specular=0.2, sheen=0.7))
    room.material("plaid", principled((0.60, 0.55, 0.47), roughness=0.95, specular=0.1, sheen=0.5))
    room.material("throw", diffuse((0.60, 0.55, 0.47)))
    room.material("curtains", translucent((0.62, 0.50, 0.36), 0.35))
    room.material("shade", translucent((0.80, 0.66, 0.45), 0.5))
    room.material("blind", varnished((0.70, 0.62, 0.48), 0.2))
    room.material("brass", brass(0.15))
    room.material("clay", varnished((0.45, 0.19, 0.10), 0.3))
    room.material("soil", diffuse((0.05, 0.035, 0.025)))
    room.material("leaves", varnished((0.05, 0.16, 0.045), 0.15))
    room.material("bark", diffuse((0.13, 0.09, 0.06)))
    room.material("cup", glazed((0.75, 0.74, 0.70)))
    room.material("tea", glazed((0.12, 0.04, 0.01)))
    room.material("picture_a", varnished(room.picture("picture_a", landscape(21)), 0.3))
    room.material("picture_b", varnished(room.picture("picture_b", landscape(57)), 0.3))


def shell(room):
    length, width = FRONT - BACK, RIGHT - LEFT
    room.add("walls", wall((LEFT, 0, FRONT), (0, 0, -1), length, HEIGHT, WINDOWS, DEPTH), flat=True)
    room.add("walls", wall((LEFT, 0, BACK), (1, 0, 0), width, HEIGHT), flat=True)
    room.add("walls", wall((RIGHT, 0, BACK), (0, 0, 1), length, HEIGHT), flat=True)
    room.add("walls", wall((RIGHT, 0, FRONT), (-1, 0, 0), width, HEIGHT), flat=True)
    room.add("white", quad((LEFT, HEIGHT, BACK), (width, 0, 0), (0, 0, length)), flat=True)
    room.add("floor", panel((LEFT, 0, FRONT), (width, 0, 0), (0, 0, -length), 0.62), flat=True)
    # A skirting board, a cornice of three steps.
    for k, (y0, y1, out) in enumerate(((0, 0.12, 0.02), (HEIGHT - 0.05, HEIGHT, 0.14),
                                       (HEIGHT - 0.10, HEIGHT - 0.05, 0.09), (HEIGHT - 0.14, HEIGHT - 0.10, 0.04))):
        name = "paint" if k == 0 else "white"
        room.add(name, box((LEFT, y0, BACK), (RIGHT, y1, BACK + out)), flat=True)
        room.add(name, box((LEFT, y0, BACK), (LEFT + out, y1, FRONT)), flat=True)
        room.add(name, box((RIGHT - out, y0, BACK), (RIGHT, y1, FRONT)), flat=True)


def window(room, hole, blind):
    """Two casements of eight panes, a sill; they stand in the middle of the wall."""
    z0, y0, z1, y1 = FRONT - hole[2], hole[1], FRONT - hole[0], hole[3]
    width, height = z1 - z0, y1 - y0
    bars = frame((0, 0), (width, height), 0.05, 0.07)
    for a, b in ((0.04, width / 2), (width / 2, width - 0.04)):
        bars.append(placed(frame((a, 0.04), (b, height - 0.04), 0.045, 0.05), (0, 0, 0.012)))
        for y in (0.28, 0.52, 0.76):
            bars.append(box((a + 0.04, y * height - 0.011, 0.025), (b - 0.04, y * height + 0.011, 0.05)))
        bars.append(box(((a + b) / 2 - 0.011, 0.06, 0.026), ((a + b) / 2 + 0.011, height - 0.06, 0.049)))
    room.add("paint", placed(bars, (LEFT - 0.15, y0, z1), turn=90), flat=True)
    room.add("paint", box((LEFT - 0.10, y0 - 0.04, z0 - 0.06), (LEFT + 0.10, y0, z1 + 0.06)), flat=True)
    if blind:
        slats = Mesh()
        for k in range(30):
            slats.append(
                placed(grid(4, 2, lambda u, v: (0.05 * (0.5 - v), 0.012 * v * (1 - v), (0.5 - u) * (width - 0.03))),
                       (LEFT - 0.03, y1 - 0.06 - 0.038 * k, (z0 + z1) / 2),
                       roll=-24))
        room.add("blind", slats)
        room.add("blind", box((LEFT - 0.06, y1 - 0.04, z0 + 0.01), (LEFT - 0.005, y1 - 0.001, z1 - 0.01)), flat=True)
        for z in (z0 + 0.25, z1 - 0.25):
            room.add("blind", pipe([(LEFT - 0.03, y1 - 0.05, z), (LEFT - 0.03, y1 - 1.19, z)], 0.0018, 5))


def drapery(room):
    rod_y = 2.56
    room.add("brass", pipe([(LEFT + 0.11, rod_y, FRONT - 4.45), (LEFT + 0.11, rod_y, FRONT - 0.85)], 0.013, 12))
    for z, gather in ((FRONT - 0.98, 0.22), (FRONT - 2.68, 0.3), (FRONT - 4.3, 0.22)):
        half = 0.21
        cloth = curtain((LEFT + 0.11, z - half), (LEFT + 0.11, z + half), 0.03, rod_y, 7, 0.05, 72, 9, gather)
        room.add("curtains", cloth)
    for k in range(2):
        z = FRONT - (4.47 if k else 0.83)
        room.add("brass", placed(lathe(arc((0, 0), 0.028, -90, 90, 10), 16), (LEFT + 0.11, rod_y, z)))


def book(width, height, depth, column):
    """A spine to the front (+z), two boards, and the pages' edge above, a little lower."""
    u0, u1 = column / SPINES, (column + 1) / SPINES
    left, right, back, top = (u0 + 0.03 / SPINES), (u0 + 0.08 / SPINES), -depth, height
    cover = Mesh()
    cover.append(quad((0, 0, 0), (width, 0, 0), (0, height, 0), ((u0, 1), (u1, 1), (u1, 0), (u0, 0))))
    plain = ((left, 0.97), (right, 0.97), (right, 0.9), (left, 0.9))
    t = 0.003
    for corner, edge_u, edge_v in (((0, 0, back), (0, 0, depth), (0, top, 0)),
                                   ((width, 0, 0), (0, 0, back), (0, top, 0)), ((0, top, 0), (t, 0, 0), (0, 0, back)),
                                   ((width - t, top, 0), (t, 0, 0), (0, 0, back)), ((t, top, 0), (width - 2 * t, 0, 0),
                                                                                    (0, 0, -t)),
                                   ((t, top - 0.006, -t), (0, 0, back + t),
                                    (0, 0.006, 0)), ((width - t, top - 0.006, back), (0, 0, -back - t), (0, 0.006, 0))):
        cover.append(quad(corner, edge_u, edge_v, plain))
    pages = quad((t, top - 0.005, -t), (width - 2 * t, 0, 0), (0, 0, back + 2 * t))
    return cover, pages


def bookcase(room, x0, columns, dice):
    """Against the back wall, with a cornice; each board carries books, some of them lying or leaning."""
    width, height, front = 0.86, 2.36, BACK + 0.32
    x1 = x0 + columns * width
    room.add("oak", box((x0 - 0.06, height, BACK + 0.02), (x1 + 0.06, height + 0.05, front + 0.05)), flat=True)
    room.add("oak", box((x0 - 0.03, height - 0.05, BACK + 0.02), (x1 + 0.03, height, front + 0.02)), flat=True)
    room.add("oak", box((x0 - 0.02, 0, BACK + 0.02), (x1 + 0.02, 0.11, front + 0.015)), flat=True)
    room.add("oak", quad((x0, 0.1, BACK + 0.025), (x1 - x0, 0, 0), (0, height - 0.1, 0)), flat=True)
    for k in range(columns + 1):
        x = x0 + k * width
        room.add("oak", box((x - 0.016, 0.1, BACK + 0.02), (x + 0.016, height, front)), flat=True)
    boards = (0.11, 0.50, 0.86, 1.20, 1.54, 1.87)
    for k in range(columns):
        for y, above in zip(boards, (*boards[1:], height - 0.05)):
            left, right = x0 + k * width + 0.018, x0 + (k + 1) * width - 0.018
            room.add("oak", box((left, y - 0.022, BACK + 0.02), (right, y, front - 0.004)), flat=True)
            shelf(room, left, right, y, above - y - 0.03, front - 0.03, dice)


def shelf(room, left, right, y, room_above, front, dice):
    x = left + 0.003
    end = right - dice.choice((0.0, 0.0, 0.02, 0.16, 0.28))
    series = 0
    while True:
        if series == 0:
            series = dice.choice((1, 1, 1, 2, 3, 6))
            kind = (dice.uniform(0.016, 0.046), room_above * dice.uniform(0.68, 0.97), dice.uniform(0.15, 0.23),
                    dice.randrange(SPINES))
        series -= 1
        width, height, depth, column = kind
        if x + width > end:
            break
        cover, pages = book(width, height, depth, column)
        move = (x, y + 0.0005, front - dice.uniform(0.0, 0.02))
        room.add("spines", placed(cover, move), flat=True).add("pages", placed(pages, move), flat=True)
        x += width + 0.0008
    if right - x > 0.2:
        level = y
        for _ in range(dice.randrange(2, 5)):
            width, height, depth = dice.uniform(0.02, 0.04), dice.uniform(0.17, 0.195), 0.15
            cover, _ = book(width, height, depth, dice.randrange(SPINES))
            move = (x + 0.004 + height, level + 0.0005, front - dice.uniform(0, 0.02))
            room.add("spines", placed(cover, move, roll=90), flat=True)
            level += width + 0.0008
    elif right - x > 0.06:
        room.add(
            "clay",
            placed(lathe([(0, 0), (0.022, 0), (0.03, 0.02), (0.026, 0.07), (0.012, 0.10), (0.016, 0.12)], 20),
                   ((x + right) / 2, y, front - 0.06)))


def sofa(room, move, turn):
    def put(name, mesh, at):
        room.add(name, placed(placed(mesh, at), move, turn))

    put("sofa", cushion((2.05, 0.20, 0.86), 0.05), (0, 0.22, 0))
    put("sofa", cushion((2.05, 0.52, 0.22), 0.09, puff=0.0), (0, 0.56, -0.36))
    for x in (-1, 1):
        put("sofa", cushion((0.22, 0.44, 0.88), 0.09), (x * 0.98, 0.42, 0.0))
        put("sofa", cushion((0.84, 0.17, 0.68), 0.06, puff=0.035), (x * 0.43, 0.40, 0.10))
        put("sofa", placed(cushion((0.80, 0.20, 0.42), 0.08, puff=0.04), tilt=72), (x * 0.42, 0.68, -0.20))
        for z in (-0.36, 0.36):
            put("oak", lathe([(0.018, 0), (0.028, 0.12), (0, 0.12)], 14), (x * 0.93, 0, z))
    put("pillow", placed(cushion((0.44, 0.09, 0.44), 0.04, puff=0.09), tilt=66, turn=12), (-0.62, 0.68, 0.02))
    put("plaid", placed(cushion((0.40, 0.08, 0.40), 0.035, puff=0.08), tilt=62, turn=-14), (0.60, 0.66, 0.05))

    put("throw", grid(24, 30, drape), (0, 0, 0))


def drape(u, v):
    """A plaid over the right arm of the sofa: up outside, across, down inside."""
    wave = 0.006 * (1 + math.sin(11 * u + 2 * v)) + 0.003 * (1 + math.sin(29 * u))
    z = 0.33 - 0.46 * u + 0.015 * math.sin(4 * v)
    s, bend = v * 0.92, 0.09
    up, around = 0.42, bend * math.pi / 2
    if s < up:
        return (1.094 + wave + 0.035 * (1 - s / up) * (1 + math.sin(11 * u)) / 2, 0.13 + s, z)
    s -= up
    if s < around:
        a = s / bend
        return (1.0 + (bend + 0.004 + wave) * math.cos(a), 0.55 + (bend + 0.004 + wave) * math.sin(a), z)
    s -= around
    if s < 0.02:
        return (1.0 - s, 0.644 + wave, z)
    s -= 0.02
    if s < around:
        a = math.pi / 2 + s / bend
        return (0.98 + (bend + 0.004 + wave) * math.cos(a), 0.55 + (bend + 0.004 + wave) * math.sin(a), z)
    return (0.886 - wave, 0.55 - (s - around), z)


def floor_lamp(room, x, z):
    stand = [(0, 0), (0.15, 0), (0.15, 0.012), (0.04, 0.03), (0.012, 0.06), (0.011, 1.40), (0.02, 1.42), (0, 1.44)]
    room.add("brass", placed(lathe(stand, 28), (x, 0, z)))
    room.add("shade", placed(lathe([(0.24, 1.28), (0.235, 1.285), (0.15, 1.60)], 48), (x, 0, z)))
    room.raw.append(ball_lamp((x, 1.47, z), 0.035, (260, 170, 90)))


def table(room, x, z):
    top = cushion((0.62, 0.035, 1.05), 0.017, 3, 1)
    room.add("oak", placed(top, (x, 0.42, z)))
    for a in (-1, 1):
        for b in (-1, 1):
            room.add("oak",
                     pipe([(x + a * 0.26, 0, z + b * 0.46), (x + a * 0.23, 0.41, z + b * 0.42)], [0.014, 0.022], 12))
    cup = [(0, 0.004), (0.02, 0.004), (0.022, 0), (0.024, 0.006), (0.036, 0.03), (0.040, 0.062), (0.042, 0.064),
           (0.0405, 0.066), (0.038, 0.06), (0.034, 0.03), (0.02, 0.010), (0, 0.008)]
    saucer = [(0, 0.002), (0.035, 0.002), (0.07, 0.012), (0.072, 0.014), (0.07, 0.015), (0.036, 0.006), (0, 0.006)]
    at = (x + 0.1, 0.4385, z + 0.22)
    room.add("cup", placed(lathe(saucer, 32), at)).add("cup", placed(lathe(cup, 32), (at[0], at[1] + 0.006, at[2])))
    room.add("tea", placed(lathe([(0.0385, 0.05), (0, 0.05)], 24), (at[0], at[1] + 0.006, at[2])))
    room.add(
        "cup",
        placed(pipe([(0.036 + 0.022 * math.sin(math.pi * k / 10), 0.02 + 0.034 * k / 10, 0) for k in range(11)], 0.004,
                    8), (at[0], at[1] + 0.006, at[2]),
               turn=50))
    level = 0.4385
    for k, (turn, column) in enumerate(((12, 3), (-8, 7), (21, 1))):
        cover, _ = book(0.028, 0.23 - 0.02 * k, 0.165 - 0.01 * k, column)
        room.add("spines", placed(placed(cover, roll=90), (x + 0.06, level, z - 0.2), turn), flat=True)
        room.add("pages",
                 placed(box((-0.2 + 0.02 * k, 0.003, -0.15), (-0.005, 0.025, -0.004)), (x + 0.06, level, z - 0.2),
                        turn),
                 flat=True)
        level += 0.0285


def plant(room, x, z, dice):
    """A rubber plant of many large leaves."""
    pot = [(0, 0), (0.13, 0), (0.13, 0), (0.17, 0.26), (0.185, 0.265), (0.185, 0.30), (0.165, 0.30), (0.16, 0.25)]
    room.add("clay", placed(lathe(pot, 40), (x, 0, z)))
    room.add("soil", placed(lathe([(0.163, 0.26), (0, 0.27)], 24), (x, 0, z)))
    for stem in range(4):
        lean, side = dice.uniform(0.05, 0.22), stem * 90 + dice.uniform(-30, 30)
        height = dice.uniform(0.9, 1.5)
        points = [(x + (0.03 + lean * t * t) * math.sin(math.radians(side)), 0.25 + height * t,
                   z + (0.03 + lean * t * t) * math.cos(math.radians(side))) for t in (0, 0.25, 0.5, 0.75, 1)]
        room.add("bark", pipe(points, [0.013, 0.011, 0.009, 0.007, 0.003], 8))
        for k in range(11):
            t = 0.22 + 0.78 * k / 10
            foot = (x + (0.03 + lean * t * t) * math.sin(math.radians(side)), 0.25 + height * t,
                    z + (0.03 + lean * t * t) * math.cos(math.radians(side)))
            blade = leaf_blade(dice.uniform(0.20, 0.30) * (1.1 - 0.4 * t), 0.10, dice.uniform(0.2, 0.7))
            room.add("leaves", placed(blade, foot, turn=137.5 * k + side, roll=18 + 45 * t))


def pictures(room):
    for name, z, y, width in (("picture_a", -0.9, 1.35, 0.78), ("picture_b", 0.55, 1.42, 0.6)):
        height = width * 0.75
        room.add(name,
                 placed(quad((0, 0, 0.012), (width, 0, 0), (0, height, 0)), (RIGHT, y, z - width / 2), turn=-90),
                 flat=True)
        room.add("brass",
                 placed(frame((-0.04, -0.04), (width + 0.04, height + 0.04), 0.045, 0.03), (RIGHT, y, z - width / 2),
                        turn=-90),
                 flat=True)


def reading_room():
    dice = random.Random(2024)
    room = Room("reading_room",
                "A reading room in the evening sun: shelves of books, a sofa, a rug, windows with bars, a lamp.")
    room.camera((1.75, 1.32, 2.4), (-0.38, 0.98, -0.9), 66)
    materials(room)
    shell(room)
    for k, hole in enumerate(WINDOWS):
        window(room, hole, blind=k == 1)
    drapery(room)
    bookcase(room, -1.62, 4, dice)
    room.add(
        "rug",
        grid(
            40, 28, lambda u, v:
            (-1.35 + 2.55 * u, 0.006 + 0.003 * math.sin(11 * u + 3 * v) * math.sin(7 * v), 1.05 - 1.75 * v)))
    sofa(room, (0.15, 0, -1.28), 0)
    table(room, -0.35, 0.2)
    floor_lamp(room, 1.5, -1.3)
    plant(room, -2.15, -1.75, dice)
    pictures(room)
    room.head.append(sky("evening_sky.hdr", 250, 16))
    return room
