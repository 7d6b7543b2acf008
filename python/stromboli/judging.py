"""What is done with pictures: comparing, checking, denoising."""

from __future__ import annotations

import os
from dataclasses import dataclass
from typing import Any, Optional, Union

import numpy as np

from . import _stromboli
from .errors import UsageError
from .pictures import Picture, of_channels, picture_of
from .scenes import Scene, load
from .sessions import Progress, _words

#: A picture, the name of an EXR file, or an array of height x width x 3 radiances.
AnyPicture = Union[Picture, str, os.PathLike[str], np.ndarray]


@dataclass(frozen=True)
class Comparison:
    """How far a picture is from a reference (docs/guide/commands.md, "compare")."""

    mse: float  #: of linear radiance
    rel_mse: float  #: over the reference squared
    psnr: float  #: dB, of sRGB signals; infinite for equal pictures
    ssim: float
    flip: float  #: mean of flip_map
    bias: np.ndarray  #: mean difference of red, green, blue
    relative_bias: np.ndarray  #: over the mean of the reference
    agrees: Optional[bool]  #: by z-tests; None where a picture has no variances, or none decides
    flip_map: np.ndarray  #: height x width
    error_map: np.ndarray  #: height x width; its mean is rel_mse
    figures: dict[str, Any]  #: all, as ``stromboli compare --json`` has them
    text: str

    def __str__(self) -> str:
        return self.text


def compare(
    reference: AnyPicture,
    picture: AnyPicture,
    *,
    exposure: float = 0.0,
    false_alarms: float = 0.01,
) -> Comparison:
    """Compares a picture with a reference of the same size.

    exposure -- stops, for PSNR and SSIM
    false_alarms -- probability that the z-tests call estimates of one picture different

    Raises UsageError if the sizes differ.
    """
    r, p = picture_of(reference), picture_of(picture)
    found = _stromboli.compare(
        _base_channels(r), r._branches, _base_channels(p), p._branches, exposure, false_alarms
    )
    figures = found["figures"]
    tests = figures.get("zTest")
    verdict = tests["verdict"] if tests else "undecided"
    return Comparison(
        mse=figures["mse"],
        rel_mse=figures["relMse"],
        psnr=float("inf") if figures["psnr"] is None else figures["psnr"],
        ssim=figures["ssim"],
        flip=figures["flip"]["mean"],
        bias=np.array(figures["bias"]),
        relative_bias=np.array(figures["relativeBias"]),
        agrees=None if verdict == "undecided" else verdict == "agree",
        flip_map=found["flip_map"],
        error_map=found["error_map"],
        figures=figures,
        text=found["text"],
    )


def _base_channels(picture: Picture) -> dict[str, np.ndarray]:
    bare = Picture(picture)
    bare.variance, bare.samples = picture.variance, picture.samples
    return bare.channels()


@dataclass(frozen=True)
class Check:
    """Whether the kernel and the reference show the same picture."""

    verdict: str  #: agree, different, or undecided: no difference could have been found
    z: tuple[float, float, float]  #: of the means of red, green, blue
    limit: float  #: on |z|
    text: str

    @property
    def agrees(self) -> bool:
        """Whether they agree, and a difference could have been found."""
        return self.verdict == "agree"

    def __bool__(self) -> bool:
        return self.agrees

    def __str__(self) -> str:
        return self.text


def check(
    scene: Union[Scene, str, os.PathLike[str]],
    *,
    samples: int = 256,
    width: int = 160,
    height: int = 120,
    false_alarms: float = 0.01,
    device: Optional[str] = None,
    threads: Optional[int] = None,
    progress: Optional[Progress] = None,
    **settings: Any,
) -> Check:
    """Renders on the device and with the reference, and tests whether the pictures agree.

    false_alarms -- probability of calling equal pictures different
    settings -- of ``render``, but for those of how many samples

    Raises SceneError, DeviceError, UsageError.
    """
    for name in ("noise", "time", "even"):
        if settings.get(name):
            raise UsageError(f"{name}: z-tests need the number of samples, the same for all pixels")
    loaded = scene if isinstance(scene, Scene) else load(scene)
    all_ = _words({"samples": samples, "width": width, "height": height, **settings})
    where = _words({"device": device, "threads": threads})
    found = _stromboli.check(loaded._handle, all_, where, false_alarms, progress)
    return Check(found["verdict"], found["z"], found["limit"], found["text"])


def denoise(
    picture: AnyPicture,
    *,
    denoiser: str = "on",
    device: Optional[str] = None,
    backend: str = "vulkan",
) -> Picture:
    """The picture without its noise: what ``stromboli denoise`` makes of its EXR file.

    The picture needs its variance; with the layers albedo, normal and depth it gets better. The
    result has the layers "noisy" and "error", the predicted root of the squared error.

    denoiser -- "on", or "oidn" where Open Image Denoise is installed
    backend -- "reference": without a device, slower

    Raises UsageError for pictures without variance, DeviceError.
    """
    given = picture_of(picture)
    found = _stromboli.denoise(given.channels(), given._branches, denoiser, device or "", backend)
    clean = of_channels(found["channels"], found["noise"], given.info)
    clean.alpha = given.alpha
    clean.samples = given.samples
    clean.layers = {**given.layers, **clean.layers}
    return clean
