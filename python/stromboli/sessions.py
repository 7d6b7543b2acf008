"""Renders: pictures of scenes, with what they share kept from one to the next."""

from __future__ import annotations

import atexit
import logging
import os
import sys
import threading
import time
from typing import Any, Callable, Optional, Sequence, Union

import numpy as np

from . import _stromboli
from .pictures import Picture, of_channels
from .scenes import Point, Scene, given, load

#: Called several times a second with the share of the work that is done (0 to 1) and the samples
#: taken so far. If it returns False the picture ends as it is; what it raises ends it, too.
Progress = Callable[[float, int], Optional[bool]]

_LEVELS = (logging.DEBUG, logging.INFO, logging.WARNING, logging.ERROR)
_log = logging.getLogger("stromboli")


class _Line:
    """Progress as one line of a terminal or a notebook."""

    def __init__(self) -> None:
        self._begun = time.monotonic()
        self._is_shown = False

    def __call__(self, share: float, samples: int) -> None:
        seconds = time.monotonic() - self._begun
        if seconds < 1:
            return
        left = seconds / share * (1 - share) if share > 0.01 else float("nan")
        rest = f", {left:.0f} s left" if left == left else ""
        sys.stderr.write(f"\rrendering {share:4.0%}{rest}   ")
        sys.stderr.flush()
        self._is_shown = True

    def close(self) -> None:
        if self._is_shown:
            sys.stderr.write("\r" + " " * 40 + "\r")
            sys.stderr.flush()


def _shows_progress() -> bool:
    return "ipykernel" in sys.modules or (sys.stderr is not None and sys.stderr.isatty())


def _words(settings: dict[str, Any]) -> dict[str, Any]:
    """Settings as the library takes them."""
    result = given(settings)
    layers = result.get("layers")
    if layers is not None and not isinstance(layers, str):
        result["layers"] = ",".join(layers)
    if isinstance(result.get("denoise"), bool):
        result["denoise"] = "on" if result["denoise"] else "off"
    return result


class Session:
    """Pictures, one after the other, on devices that are opened once.

    What a picture has in common with the one before is neither built, uploaded nor compiled again.
    A picture has the bytes that it has in a session of its own. One thread at a time uses a
    session; ``cancel()`` may be called by any.

    backend -- "vulkan" or "reference", the slow path tracer in double precision
    device -- number, UUID or part of a name from ``stromboli devices``, or "cpu"; None: the best
    scheduler -- "persistent" or "wavefront"
    threads -- of the reference; None: all
    film_memory -- mebibytes; a picture that needs more is rendered in bands
    """

    def __init__(
        self,
        *,
        backend: Optional[str] = None,
        device: Optional[str] = None,
        scheduler: Optional[str] = None,
        threads: Optional[int] = None,
        film_memory: Optional[int] = None,
    ) -> None:
        settings = {
            "backend": backend,
            "device": device,
            "scheduler": scheduler,
            "threads": threads,
            "film_memory": film_memory,
        }
        self._session = _stromboli.Session(given(settings))
        self._scene: Optional[Scene] = None

    def render(self, scene: Union[Scene, str, os.PathLike[str]], **settings: Any) -> Picture:
        """A picture, finished; ``settings`` are those of ``stromboli.render``."""
        progress = settings.pop("progress", None)
        self.begin(scene, **settings)
        return self.run(progress)

    def begin(self, scene: Union[Scene, str, os.PathLike[str]], **settings: Any) -> None:
        """Begins a picture; nothing is built before samples are taken."""
        loaded = scene if isinstance(scene, Scene) else load(scene)
        self._session.begin(loaded._handle, _words(settings))
        self._scene = loaded
        self._tell()

    def move_camera(
        self,
        *,
        camera: Union[None, str, int] = None,
        look_from: Optional[Point] = None,
        look_at: Optional[Point] = None,
        fov: Optional[float] = None,
        aperture: Optional[float] = None,
        focus: Union[None, str, float, Sequence[int]] = None,
        turn: Optional[float] = None,
    ) -> None:
        """Begins the picture again, seen from elsewhere; what is None stays as it is."""
        settings = {
            "camera": camera,
            "look_from": look_from,
            "look_at": look_at,
            "fov": fov,
            "aperture": aperture,
            "focus": focus,
            "turn": turn,
        }
        self._session.move_camera(given(settings))
        self._tell()

    def change_material(self, which: Union[int, str], **parameters: Any) -> None:
        """Begins the picture again with other numbers of a material, by number or name.

        The scene itself stays as it is. Nothing is built anew.
        """
        number = self._number("material", which)
        self._session.change_materials({number: given(parameters)})
        self._tell()

    def change_light(self, which: Union[int, str], **parameters: Any) -> None:
        """Begins the picture again with another light: color, position, direction, angle,
        inner_angle.

        which -- number or name in ``Scene.lights``; lights with an area are objects. Nothing is
        built anew.
        """
        number = self._number("light", which)
        self._session.change_lights({number: given(parameters)})
        self._tell()

    def move(self, which: Union[int, str], motion: Any = None) -> None:
        """Begins the picture again with an object elsewhere.

        which -- number or name in ``Scene.objects``
        motion -- 4 x 4, from where the scene has it, metres; None: back to there. It has an
        inverse and does not mirror; a sphere's stretches all directions alike.

        What the first motion leaves where it is gets a tree of its own, which later ones keep.
        """
        number = self._number("object", which)
        matrix = np.eye(4) if motion is None else np.asarray(motion, dtype=float)
        if matrix.shape != (4, 4):
            raise TypeError(f"a motion is 4 x 4, not {matrix.shape}")
        self._session.move_object(number, matrix)
        self._tell()

    def _number(self, kind: str, which: Union[int, str]) -> int:
        if self._scene is None:
            self._session.change_materials({})  # says that no picture has been begun
        assert self._scene is not None
        return self._scene.number_of(kind, which)

    def step(self, progress: Optional[Progress] = None) -> bool:
        """Takes samples until a pass is done. False: the picture is finished or cancelled."""
        try:
            return self._session.passes(progress, False)
        finally:
            self._tell()

    def run(self, progress: Union[None, bool, Progress] = None) -> Picture:
        """Takes all samples that are left, and returns the picture.

        progress -- called as Progress says; None: a line on terminals and in notebooks; True or
        False: a line, or none. Ctrl-C ends it with KeyboardInterrupt; ``picture()`` has what was
        done by then.
        """
        line: Optional[_Line] = None
        if progress is True or (progress is None and _shows_progress()):
            line = _Line()
        try:
            self._session.passes(line or (progress if callable(progress) else None), True)
        finally:
            if line:
                line.close()
            self._tell()
        return self.picture()

    def picture(self) -> Picture:
        """The picture so far. Raises UsageError if no sample has been taken."""
        info = self._session.info()
        noise = info.pop("noise")
        return of_channels(self._session.channels(), noise, info)

    @property
    def is_over(self) -> bool:
        """Whether the picture is finished or cancelled, or none has been begun."""
        return self._session.is_over

    def cancel(self) -> None:
        """From any thread: the picture ends within a fraction of a second of sampling."""
        self._session.cancel()

    def _tell(self) -> None:
        for severity, text in self._session.messages():
            _log.log(_LEVELS[severity], "%s", text)


_kept = threading.local()  # the session of render(), by thread


def release() -> None:
    """Closes the device that ``render`` keeps open in this thread for its next call."""
    _kept.__dict__.clear()


atexit.register(release)


def _kept_session(device: dict[str, Any]) -> Session:
    kept: Optional[Session] = getattr(_kept, "session", None)
    if kept is None or _kept.device != device:
        release()
        kept = _kept.session = Session(**device)
        _kept.device = device
    return kept


def render(
    scene: Union[Scene, str, os.PathLike[str]],
    *,
    samples: Optional[int] = None,
    width: Optional[int] = None,
    height: Optional[int] = None,
    seed: Optional[int] = None,
    noise: Optional[float] = None,
    time: Optional[float] = None,
    even: Optional[bool] = None,
    crop: Optional[Sequence[int]] = None,
    layers: Union[None, str, Sequence[str]] = None,
    transparent: Optional[bool] = None,
    background: Union[None, str, float, Sequence[float]] = None,
    shadow_catcher: Optional[str] = None,
    denoise: Union[None, bool, str] = None,
    keep_noisy: Optional[bool] = None,
    camera: Union[None, str, int] = None,
    look_from: Optional[Point] = None,
    look_at: Optional[Point] = None,
    fov: Optional[float] = None,
    aperture: Optional[float] = None,
    focus: Union[None, str, float, Sequence[int]] = None,
    turn: Optional[float] = None,
    max_bounces: Optional[int] = None,
    min_bounce: Optional[int] = None,
    clamp_indirect: Optional[float] = None,
    light_samples: Optional[int] = None,
    direct: Optional[str] = None,
    light_choice: Optional[str] = None,
    roulette: Union[None, str, float] = None,
    gap_proposal: Optional[bool] = None,
    guiding: Optional[str] = None,
    portals: Optional[str] = None,
    branches: Optional[int] = None,
    integrator: Optional[str] = None,
    sampler: Optional[str] = None,
    filter: Optional[str] = None,
    backend: Optional[str] = None,
    device: Optional[str] = None,
    scheduler: Optional[str] = None,
    threads: Optional[int] = None,
    film_memory: Optional[int] = None,
    progress: Union[None, bool, Progress] = None,
) -> Picture:
    """Renders a picture of a scene: what ``stromboli render`` does, to the same numbers.

    scene -- a Scene, or what ``load`` takes
    samples -- paths of a pixel, on the mean over the picture (64); they go where they help most
    even -- the same number of samples for every pixel
    noise -- goes on until the noise is at most this (0.02: 2 %) in 95 of 100 renders
    time -- takes samples for at most so many seconds
    width, height -- of the picture, pixels; both or none (the camera's shape, 800 wide)
    crop -- left, top, width, height in pixels: only this part
    seed -- another seed, another noise
    layers -- of albedo, normal, depth, transmittance, position, uv, object, material
    transparent -- alpha in place of the environment
    background -- in its place: radiance, one or three numbers, or a picture's file
    shadow_catcher -- "ground", or an object or material, of which only shadows are in the picture
    denoise -- True or "on", "oidn"; keep_noisy: with the noisy picture as a layer
    camera -- name or number (from 1) of one of the scene, "auto", "file" or "frame"
    look_from, look_at -- points in metres, in place of a camera of the scene
    fov -- degrees over the height; turn -- degrees; aperture -- of a thin lens, metres
    focus -- metres, "auto" (what is in the middle), or the column and the row of a pixel
    max_bounces, min_bounce -- scatterings of light at most (8), and at least (0)
    clamp_indirect -- light that was scattered twice or more brings at most this at a time: biased
    light_samples, direct, light_choice, roulette, gap_proposal, guiding, portals, branches, integrator, sampler,
    filter -- as the options of the command line
    backend, device, scheduler, threads, film_memory -- as of Session
    progress -- as of Session.run

    The device and the scene stay open for the next call (``release`` closes them). Other threads
    run meanwhile. Raises UsageError, SceneError, DeviceError; KeyboardInterrupt on Ctrl-C.
    """
    where = {
        "backend": backend,
        "device": device,
        "scheduler": scheduler,
        "threads": threads,
        "film_memory": film_memory,
    }
    return _kept_session(where).render(
        scene,
        samples=samples,
        width=width,
        height=height,
        seed=seed,
        noise=noise,
        time=time,
        even=even,
        crop=crop,
        layers=layers,
        transparent=transparent,
        background=background,
        shadow_catcher=shadow_catcher,
        denoise=denoise,
        keep_noisy=keep_noisy,
        camera=camera,
        look_from=look_from,
        look_at=look_at,
        fov=fov,
        aperture=aperture,
        focus=focus,
        turn=turn,
        max_bounces=max_bounces,
        min_bounce=min_bounce,
        clamp_indirect=clamp_indirect,
        light_samples=light_samples,
        direct=direct,
        light_choice=light_choice,
        roulette=roulette,
        gap_proposal=gap_proposal,
        guiding=guiding,
        portals=portals,
        branches=branches,
        integrator=integrator,
        sampler=sampler,
        filter=filter,
        progress=progress,
    )
