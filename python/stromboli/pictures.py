"""Pictures: arrays of radiance with what is known of it."""

from __future__ import annotations

import os
import tempfile
from typing import Any, Mapping, NamedTuple, Optional, Union

import numpy as np

from . import _stromboli
from .errors import UsageError

_COLORS = ("R", "G", "B")
_COMPONENTS = "RGBXYZUV"


class Noise(NamedTuple):
    """How noisy a picture is: the square root of its relMSE, as a fraction (0.02: 2 %).

    `least` to `most` is a range that holds it in 95 of 100 renders.
    """

    estimate: float
    least: float
    most: float

    def __float__(self) -> float:
        return self.estimate

    def __str__(self) -> str:
        return f"{self.estimate:.2%} (95 % range: {self.least:.2%} to {self.most:.2%})"


class Picture(np.ndarray):
    """A picture: float32 radiance, height x width x 3 (linear red, green, blue), rows from the top.

    It is a numpy array; what is computed from it is a plain array. Beside the radiance it has:

    variance -- of each mean, height x width x 3, radiance squared; None where it is not known
    samples  -- paths of each pixel, height x width; None where they are not known
    alpha    -- share of each pixel that a surface covers, height x width; None: all of it
    layers   -- by name: height x width, or height x width x 2 or 3 (``layers=["albedo", ...]``)
    noise    -- a Noise, or None where it is not known
    info     -- what the render did: device, seconds, paths, rays
    """

    variance: Optional[np.ndarray]
    samples: Optional[np.ndarray]
    alpha: Optional[np.ndarray]
    layers: dict[str, np.ndarray]
    noise: Optional[Noise]
    info: dict[str, Any]

    def __new__(cls, color: Any, **known: Any) -> "Picture":
        """Makes a picture of an array of height x width x 3 radiances; `known` as listed above."""
        array = np.ascontiguousarray(color, dtype=np.float32)
        if array.ndim != 3 or array.shape[2] != 3:
            raise UsageError(f"a picture is an array of height x width x 3, not {array.shape}")
        self = array.view(cls)
        for name, value in known.items():
            if name not in cls.__annotations__:
                raise TypeError(f"a picture has no {name!r}")
            setattr(self, name, value)
        return self

    def __array_finalize__(self, other: Any) -> None:
        self.variance = self.samples = self.alpha = self.noise = None
        self.layers = {}
        self.info = {}

    def __array_wrap__(self, array: np.ndarray, context: Any = None, *more: Any) -> Any:
        plain = np.asarray(array)
        return plain[()] if plain.ndim == 0 else plain

    def __getitem__(self, key: Any) -> Any:
        return np.asarray(self)[key]

    def __repr__(self) -> str:
        noise = "unknown" if self.noise is None else str(self.noise)
        return f"<Picture {self.shape[1]} x {self.shape[0]}, noise {noise}>"

    def __reduce__(self) -> Any:
        return _restored, (np.asarray(self), {name: getattr(self, name) for name in _KNOWN})

    @property
    def width(self) -> int:
        """In pixels."""
        return int(self.shape[1])

    @property
    def height(self) -> int:
        """In pixels."""
        return int(self.shape[0])

    def channels(self) -> dict[str, np.ndarray]:
        """All that is known of the pixels, as the channels of an EXR file: height x width each."""
        array = np.asarray(self)
        all_ = {name: array[:, :, i] for i, name in enumerate(_COLORS)}
        if self.variance is not None:
            all_ |= {f"variance.{c}": self.variance[:, :, i] for i, c in enumerate(_COLORS)}
        if self.samples is not None:
            all_["samples"] = self.samples
        if self.alpha is not None:
            all_["A"] = self.alpha
        for name, values in self.layers.items():
            components = [values] if values.ndim == 2 else list(np.moveaxis(values, 2, 0))
            all_ |= {f"{name}.{c}": v for c, v in zip(_letters(name, len(components)), components)}
        return all_

    def save(
        self,
        file: Union[str, os.PathLike[str]],
        *,
        view: str = "standard",
        exposure: Union[float, str] = 0.0,
    ) -> None:
        """Writes the picture: .exr (linear, all channels), .png, .jpg or .webp (for a screen).

        view, exposure -- of pictures for a screen: standard, agx, filmic or pbr-neutral; stops, or
        "auto". Raises OutputError, and UsageError for other names of files.
        """
        _stromboli.save(os.fspath(file), self.channels(), self._branches, view, exposure)

    def _repr_png_(self) -> bytes:
        with tempfile.TemporaryDirectory() as folder:
            file = os.path.join(folder, "picture.png")
            self.save(file)
            with open(file, "rb") as stream:
                return stream.read()

    @property
    def _branches(self) -> int:
        return int(self.info.get("branches", 1))


_KNOWN = tuple(Picture.__annotations__)


def _restored(color: np.ndarray, known: Mapping[str, Any]) -> Picture:
    return Picture(color, **known)


def _letters(layer: str, count: int) -> str:
    if count == 2:
        return "UV"
    if count == 1:
        return "Z" if layer == "depth" else "X"
    return "XYZ" if layer in ("normal", "position") else "RGB"


def of_channels(
    channels: Mapping[str, np.ndarray],
    noise: Optional[tuple[float, float, float]] = None,
    info: Optional[dict[str, Any]] = None,
) -> Picture:
    """The picture that the channels of an EXR file are."""
    left = dict(channels)
    missing = [name for name in _COLORS if name not in left]
    if missing:
        raise UsageError(f"a picture has channels R, G and B: there is no {', '.join(missing)}")
    picture = Picture(np.stack([left.pop(name) for name in _COLORS], axis=2))
    names = [f"variance.{c}" for c in _COLORS]
    if all(name in left for name in names):
        picture.variance = np.stack([left.pop(name) for name in names], axis=2)
    picture.samples = left.pop("samples", None)
    picture.alpha = left.pop("A", None)
    groups: dict[str, list[str]] = {}
    for name in left:
        groups.setdefault(name.rpartition(".")[0] or name, []).append(name)
    for group, names in groups.items():
        names.sort(key=lambda name: _COMPONENTS.find(name[-1]))
        values = [left[name] for name in names]
        picture.layers[group] = values[0] if len(values) == 1 else np.stack(values, axis=2)
    picture.noise = None if noise is None else Noise(*noise)
    picture.info = dict(info or {})
    return picture


def read(file: Union[str, os.PathLike[str]]) -> Picture:
    """Reads an EXR file with channels R, G and B, and whatever else it has."""
    channels, branches = _stromboli.read(os.fspath(file))
    return of_channels(channels, info={"branches": branches})


def picture_of(given: Any) -> Picture:
    """A picture as it is, an EXR file that is read, or an array of radiance."""
    if isinstance(given, Picture):
        return given
    if isinstance(given, (str, os.PathLike)):
        return read(given)
    return Picture(given)
