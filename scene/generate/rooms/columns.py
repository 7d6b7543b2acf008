"""Columns with fluted shafts and carved capitals."""

import math

from forms import box, cushion, grid, lathe, pipe, placed
from shapes import arc


def fluted(radius, bottom, top, flutes, per_flute, rows):
    """A shaft that narrows upwards, with hollows that end round below and above."""
    height = top - bottom

    def at(u, v):
        y = bottom + height * v
        swell = radius * (1 - 0.16 * v * v + 0.02 * math.sin(math.pi * v))
        near = min(v, 1 - v) * height
        ends = min(1.0, max(0.0, (near - 0.04) / 0.10))
        hollow = 0.075 * radius * math.sqrt(ends * (2 - ends)) * abs(math.sin(math.pi * flutes * u)) ** 0.7
        return ((swell - hollow) * math.sin(2 * math.pi * u), y, (swell - hollow) * math.cos(2 * math.pi * u))

    # Rows are close where the hollows end.
    near = [0.0, 0.016, 0.022, 0.03, 0.04, 0.055, 0.07]
    levels = near + [0.07 + 0.86 * k / rows for k in range(1, rows)] + [1 - t for t in reversed(near)]

    def line(v):
        k = min(int(v * (len(levels) - 1) + 1e-9), len(levels) - 2)
        return levels[k] + (levels[k + 1] - levels[k]) * (v * (len(levels) - 1) - k)

    return grid(flutes * per_flute, len(levels) - 1, lambda u, v: at(u, line(v)))


def acanthus(radius, bottom, reach, width):
    """A leaf of a capital, on the side of +z: it leans out and curls."""
    def at(u, v):
        curl = max(0.0, v - 0.62) / 0.38
        out = radius + 0.035 + 0.05 * v * v + 0.085 * reach * math.sin(curl * 2.3) * 2
        y = bottom + reach * (min(v, 0.62) + 0.30 * math.sin(curl * 2.6) * 0.62)
        half = width * (0.55 + 0.45 * math.sin(math.pi * min(1.0, v * 0.9 + 0.1))) * (1 - 0.5 * curl)
        lobes = 1 + 0.13 * math.cos(18 * math.pi * v * 0.5)
        x = (u - 0.5) * 2 * half * lobes
        rib = 0.014 * math.cos(4 * math.pi * (u - 0.5)) + 0.010 * math.cos(10 * math.pi * (u - 0.5))
        return (x, y, out + rib - 2.0 * x * x)

    return grid(12, 14, at)


def column(group, height, radius, flutes):
    """Plinth, base, shaft, capital with two rows of leaves and corner scrolls, abacus."""
    base = [(0, 0.10), (radius * 1.42, 0.10)] + arc(
        (radius * 1.36, 0.145), 0.045, -80, 80, 8) + [(radius * 1.26, 0.195)]
    base += arc((radius * 1.30, 0.225), 0.025, 250, 110, 5) + arc(
        (radius * 1.20, 0.272), 0.024, -70, 80, 6) + [(radius * 1.04, 0.31)]
    group.add("stone", lathe(base, 48))
    plinth = radius * 1.45
    group.add("carved", box((-plinth, 0, -plinth), (plinth, 0.10, plinth)), flat=True)
    neck = height - 0.50
    group.add("stone", fluted(radius, 0.30, neck, flutes, 6, 12))
    slim = radius * 0.86
    bell = [(slim, neck - 0.01)] + arc((slim, neck + 0.015), 0.02, -80, 80, 6) + [(slim, neck + 0.05),
                                                                                  (slim * 1.02, neck + 0.2),
                                                                                  (slim * 1.28, neck + 0.40)]
    group.add("carved", lathe(bell, 32))
    for row, (count, shift, low, reach) in enumerate(((8, 0, 0.045, 0.17), (8, 22.5, 0.10, 0.27))):
        for k in range(count):
            group.add(
                "carved",
                placed(acanthus(slim - 0.02, neck + low, reach, 0.058 * radius / 0.17), turn=360 * k / count + shift))
    for k in range(4):
        turns = []
        for i in range(26):
            a = 2.2 * math.pi * i / 25
            r = 0.055 * (1 - 0.72 * i / 25)
            turns.append((0, neck + 0.365 + r * math.cos(a), slim * 1.38 + 0.02 + r * math.sin(a)))
        group.add("carved", placed(pipe(turns, [0.014 - 0.006 * i / 25 for i in range(26)], 8), turn=45 + 90 * k))
    side = radius * 1.52
    abacus = cushion((2 * side, 0.085, 2 * side), 0.02, 2, 1)
    group.add("carved", placed(abacus, (0, height - 0.0425, 0)))
