"""Scenes: of files, and made in memory. Lengths are metres, y is up, colours are linear."""

from __future__ import annotations

import logging
import operator
import os
from typing import Any, Optional, Sequence, Union

import numpy as np

from . import _stromboli
from .errors import UsageError

Color = Union[float, Sequence[float], np.ndarray]
Point = Union[Sequence[float], np.ndarray]


def given(settings: dict[str, Any]) -> dict[str, Any]:
    """Without those that are None."""
    return {name: value for name, value in settings.items() if value is not None}


_log = logging.getLogger("stromboli")


def _told(handle: _stromboli.Scene) -> Scene:
    """The scene, when what was left out of it has been said as the command says it."""
    scene = Scene(handle)
    for kind, lines in scene.report.items():
        level = logging.WARNING if kind in ("warnings", "forgiven") else logging.INFO
        for line in lines:
            _log.log(level, "%s", line)
    return scene


class Scene:
    """A scene in memory. It does not change; any number of renders may share it."""

    def __init__(self, handle: _stromboli.Scene) -> None:
        self._handle = handle

    def __repr__(self) -> str:
        return f"<Scene {self.file!r}, {self.triangle_count} triangles>"

    @property
    def file(self) -> str:
        """What it was loaded from, or the name that its builder was given."""
        return self._handle.file

    @property
    def triangle_count(self) -> int:
        """Triangles that a ray can meet, those of each instance counted anew."""
        return self._handle.triangle_count

    @property
    def cameras(self) -> list[str]:
        """Names of its cameras, which ``render(camera=...)`` takes."""
        return self._handle.cameras

    @property
    def bounds(self) -> tuple[tuple[float, float, float], tuple[float, float, float]]:
        """The least and the greatest corner of a box around its geometry, metres."""
        return self._handle.bounds

    @property
    def report(self) -> dict[str, list[str]]:
        """What reading it has left out and forgiven: warnings, forgiven, ignored, assumed."""
        return self._handle.report

    @property
    def materials(self) -> list[dict[str, Any]]:
        """Its materials by number: name, kind and the parameters of the kind."""
        return [self._handle.material(i) for i in range(self._handle.material_count)]

    @property
    def lights(self) -> list[str]:
        """Names of its lights that are not the emission of a surface."""
        return self._handle.lights

    @property
    def objects(self) -> list[str]:
        """Names of its meshes and spheres, of each where it is placed."""
        return self._handle.objects

    def number_of(self, kind: str, which: Union[int, str]) -> int:
        """The number of the first material, light or object of that name. Raises UsageError."""
        if not isinstance(which, str):
            try:
                return operator.index(which)
            except TypeError:
                it = type(which).__name__
                raise UsageError(f"a {kind} is its number or its name, not a {it}") from None
        names = {
            "material": [material["name"] for material in self.materials],
            "light": self.lights,
            "object": self.objects,
        }[kind]
        if which not in names:
            raise UsageError(f"the scene has no {kind} {which!r}")
        return names.index(which)


def load(
    source: Union[str, os.PathLike[str]],
    *,
    environment: Union[None, str, os.PathLike[str], Color] = None,
    sun: Optional[Sequence[float]] = None,
    ground: Optional[Color] = None,
    portal: Optional[str] = None,
    environment_rotation: Optional[float] = None,
    environment_strength: Optional[float] = None,
    fog: Optional[float] = None,
    fog_color: Optional[Color] = None,
    fog_asymmetry: Optional[float] = None,
    default_light: Optional[bool] = None,
    up: Optional[str] = None,
    strict: Optional[bool] = None,
    scene: Optional[int] = None,
    variant: Optional[str] = None,
    at: Optional[float] = None,
    max_texture: Optional[int] = None,
    instances: Optional[str] = None,
) -> Scene:
    """Reads a scene: a file of any format that Stromboli knows, or a bundled scene by its name.

    environment -- light from all around: an equirectangular picture's file, or its radiance
    sun -- a clear sky: degrees clockwise from -z seen from above, degrees above the horizon, and
    maybe haze, 1 to 10
    ground -- a floor under all there is, of this colour, [0, 1]
    portal -- names of objects, with commas between, that are openings to the sky, not surfaces
    environment_rotation -- degrees about the vertical, counter-clockwise seen from above
    environment_strength -- multiplies its radiance
    fog -- extinction of fog that fills the scene, per metre
    fog_color -- the share of its light that is scattered, [0, 1]
    fog_asymmetry -- mean cosine of its phase function, from -0.9999 to 0.9999
    default_light -- False: a scene without any light stays black, in place of getting a plain sky
    up -- "y" or "z": which axis points up in files that do not say so (OBJ, PLY, STL, ...)
    strict -- what breaks the rules of the format is an error
    scene, variant, at -- glTF: number of the scene, set of materials, seconds of the animation
    max_texture -- pictures are halved until no side has more pixels
    instances -- "auto", "on" or "off": whether meshes shown several times share their triangles

    Raises SceneError if it cannot be read.
    """
    if isinstance(environment, os.PathLike):
        environment = os.fspath(environment)
    settings = given(
        {
            "environment": environment,
            "sun": sun,
            "ground": ground,
            "portal": portal,
            "environment_rotation": environment_rotation,
            "environment_strength": environment_strength,
            "fog": fog,
            "fog_color": fog_color,
            "fog_asymmetry": fog_asymmetry,
            "default_light": default_light,
            "up": up,
            "strict": strict,
            "scene": scene,
            "variant": variant,
            "at": at,
            "max_texture": max_texture,
            "instances": instances,
        }
    )
    return _told(_stromboli.load(os.fspath(source), settings))


def _color(color: Color) -> list[float]:
    values = np.asarray(color, dtype=float).ravel()
    return [float(value) for value in np.broadcast_to(values, 3)]


class SceneBuilder:
    """Makes a scene in memory.

    >>> builder = SceneBuilder()
    >>> white = builder.material("diffuse", albedo=0.7)
    >>> builder.sphere((0, 1, 0), 1, white)
    >>> builder.light("point", color=50, position=(2, 4, 3))
    >>> builder.camera((0, 1, 6), (0, 1, 0), fov=35)
    >>> scene = builder.finish()
    """

    def __init__(self, name: str = "scene") -> None:
        self._maker = _stromboli.SceneMaker(name)

    def material(self, kind: str = "diffuse", *, name: str = "", **parameters: Any) -> int:
        """Adds a material and returns its number.

        kind -- diffuse, mirror, refraction, principled, conductor, dielectric, thin_dielectric,
        plastic or burley. ``stromboli.material_parameters(kind)`` lists the parameters; every kind
        has ``emission``, the radiance that it emits, W / (sr m^2).
        """
        return self._maker.material(kind, name, given(parameters))

    def texture(self, image: Any, *, srgb: bool = True) -> int:
        """Adds a picture of height x width x 3 or 4 numbers, from the top, and returns its number.

        image -- of uint8, sRGB unless `srgb` is False; or of floats, which are linear, from -65504
        to 65504, and are kept in 16 bits
        """
        array = np.asarray(image)
        if np.issubdtype(array.dtype, np.floating):
            return self._maker.float_texture(array)
        if array.dtype != np.uint8:
            raise TypeError(f"a texture is an array of uint8 or floats, not of {array.dtype}")
        return self._maker.texture(array, srgb)

    def use_texture(self, material: int, slot: str, texture: int) -> None:
        """The texture multiplies base_color, roughness_metallic or emission, or is the normal map."""
        self._maker.use_texture(material, slot, texture)

    def mesh(
        self,
        positions: Any,
        triangles: Any,
        material: int,
        *,
        normals: Any = None,
        uvs: Any = None,
        transform: Any = None,
        name: str = "mesh",
    ) -> None:
        """Adds a mesh of arrays, which are copied.

        positions -- vertices x 3, metres
        triangles -- triangles x 3 numbers of vertices, counter-clockwise seen from the front
        normals -- vertices x 3; None: triangles are flat
        uvs -- vertices x 2, (0, 0) is the upper left corner of a texture; None: none
        transform -- 4 x 4, to the world; None: the identity
        """
        corners = np.asarray(triangles)
        if corners.size and (corners.dtype.kind not in "iu" or corners.min() < 0):
            raise TypeError("triangles are whole numbers from 0 on")
        matrix = np.eye(4) if transform is None else np.asarray(transform, dtype=float)
        if matrix.shape != (4, 4):
            raise TypeError(f"transform is 4 x 4, not {matrix.shape}")
        none: list[float] = []
        self._maker.mesh(
            name,
            positions,
            corners.astype(np.uint32),
            material,
            none if normals is None else normals,
            none if uvs is None else uvs,
            matrix,
        )

    def sphere(self, center: Point, radius: float, material: int, *, name: str = "sphere") -> None:
        """Adds a sphere; lengths in metres."""
        self._maker.sphere(name, center, radius, material)

    def light(
        self,
        kind: str,
        *,
        color: Color = 1.0,
        position: Point = (0, 0, 0),
        direction: Point = (0, -1, 0),
        size: Point = (1, 1),
        angle: float = 90,
        inner_angle: Optional[float] = None,
        name: str = "",
    ) -> None:
        """Adds a light that is not the emission of a surface.

        kind -- directional, point, spot, ambient or area (a rectangle)
        color -- directional: irradiance, W/m^2; point, spot: intensity, W/sr; else radiance
        direction -- where the light goes: directional, spot, area
        size -- of an area light's rectangle about its position, metres
        angle, inner_angle -- spot: degrees of the whole cone, and of where it is undiminished
        """
        self._maker.light(
            kind, name, _color(color), position, direction, size, angle, inner_angle
        )

    def camera(
        self,
        look_from: Point,
        look_at: Point,
        *,
        up: Point = (0, 1, 0),
        fov: float = 40,
        aperture: float = 0,
        focus: float = 1,
        name: str = "",
    ) -> None:
        """Adds a camera. fov: degrees over the height; aperture: diameter of the lens, metres."""
        self._maker.camera(name, look_from, look_at, up, fov, aperture, focus)

    def environment(self, radiance: Any, *, strength: float = 1, rotation: float = 0) -> None:
        """Light from all around: one or three radiances, or height x width x 3 of them.

        The upper edge is the direction +y, the middle column -z. rotation: degrees about +y.
        """
        array = np.asarray(radiance, dtype=np.float32)
        if array.ndim < 2:
            array = np.broadcast_to(array.ravel(), 3).reshape(1, 1, 3)
        self._maker.environment(array, strength, rotation)

    def finish(self) -> Scene:
        """The scene; the builder is empty afterwards. Without light it gets a plain sky."""
        return _told(self._maker.finish())
