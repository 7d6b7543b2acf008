"""Stromboli: a path tracer in Vulkan compute shaders.

>>> import stromboli
>>> scene = stromboli.load("room.xml")
>>> picture = stromboli.render(scene, samples=64, width=640, height=360)
>>> picture.save("room.png")
>>> picture.mean(), picture.noise, picture.layers

A picture is a numpy array of height x width x 3 float32 radiances. Messages go to the logger
"stromboli". docs/guide/python.md has more.
"""

from . import _stromboli
from .errors import (
    DeviceError,
    DeviceLostError,
    OutputError,
    SceneError,
    StromboliError,
    UsageError,
)
from .judging import AnyPicture, Check, Comparison, check, compare, denoise
from .pictures import Noise, Picture, read
from .scenes import Scene, SceneBuilder, load
from .sessions import Progress, Session, release, render

__version__: str = _stromboli.version()


def material_kinds() -> list[str]:
    """The kinds of materials that ``SceneBuilder.material`` makes."""
    return _stromboli.material_kinds()


def material_parameters(kind: str) -> dict[str, str]:
    """The parameters of a kind of material, with what they mean."""
    return _stromboli.material_parameters(kind)


def settings() -> dict[str, str]:
    """The settings of ``render`` by name, with what they mean."""
    return _stromboli.picture_settings()


__all__ = [
    "AnyPicture",
    "Check",
    "Comparison",
    "DeviceError",
    "DeviceLostError",
    "Noise",
    "OutputError",
    "Picture",
    "Progress",
    "Scene",
    "SceneBuilder",
    "SceneError",
    "Session",
    "StromboliError",
    "UsageError",
    "check",
    "compare",
    "denoise",
    "load",
    "material_kinds",
    "material_parameters",
    "read",
    "release",
    "render",
    "settings",
]
