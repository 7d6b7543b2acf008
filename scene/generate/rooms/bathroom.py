"""scene/library/bathroom.xml: tiles, a large mirror, chrome, a shower behind glass, bottles; lit by a frosted window,
by two bulbs within globes of glass and by a lamp at the ceiling."""

import math
import random

from forms import (box, curtain, curve, cushion, frame, grid, lathe, leaf_blade, panel, pipe, placed, quad, smoothed,
                   wall)
from materials import (ball_lamp, brass, bsdf, diffuse, glass, glazed, metal, mirror, number, panel_lamp, principled,
                       rgb, sky, thin_glass, varnished)
from room import Room
from shapes import arc
from surfaces import floor_boards, landscape, stone, tile_relief, tiles

LEFT, RIGHT, BACK, FRONT, HEIGHT = -1.55, 1.5, -1.45, 2.0, 2.5
WINDOW = (1.05, 1.08, 2.15, 2.05)  # of the right wall, from its back end: left, bottom, right, top
SCREEN = -0.42  # x of the shower's screen
COUNTER = 0.82


def tinted(color):
    return bsdf("dielectric", number("int_ior", 1.5), number("ext_ior", 1), rgb("specular_transmittance", color))


def materials(room):
    sage = [(0.62, 0.74, 0.69), (0.66, 0.77, 0.71), (0.58, 0.71, 0.67), (0.64, 0.74, 0.66)]
    room.material("tiles", varnished(room.picture("tiles", tiles(sage, (0.87, 0.86, 0.83), 6, 0.035, 2)), 0.05,
                                     room.picture("tiles_relief", tile_relief(6, 0.035, 2))))
    room.material(
        "mosaic",
        varnished(
            room.picture(
                "mosaic",
                tiles([(0.90, 0.88, 0.84), (0.87, 0.85, 0.81), (0.91, 0.89, 0.85), (0.22, 0.26, 0.28)],
                      (0.62, 0.61, 0.59), 8, 0.05, 9)), 0.12, room.picture("mosaic_relief", tile_relief(8, 0.05, 9))))
    room.material("plaster", diffuse((0.80, 0.77, 0.71)))
    room.material("white", glazed((0.84, 0.84, 0.82)))
    room.material("paint", varnished((0.78, 0.76, 0.72), 0.2))
    room.material("marble",
                  varnished(room.picture("marble", stone((0.93, 0.92, 0.90), (0.62, 0.62, 0.63), 14, 192)), 0.06))
    room.material(
        "walnut",
        varnished(room.picture("walnut", floor_boards((0.52, 0.36, 0.22), (0.32, 0.20, 0.12), 23, 192, 3)), 0.2))
    room.material("chrome", metal("Cr"))
    room.material("steel", metal("Cr", 0.18))
    room.material("brass", brass(0.1))
    room.material("mirror", mirror())
    room.material("glass", glass(1.52))
    room.material("hollow", bsdf("dielectric", number("int_ior", 1), number("ext_ior", 1.52)))
    room.material("pane", thin_glass())
    room.material("frosted", glass(1.5, 0.25))
    for name, color in (("green_glass", (0.45, 0.85, 0.62)), ("amber_glass", (0.95, 0.62, 0.22)), ("blue_glass",
                                                                                                   (0.45, 0.66, 0.95))):
        room.material(name, tinted(color))
    room.material("towel", diffuse((0.70, 0.36, 0.24)))
    room.material("linen", diffuse((0.80, 0.77, 0.70)))
    room.material("soap", principled((0.82, 0.73, 0.55), roughness=0.4))
    room.material("leaves", varnished((0.06, 0.20, 0.06), 0.15))
    room.material("soil", diffuse((0.05, 0.035, 0.025)))
    room.material("picture", varnished(room.picture("picture", landscape(83)), 0.3))


def shell(room):
    width, length, tiled = RIGHT - LEFT, FRONT - BACK, 2.14
    for name, bottom, top in (("tiles", 0, tiled), ("plaster", tiled, HEIGHT)):
        reach = top - bottom
        hole = [WINDOW] if bottom == 0 else []
        room.add(name, wall((LEFT, bottom, BACK), (1, 0, 0), width, reach, (), 0, 1.1), flat=True)
        room.add(name, wall((LEFT, bottom, FRONT), (0, 0, -1), length, reach, (), 0, 1.1), flat=True)
        room.add(name, wall((RIGHT, bottom, BACK), (0, 0, 1), length, reach, hole, 0.2, 1.1), flat=True)
        room.add(name, wall((RIGHT, bottom, FRONT), (-1, 0, 0), width, reach, (), 0, 1.1), flat=True)
    room.add("plaster", quad((LEFT, HEIGHT, BACK), (width, 0, 0), (0, 0, length)), flat=True)
    room.add("mosaic", panel((LEFT, 0, FRONT), (width, 0, 0), (0, 0, -length), 1.6), flat=True)
    for x0, z0, x1, z1 in ((LEFT, BACK, RIGHT, BACK + 0.02), (LEFT, BACK, LEFT + 0.02, FRONT),
                           (RIGHT - 0.02, BACK, RIGHT, FRONT)):
        room.add("white", box((x0, tiled - 0.025, z0), (x1, tiled + 0.025, z1)), flat=True)


def window(room):
    z0, z1, y0, y1 = BACK + WINDOW[0], BACK + WINDOW[2], WINDOW[1], WINDOW[3]
    bars = frame((0, 0), (z1 - z0, y1 - y0), 0.055, 0.06)
    bars.append(box(((z1 - z0) / 2 - 0.03, 0.05, 0.005), ((z1 - z0) / 2 + 0.03, y1 - y0 - 0.05, 0.055)))
    bars.append(box((0.05, 0.62 * (y1 - y0) - 0.012, 0.012), (z1 - z0 - 0.05, 0.62 * (y1 - y0) + 0.012, 0.048)))
    room.add("paint", placed(bars, (RIGHT + 0.15, y0, z0), turn=-90), flat=True)
    room.add("frosted", box((RIGHT + 0.118, y0 + 0.03, z0 + 0.03), (RIGHT + 0.123, y1 - 0.03, z1 - 0.03)), flat=True)
    room.add("marble", box((RIGHT - 0.05, y0 - 0.03, z0 - 0.05), (RIGHT + 0.145, y0 + 0.002, z1 + 0.05)), flat=True)


def bottle(room, name, place, radius, height, stopper=None):
    """A hollow bottle: up outside, down inside."""
    neck = radius * 0.36
    wide = height * 0.62
    line = [(0, 0.001), (radius * 0.85, 0.001)] + arc((radius - 0.006, 0.007), 0.006, -80, 0, 4)
    line += [(radius, wide)] + [(neck + (radius - neck) * math.cos(math.radians(a)), wide +
                                 (radius - neck) * math.sin(math.radians(a)))
                                for a in range(15, 90, 15)] + [(neck, height), (neck + 0.003, height + 0.002),
                                                               (neck + 0.003, height + 0.006),
                                                               (neck - 0.003, height + 0.006)]
    r = radius - 0.0035
    line += [(neck - 0.0035, height), (neck - 0.0035, wide + radius - neck)] + [
        (neck - 0.0035 + (r - neck + 0.0035) * math.cos(math.radians(a)), wide + (r - neck) * math.sin(math.radians(a)))
        for a in range(75, 0, -15)] + [(r, wide), (r, 0.012), (r * 0.8, 0.007), (0, 0.006)]
    room.add(name, placed(lathe(line, 40, False), place))
    if stopper:
        x, y, z = place
        room.add(
            stopper,
            placed(lathe(arc((0, 0), neck * 1.5, -90, 90, 12), 24, False), (x, y + height + 0.007 + neck * 1.5, z)))


def vanity(room):
    x0, x1, front = -0.30, 1.28, BACK + 0.52
    room.add("marble", box((x0, COUNTER - 0.04, BACK), (x1, COUNTER, front), (2, 2)), flat=True)
    room.add("marble", box((x0, COUNTER, BACK), (x1, COUNTER + 0.08, BACK + 0.018), (2, 2)), flat=True)
    room.add("walnut", box((x0 + 0.02, 0.30, BACK), (x1 - 0.02, COUNTER - 0.04, front - 0.03), (1, 1)), flat=True)
    for k in range(3):
        a = x0 + 0.04 + 0.51 * k
        for y, high in ((0.33, 0.20), (0.55, 0.20)):
            room.add("walnut", placed(box((0, 0, 0), (0.475, high, 0.018), (1, 1)), (a, y, front - 0.03)), flat=True)
            room.add(
                "brass",
                pipe(
                    curve([(a + 0.17, y + high / 2, front - 0.012), (a + 0.18, y + high / 2, front + 0.016),
                           (a + 0.295, y + high / 2, front + 0.016), (a + 0.305, y + high / 2, front - 0.012)], 5),
                    0.005, 10))
    middle = (0.49, COUNTER, BACK + 0.27)
    basin = [(0, 0.0), (0.11, 0.0), (0.13, 0.008), (0.20, 0.10), (0.215, 0.13), (0.216, 0.136), (0.211, 0.139),
             (0.205, 0.136), (0.19, 0.10), (0.12, 0.025), (0.03, 0.016), (0, 0.016)]
    room.add("white", placed(lathe(basin, 64), middle))
    room.add("chrome", placed(lathe([(0.022, 0.018), (0.02, 0.021), (0, 0.021)], 20), middle))
    tap(room, (middle[0], COUNTER, BACK + 0.085), 0.26)
    things(room, middle)


def tap(room, place, height):
    x, y, z = place
    room.add("chrome",
             placed(lathe([(0, 0), (0.027, 0), (0.027, 0.006), (0.018, 0.012), (0.016, 0.05), (0, 0.05)], 32), place))
    spout = curve([(x, y + 0.03, z), (x, y + height * 0.75, z), (x, y + height, z + 0.06),
                   (x, y + height * 0.9, z + 0.14), (x, y + height * 0.72, z + 0.155)], 10)
    room.add("chrome", pipe(spout, 0.0115, 20))
    for side in (-1, 1):
        room.add(
            "chrome",
            placed(
                lathe([(0, 0), (0.022, 0), (0.022, 0.005), (0.013, 0.012), (0.012, 0.045), (0.017, 0.05),
                       (0.017, 0.056), (0, 0.06)], 28), (x + side * 0.11, y, z)))
        room.add("chrome",
                 pipe([(x + side * 0.11, y + 0.052, z), (x + side * 0.165, y + 0.064, z + 0.012)], [0.006, 0.004], 12))


def things(room, middle):
    x, y, z = middle
    bottle(room, "green_glass", (x - 0.52, y, BACK + 0.13), 0.042, 0.21, "glass")
    bottle(room, "amber_glass", (x - 0.42, y, BACK + 0.19), 0.034, 0.15, "brass")
    bottle(room, "glass", (x - 0.62, y, BACK + 0.22), 0.03, 0.12, "brass")
    dish = [(0, 0.002), (0.05, 0.002), (0.062, 0.014), (0.06, 0.015), (0.048, 0.006), (0, 0.006)]
    room.add("white", placed(lathe(dish, 36), (x + 0.38, y, z + 0.06)))
    room.add("soap", placed(cushion((0.075, 0.028, 0.05), 0.012), (x + 0.38, y + 0.021, z + 0.06), 25))
    tumbler = [(0, 0.001), (0.031, 0.001), (0.033, 0.003), (0.036, 0.098), (0.0345, 0.1), (0.033, 0.098),
               (0.0305, 0.012), (0, 0.011)]
    room.add("glass", placed(lathe(tumbler, 40, False), (x + 0.55, y, BACK + 0.16)))
    for dx, dz, name in ((0.017, 0.008, "towel"), (-0.012, 0.017, "linen")):
        foot = (x + 0.55 - 0.5 * dx, y + 0.014, BACK + 0.16 - 0.5 * dz)
        top = (foot[0] + 1.7 * dx, y + 0.19, foot[2] + 1.7 * dz)
        room.add(name, pipe([foot, top], 0.0042, 8))
        room.add("linen",
                 placed(box((-0.005, -0.014, 0.003), (0.005, 0.014, 0.014)), (top[0], top[1] - 0.014, top[2])),
                 flat=True)
    bottle(room, "blue_glass", (RIGHT + 0.03, WINDOW[1] + 0.002, 0.12), 0.036, 0.17, "glass")
    bottle(room, "amber_glass", (RIGHT + 0.04, WINDOW[1] + 0.002, 0.24), 0.027, 0.12, "brass")


def looking_glass(room):
    x0, y0, x1, y1 = -0.16, 1.08, 1.14, 2.0
    room.add("mirror", quad((x0, y0, BACK + 0.012), (x1 - x0, 0, 0), (0, y1 - y0, 0)), flat=True)
    room.add("brass",
             placed(frame((x0 - 0.025, y0 - 0.025), (x1 + 0.025, y1 + 0.025), 0.03, 0.025), (0, 0, BACK)),
             flat=True)
    for x in (x0 - 0.115, x1 + 0.125):
        y, z = 1.62, BACK + 0.13
        room.add(
            "brass",
            placed(placed(lathe([(0, 0), (0.045, 0), (0.045, 0.012), (0.02, 0.02), (0, 0.02)], 32), tilt=90),
                   (x, y - 0.17, BACK)))
        arm = curve([(x, y - 0.17, BACK + 0.01), (x, y - 0.18, z - 0.02), (x, y - 0.15, z), (x, y - 0.085, z)], 8)
        room.add("brass", pipe(arm, 0.008, 14))
        room.add(
            "brass",
            placed(
                lathe([(0, -0.10), (0.035, -0.095), (0.04, -0.086), (0.018, -0.086), (0.014, -0.05), (0, -0.05)], 32),
                (x, y, z)))
        for radius, name in ((0.0851, "glass"), (0.082, "hollow")):
            room.raw.append(
                f'<shape type="sphere"><point name="center" x="{x:g}" y="{y:g}" z="{z:g}"/>{number("radius", radius)}'
                f'<ref id="{name}"/></shape>')
        room.raw.append(ball_lamp((x, y, z), 0.05, (36, 27, 17)))


def shower(room):
    top, z1 = 2.02, BACK + 1.0
    room.add("glass", box((SCREEN - 0.01, 0.03, BACK + 0.012), (SCREEN, top, z1)), flat=True)
    room.add("pane", quad((LEFT + 0.35, 0.03, z1 + 0.012), (SCREEN - LEFT - 0.36, 0, 0), (0, top - 0.03, 0)), flat=True)
    room.add("chrome", box((SCREEN - 0.02, 0.0, BACK), (SCREEN + 0.01, 0.03, z1 + 0.02)), flat=True)
    room.add("chrome", box((LEFT, 0.0, z1), (SCREEN + 0.01, 0.028, z1 + 0.025)), flat=True)
    room.add("chrome", box((SCREEN - 0.02, 0.03, BACK), (SCREEN + 0.01, top, BACK + 0.012)), flat=True)
    room.add("chrome", box((SCREEN - 0.018, top, BACK), (SCREEN + 0.008, top + 0.02, z1 + 0.01)), flat=True)
    room.add(
        "brass",
        pipe(
            curve([(SCREEN - 0.10, 0.92, z1 + 0.013), (SCREEN - 0.10, 0.92, z1 + 0.055),
                   (SCREEN - 0.10, 1.20, z1 + 0.055), (SCREEN - 0.10, 1.20, z1 + 0.013)], 4), 0.008, 12))
    x = (LEFT + SCREEN) / 2 - 0.05
    room.add(
        "chrome",
        pipe(curve([(x, 2.06, BACK), (x, 2.09, BACK + 0.12), (x, 2.10, BACK + 0.30), (x, 2.05, BACK + 0.36)], 8), 0.011,
             16))
    room.add(
        "chrome",
        placed(lathe([(0, 0), (0.125, 0), (0.127, 0.006), (0.12, 0.012), (0.03, 0.022), (0.02, 0.05), (0, 0.05)], 48),
               (x, 2.0, BACK + 0.36)))
    room.add("chrome", pipe([(x, 1.12, BACK + 0.04), (x, 2.06, BACK + 0.04)], 0.009, 14))
    room.add("chrome", placed(pipe([(-0.14, 0, 0), (0.14, 0, 0)], 0.021, 24), (x, 1.12, BACK + 0.05)))
    for side in (-1, 1):
        room.add("chrome", placed(pipe([(side * 0.12, 0, 0), (side * 0.155, 0, 0)], 0.027, 24), (x, 1.12, BACK + 0.05)))
        room.add("chrome", placed(pipe([(side * 0.085, 0, 0), (side * 0.085, 0, 0.05)], 0.014, 16), (x, 1.12, BACK)))
    room.add("marble", box((LEFT, 1.0, BACK), (LEFT + 0.12, 1.02, BACK + 0.5), (1, 1)), flat=True)
    bottle(room, "green_glass", (LEFT + 0.06, 1.02, BACK + 0.15), 0.03, 0.16, "steel")
    bottle(room, "blue_glass", (LEFT + 0.06, 1.02, BACK + 0.27), 0.034, 0.13, "steel")
    room.add("linen", placed(cushion((0.09, 0.05, 0.07), 0.02), (LEFT + 0.06, 1.045, BACK + 0.4), 15))


def tub(room, x, z):
    """A round bath, stretched to an oval: half a metre high, on brass feet."""
    line = [(0, 0.05), (0.70, 0.05), (0.78, 0.08), (0.90, 0.36), (0.98, 0.55), (1.03, 0.585), (1.035, 0.60),
            (1.0, 0.612), (0.95, 0.60), (0.92, 0.55), (0.84, 0.34), (0.70, 0.17), (0.5, 0.125), (0, 0.12)]
    bath = lathe(line, 72)
    bath.positions = [(x + 0.365 * a, b, z + 0.80 * c) for a, b, c in bath.positions]
    room.add("white", smoothed(bath))
    for a in (-1, 1):
        for b in (-1, 1):
            room.add("brass", placed(lathe(arc((0, 0.035), 0.035, -90, 90, 10), 20), (x + a * 0.19, 0, z + b * 0.42)))
    cloth = grid(24, 24, lambda u, v: rim_cloth(x, z, u, v))
    room.add("linen", cloth)


def rim_cloth(x, z, u, v):
    """A towel over the near rim of the bath."""
    s = (v - 0.5) * 0.75
    across = z + 0.15 + 0.36 * u
    rim = x - 0.372 * math.sqrt(max(0.0, 1 - ((across - z) / 0.80) ** 2))
    wave = 0.005 * (1 + math.sin(13 * u + 2 * v))
    bend = 0.028
    a = s / bend
    if abs(a) <= math.pi / 2:
        return (rim - (bend + wave) * math.sin(a), 0.592 + (bend + wave) * math.cos(a), across)
    drop = abs(s) - bend * math.pi / 2
    lean = 0.12 * drop if s > 0 else 0.02 * drop
    return (rim - math.copysign(bend + wave, s) + lean, 0.592 - drop, across)


def front(room):
    """What the mirror shows: a door, a picture, a rail with towels; and towels on the left wall."""
    room.add("paint", box((-0.75, 0, FRONT - 0.03), (0.10, 2.03, FRONT), (1, 1)), flat=True)
    for y0, y1 in ((0.2, 0.9), (1.05, 1.9)):
        room.add("paint", placed(frame((0, y0), (0.6, y1), 0.04, 0.015), (-0.02, 0, FRONT - 0.03), turn=180), flat=True)
    room.add("brass", placed(lathe(arc((0, 0), 0.028, -90, 90, 12), 24), (-0.02, 1.0, FRONT - 0.07)))
    room.add("picture", placed(quad((0, 0, 0.012), (0.6, 0, 0), (0, 0.45, 0)), (1.0, 1.35, FRONT), turn=180), flat=True)
    room.add("walnut",
             placed(frame((-0.04, -0.04), (0.64, 0.49), 0.045, 0.025), (1.0, 1.35, FRONT), turn=180),
             flat=True)
    room.add("brass", pipe([(LEFT + 0.07, 1.32, 0.05), (LEFT + 0.07, 1.32, 0.85)], 0.009, 16))
    for z in (0.08, 0.82):
        room.add("brass", pipe([(LEFT, 1.32, z), (LEFT + 0.07, 1.32, z)], 0.008, 12))
    for name, z0, z1, low in (("towel", 0.14, 0.47, 0.62), ("linen", 0.51, 0.76, 0.78)):
        for out in (0.055, 0.086):
            room.add(
                name,
                curtain((LEFT + out, z0), (LEFT + out, z1), low if out > 0.06 else low + 0.15, 1.333, 2, 0.008, 30, 14))
        room.add(
            name,
            placed(
                grid(20, 6, lambda u, v: (0.0165 * math.cos(math.pi * v), 0.0165 * math.sin(math.pi * v), (z1 - z0) *
                                          (1 - u))), (LEFT + 0.07, 1.325, z0)))


def plant(room, place, dice):
    x, y, z = place
    room.add(
        "white",
        placed(lathe([(0, 0), (0.045, 0), (0.06, 0.09), (0.063, 0.095), (0.056, 0.095), (0.052, 0.08)], 32), place))
    room.add("soil", placed(lathe([(0.054, 0.084), (0, 0.086)], 16), place))
    for k in range(26):
        blade = leaf_blade(dice.uniform(0.12, 0.24), 0.022, dice.uniform(0.5, 1.3), 8, 2)
        room.add("leaves", placed(blade, (x, y + 0.085, z), turn=137.5 * k, roll=dice.uniform(20, 75)))


def bathroom():
    room = Room("bathroom",
                "A bathroom of glass and metal: tiles, a mirror, chrome, a shower, a frosted window, bulbs in globes.")
    room.camera((0.02, 1.42, 1.82), (0.08, 1.06, -0.9), 76)
    materials(room)
    shell(room)
    window(room)
    vanity(room)
    looking_glass(room)
    shower(room)
    tub(room, 1.08, 0.28)
    front(room)
    plant(room, (RIGHT + 0.04, WINDOW[1] + 0.002, 0.46), random.Random(6))
    room.raw.append(panel_lamp((0.1, HEIGHT - 0.012, 0.3), (0.16, 0.16), 90, (46, 40, 32)))
    room.add("brass",
             placed(placed(frame((-0.185, -0.185), (0.185, 0.185), 0.022, 0.03), tilt=90), (0.1, HEIGHT, 0.3)),
             flat=True)
    room.head.append(sky("overcast.hdr", 90, 9))
    return room
