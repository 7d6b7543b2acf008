"""Computed surroundings, 256 x 128: a photographer's studio, an overcast sky, a room with a window.
+z, where views of models without a camera stand, is the side that the main lights are on."""

import math

from files import hdr
from pictures import mix, noise, smooth

WIDTH, HEIGHT = 256, 128


def _around(at):
    """The picture of at(d), the mean of four directions in each texel."""
    radiance = []
    for y in range(HEIGHT):
        for x in range(WIDTH):
            colors = []
            for k in range(4):
                theta = math.pi * (y + 0.25 + 0.5 * (k // 2)) / HEIGHT
                phi = 2 * math.pi * ((x + 0.25 + 0.5 * (k % 2)) / WIDTH - 0.5)
                colors.append(at((math.sin(theta) * math.sin(phi), math.cos(theta), -math.sin(theta) * math.cos(phi))))
            radiance.append(tuple(sum(c) / 4 for c in zip(*colors)))
    return hdr(WIDTH, HEIGHT, radiance)


def _softbox(d, azimuth, elevation, half_width, half_height):
    """How much a direction sees of a rectangle that faces the middle, with a soft rim: 0 to 1.
    Degrees; azimuth from +z towards +x."""
    a, e = math.radians(azimuth), math.radians(elevation)
    middle = (math.cos(e) * math.sin(a), math.sin(e), math.cos(e) * math.cos(a))
    right = (math.cos(a), 0, -math.sin(a))
    up = (-math.sin(e) * math.sin(a), math.cos(e), -math.sin(e) * math.cos(a))
    along = sum(p * q for p, q in zip(d, middle))
    if along <= 0:
        return 0.0
    x = abs(sum(p * q for p, q in zip(d, right))) / along / math.tan(math.radians(half_width))
    y = abs(sum(p * q for p, q in zip(d, up))) / along / math.tan(math.radians(half_height))
    return (1 - smooth(0.94, 1.02, x)) * (1 - smooth(0.94, 1.02, y))


def studio():
    """A dim hall with a large key light at the right of the front, a wide fill, a roof and a rim light."""
    lights = ((40, 38, 24, 19, (9.0, 8.7, 8.2)), (-62, 18, 26, 30, (1.5, 1.6, 1.8)),
              (0, 88, 30, 22, (3.0, 3.0, 3.0)), (-155, 32, 7, 30, (14.0, 14.4, 15.0)))

    def at(d):
        color = mix((0.10, 0.10, 0.105), (0.22, 0.22, 0.23), 0.5 - 0.5 * d[1])
        for azimuth, elevation, width, height, light in lights:
            share = _softbox(d, azimuth, elevation, width, height)
            color = tuple(c + share * l for c, l in zip(color, light))
        return color

    return _around(at)


def overcast():
    """The sky that is three times as bright overhead as at the horizon (Moon and Spencer 1942),
    with clouds, over a meadow."""
    def at(d):
        if d[1] < 0:
            return mix((0.16, 0.17, 0.14), (0.10, 0.115, 0.07), min(1.0, -4 * d[1]))
        around = math.atan2(d[0], -d[2]) / (2 * math.pi) + 0.5
        cloud = noise(16 * around, 6 * d[1], 16, 64, 31) * 0.6 + noise(40 * around, 14 * d[1], 40, 64, 32) * 0.4
        bright = 0.42 * (1 + 2 * d[1]) * (0.88 + 0.24 * cloud * smooth(0, 0.2, d[1]) * (1 - d[1]))
        return tuple(bright * c for c in (0.95, 1.0, 1.08))

    return _around(at)


def interior():
    """A room of 6 x 2.7 x 5 m seen from its middle, 1.2 m above the floor: a window in the wall at +z,
    right of the middle, and a lamp at the ceiling."""
    low, high = (-3.0, -1.2, -2.5), (3.0, 1.5, 2.5)

    def window(x, y):
        inside = 0.2 < x < 2.2 and -0.3 < y < 1.1
        frame = abs(x - 1.2) < 0.04 or abs(y - 0.4) < 0.03
        return inside and not frame

    def at(d):
        steps = [((high if c > 0 else low)[i] / c, i) for i, c in enumerate(d) if c != 0]
        distance, axis = min(steps)
        p = tuple(distance * c for c in d)
        if axis == 2 and d[2] > 0 and window(p[0], p[1]):
            return mix((5.5, 6.2, 5.0), (9.5, 11.0, 13.0), (p[1] + 0.3) / 1.0)
        # What the window, a point of light in its middle, brings to the surface, and a rest of bounces.
        to = (1.2 - p[0], 0.4 - p[1], 2.45 - p[2])
        far = max(sum(t * t for t in to), 0.3)
        inward = -1 if d[axis] > 0 else 1
        facing = max(0.0, inward * to[axis]) / math.sqrt(far)
        light = 0.28 + 3.2 * facing * max(0.0, to[2]) / far ** 1.5
        if axis == 1 and d[1] > 0:
            lamp = math.hypot(p[0] + 1.0, p[2] + 0.6)
            if lamp < 0.25:
                return (16.0, 13.0, 9.5)
            return tuple(c * light * (1 + 0.8 / (1 + 6 * lamp * lamp)) for c in (0.62, 0.60, 0.57))
        if axis == 1:
            board = noise(2 * (p[0] + 4), 16 * (p[2] + 4), 64, 256, 33)
            return tuple(c * light for c in mix((0.24, 0.14, 0.07), (0.36, 0.22, 0.12), board))
        wall = (0.50, 0.47, 0.42) if axis == 2 else (0.42, 0.44, 0.44)
        return tuple(c * light for c in wall)

    return _around(at)
