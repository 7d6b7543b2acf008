#!/usr/bin/env python3
"""media_rooms.py FOLDER: writes four scenes with media for against_mitsuba.py, in Mitsuba 3's syntax.

fog: a lamp in a room full of fog. lamp: a bulb in a room full of thin fog. milk: a ball of a dense coloured medium, whose phase function is a sum, under a lamp
and a sky. smoke: a grid of densities with an albedo of varying colours. Each is FOLDER/NAME/scene.xml.
"""
import math
import os
import struct
import sys

SCENE = """<scene version="3.0.0">
  <integrator type="volpath"><integer name="max_depth" value="17"/><integer name="rr_depth" value="8"/></integrator>
  <sensor type="perspective">
    <float name="fov" value="40"/>
    <transform name="to_world"><lookat origin="0, 0, 6" target="0, 0, 0" up="0, 1, 0"/></transform>
    <film type="hdrfilm"><integer name="width" value="160"/><integer name="height" value="90"/>
      <rfilter type="box"/></film>
  </sensor>
  {0}
</scene>
"""

WALL = '<bsdf type="twosided"><bsdf type="diffuse"><rgb name="reflectance" value="{0}"/></bsdf></bsdf>'


def rectangle(transform, inside):
    return f'<shape type="rectangle"><transform name="to_world">{transform}</transform>{inside}</shape>'


def lamp(size, height, radiance):
    place = f'<scale x="{size}" y="{size}"/><rotate x="1" angle="90"/><translate y="{height}"/>'
    return rectangle(place, f'<emitter type="area"><rgb name="radiance" value="{radiance}"/></emitter>')


def room():
    return "".join(
        rectangle(f'<scale value="2"/>{turn}', WALL.format(color))
        for turn, color in (
            ('<rotate x="1" angle="-90"/><translate y="-2"/>', "0.6"),
            ('<rotate x="1" angle="90"/><translate y="2"/>', "0.6"),
            ('<translate z="-2"/>', "0.6"),
            ('<rotate y="1" angle="90"/><translate x="-2"/>', "0.6, 0.1, 0.1"),
            ('<rotate y="1" angle="-90"/><translate x="2"/>', "0.1, 0.5, 0.1"),
        )
    )


def volume(name, file):
    return (
        f'<volume name="{name}" type="gridvolume"><string name="filename" value="{file}"/>'
        '<transform name="to_world"><translate x="-0.5" y="-0.5" z="-0.5"/><scale value="3"/></transform></volume>'
    )


def write_volume(path, size, channels, value):
    with open(path, "wb") as file:
        file.write(b"VOL\x03" + struct.pack("<5i6f", 1, size, size, size, channels, 0, 0, 0, 1, 1, 1))
        for z in range(size):
            for y in range(size):
                for x in range(size):
                    file.write(struct.pack(f"<{channels}f", *value(x / size, y / size, z / size)))


def smoke(x, y, z):
    square = (x - 0.5) ** 2 + (z - 0.5) ** 2
    curl = 0.5 + 0.5 * math.sin(17 * x + 5 * math.sin(9 * y)) * math.cos(13 * z + 4 * y)
    return (math.exp(-square / (0.02 + 0.06 * y)) * curl,)


def write(folder, name, inside):
    os.makedirs(os.path.join(folder, name), exist_ok=True)
    with open(os.path.join(folder, name, "scene.xml"), "w", encoding="utf-8") as file:
        file.write(SCENE.format(inside))


def main():
    folder = sys.argv[1]
    fog = (
        '<medium name="interior" type="homogeneous"><rgb name="albedo" value="0.9, 0.85, 0.8"/>'
        '<float name="sigma_t" value="0.35"/><phase type="hg"><float name="g" value="0.4"/></phase></medium>'
    )
    cube = '<shape type="cube"><transform name="to_world"><scale value="1.95"/></transform><bsdf type="null"/>'
    write(folder, "fog", room() + lamp(0.25, 1.5, "40") + cube + fog + "</shape>")
    haze = (
        '<medium name="interior" type="homogeneous"><rgb name="albedo" value="0.9, 0.9, 0.9"/>'
        '<float name="sigma_t" value="0.04"/><phase type="hg"><float name="g" value="0.3"/></phase></medium>'
    )
    bulb = (
        '<shape type="sphere"><point name="center" x="0.3" y="0.2" z="0.4"/><float name="radius" value="0.05"/>'
        '<emitter type="area"><rgb name="radiance" value="900, 800, 600"/></emitter></shape>'
    )
    write(folder, "lamp", room() + bulb + cube + haze + "</shape>")
    milk = (
        '<medium name="interior" type="homogeneous"><rgb name="albedo" value="0.99, 0.97, 0.9"/>'
        '<rgb name="sigma_t" value="0.5, 0.7, 1"/><float name="scale" value="7"/><phase type="blendphase"><float name="weight" value="0.3"/>'
        '<phase type="hg"><float name="g" value="0.6"/></phase><phase type="isotropic"/></phase></medium>'
    )
    sky = '<emitter type="constant"><rgb name="radiance" value="0.2, 0.25, 0.3"/></emitter>'
    floor = rectangle('<scale value="6"/><rotate x="1" angle="-90"/><translate y="-1.6"/>', WALL.format("0.5"))
    ball = '<shape type="sphere"><float name="radius" value="1.4"/><bsdf type="null"/>'
    write(folder, "milk", sky + floor + lamp(1, 3, "10, 9, 8") + ball + milk + "</shape>")
    write(
        folder,
        "smoke",
        sky + floor + lamp(1, 3, "10, 9, 8")
        + '<shape type="cube"><transform name="to_world"><scale value="1.5"/></transform><bsdf type="null"/>'
        + '<medium name="interior" type="heterogeneous"><float name="scale" value="6"/>'
        + volume("sigma_t", "density.vol") + volume("albedo", "albedo.vol") + "</medium></shape>",
    )
    place = os.path.join(folder, "smoke")
    write_volume(os.path.join(place, "density.vol"), 32, 1, smoke)
    write_volume(os.path.join(place, "albedo.vol"), 8, 3, lambda x, y, z: (0.95, 0.95 - 0.5 * y, 0.5 + 0.4 * x))


if __name__ == "__main__":
    main()
