"""Renders on a device: the numbers are the program's, and Python stays in charge meanwhile."""

import ctypes
import io
import logging
import os
import pickle
import signal
import threading
import time

import numpy as np
import pytest

import stromboli
from conftest import SMALL
from stromboli import _stromboli, sessions

ENDLESS = 1 << 24  # samples of a pixel: hours


def equal(a, b):
    return np.array_equal(np.asarray(a), np.asarray(b))


def test_a_picture_has_the_numbers_of_the_command(run, tmp_path, boxes):
    command = ["render", "cornell_boxes", "-r", "24", "18", "-s", "16", "--seed", "5", "--notes", "off"]
    layers = ["albedo", "normal", "depth", "material"]
    run(*command, "--aov", "--layers", ",".join(layers), "-o", tmp_path / "a.exr")
    run(*command, "-o", tmp_path / "a.png")
    read = stromboli.read(tmp_path / "a.exr")
    made = stromboli.render(boxes, samples=16, seed=5, layers=layers, **SMALL)
    assert made.shape == (18, 24, 3) and made.dtype == np.float32
    assert equal(made, read)
    assert equal(made.variance, read.variance) and equal(made.samples, read.samples)
    assert made.layers.keys() == read.layers.keys() == set(layers)
    assert made.channels().keys() == _stromboli.read(str(tmp_path / "a.exr"))[0].keys()
    assert made.layers["normal"].shape == (18, 24, 3) and made.layers["depth"].shape == (18, 24)
    assert all(equal(made.layers[name], read.layers[name]) for name in layers)
    assert made.samples.mean() == pytest.approx(16, rel=0.1)
    assert made.noise.least <= made.noise.estimate <= made.noise.most
    # And the bytes of its files, but for what these say of where they come from.
    made.save(tmp_path / "b.png")
    assert (tmp_path / "b.png").read_bytes() == (tmp_path / "a.png").read_bytes()
    assert made._repr_png_() == (tmp_path / "a.png").read_bytes()
    made.save(tmp_path / "b.exr")
    again = stromboli.read(tmp_path / "b.exr")
    assert equal(again, made) and equal(again.layers["normal"], made.layers["normal"])
    # The denoiser of pictures in memory is that of files.
    run("denoise", tmp_path / "a.exr", "-o", tmp_path / "clean.exr", "--notes", "off")
    file = stromboli.read(tmp_path / "clean.exr")
    clean = stromboli.denoise(made)
    assert equal(clean, file) and equal(clean.layers["error"], file.layers["error"])
    assert equal(clean.layers["noisy"], made)


def test_what_a_session_keeps_does_not_show(boxes, session):
    def alone(scene, **settings):
        return stromboli.Session().render(scene, samples=4, even=True, **SMALL, **settings)

    first = session.render(boxes, samples=4, even=True, **SMALL)
    session.move_camera(look_from=(0.3, 0.5, 1.8), look_at=(0, 0.4, 0), fov=50)
    moved = session.run()
    assert moved.info["build_seconds"] == 0  # the scene was there
    assert equal(moved, alone(boxes, look_from=(0.3, 0.5, 1.8), look_at=(0, 0.4, 0), fov=50))
    assert not equal(moved, first)
    assert equal(session.render(boxes, samples=4, even=True, **SMALL), first)


def furnace(albedo):
    builder = stromboli.SceneBuilder()
    material = builder.material("diffuse", albedo=albedo, name="ball")
    builder.sphere((0, 0, 0), 1, material)
    builder.environment(1)
    builder.camera((0, 0, 4), (0, 0, 0), fov=20)
    return builder.finish()


def test_a_changed_material_is_as_if_the_scene_had_it(session):
    session.begin(furnace(1), samples=4, direct="bsdf", width=8, height=8)
    assert np.asarray(session.run()) == pytest.approx(1, rel=1e-6)
    session.change_material("ball", albedo=(0.5, 0.25, 0))
    changed = session.run()
    assert changed.info["build_seconds"] == 0
    assert np.asarray(changed) == pytest.approx(np.broadcast_to((0.5, 0.25, 0), (8, 8, 3)), abs=1e-6)
    assert equal(changed, session.render(furnace((0.5, 0.25, 0)), samples=4, direct="bsdf", width=8, height=8))
    with pytest.raises(stromboli.UsageError, match="has no material 'none'"):
        session.change_material("none", albedo=1)
    with pytest.raises(stromboli.UsageError, match="its number or its name, not a dict"):
        session.change_material({"name": "ball"}, albedo=1)
    with pytest.raises(stromboli.UsageError, match="no 'roughness'"):
        session.change_material("ball", roughness=1)


def test_a_moved_object_and_a_changed_light_are_as_if_the_scene_had_them(session):
    def lit(x, color):
        builder = stromboli.SceneBuilder("lit")
        gray = builder.material("diffuse", name="gray", albedo=0.5)
        corners = np.array([(-9, 0, -9), (9, 0, -9), (0, 0, 9)], dtype=float)
        builder.mesh(corners, [(0, 2, 1)], gray, name="floor")
        builder.mesh(corners / 16 + (x, 1, 0), [(0, 2, 1)], gray, name="roof")
        builder.light("point", color=color, position=(0, 4, 0), name="lamp")
        builder.camera((0, 2, 6), (0, 0, 0))
        return builder.finish()

    settings = dict(samples=4, width=8, height=8)
    scene = lit(0, 1)
    assert scene.objects == ["floor", "roof"] and scene.lights == ["lamp"]
    session.begin(scene, **settings)
    before = session.run()
    motion = np.eye(4)
    motion[0, 3] = 0.5
    session.move("roof", motion)
    session.change_light("lamp", color=(2, 1, 1))
    changed = session.run()
    assert not equal(changed, before)
    assert equal(changed, session.render(lit(0.5, (2, 1, 1)), **settings))
    session.begin(scene, **settings)
    session.move("roof", motion)
    session.move("roof")
    assert equal(session.run(), before)
    with pytest.raises(stromboli.UsageError, match="has no object 'none'"):
        session.move("none")
    with pytest.raises(stromboli.UsageError, match="affine"):
        session.move("roof", np.zeros((4, 4)))
    with pytest.raises(stromboli.UsageError, match="has no 'angle'"):
        session.change_light(0, angle=3)


def test_progress_is_told_and_may_end_the_picture(boxes, session):
    told = []

    def progress(share, samples):
        told.append((share, samples))

    session.render(boxes, samples=64, progress=progress, **SMALL)
    shares = [share for share, _ in told]
    assert shares == sorted(shares) and 0 <= shares[0] and shares[-1] <= 1
    picture = session.render(boxes, samples=ENDLESS, progress=lambda *_: False, **SMALL)
    assert picture.info["cancelled"]

    def fails(*_):
        raise LookupError("of the callback")

    with pytest.raises(LookupError, match="of the callback"):
        session.render(boxes, samples=ENDLESS, progress=fails, **SMALL)


def test_progress_is_a_line_on_terminals_alone(monkeypatch):
    class Screen(io.StringIO):
        def isatty(self):
            return True

    screen = Screen()
    monkeypatch.setattr("sys.stderr", screen)
    assert sessions._shows_progress()
    line = sessions._Line()
    line(0.5, 100)
    assert screen.getvalue() == ""  # what is done at once needs no line
    line._begun -= 10
    line(0.5, 100)
    assert screen.getvalue().startswith("\rrendering  50%, 10 s left")
    line.close()
    assert screen.getvalue().endswith(" \r")
    monkeypatch.setattr("sys.stderr", io.StringIO())
    assert not sessions._shows_progress()


def test_messages_go_to_the_logger(boxes, caplog):
    caplog.set_level(logging.DEBUG, "stromboli")
    picture = stromboli.Session().render(boxes, samples=1, **SMALL)
    assert any(picture.info["device"] in record.message for record in caplog.records)
    assert all(record.name == "stromboli" for record in caplog.records)


def test_ctrl_c_ends_a_render(boxes, session, request):
    # A shell that starts something in the background has it ignore Ctrl-C.
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    request.addfinalizer(lambda: signal.signal(signal.SIGINT, before))

    def press():
        time.sleep(0.2)
        signal.pthread_kill(threading.main_thread().ident, signal.SIGINT)

    thread = threading.Thread(target=press)
    thread.start()
    with pytest.raises(KeyboardInterrupt):
        session.render(boxes, samples=ENDLESS, **SMALL)
    thread.join()
    assert np.isfinite(session.picture()).all()  # what was done by then


def test_other_threads_run_meanwhile(boxes, session):
    refused = []

    def other():
        # Python runs nowhere else, so that this would wait for hours if the lock were not free.
        while not refused:
            try:
                session.picture()
            except stromboli.UsageError as error:
                if "another thread" in str(error):
                    refused.append(str(error))
            time.sleep(0.01)
        session.cancel()

    session.begin(boxes, samples=ENDLESS, **SMALL)
    thread = threading.Thread(target=other)
    thread.start()
    picture = session.run(progress=False)
    thread.join()
    assert picture.info["cancelled"]
    assert refused == ["another thread is rendering in this session"]


def test_passes_can_be_looked_at(boxes, session):
    session.begin(boxes, samples=64, **SMALL)
    counts = []
    while session.step():
        counts.append(session.picture().samples.sum())
    assert len(counts) > 1 and counts == sorted(counts)
    assert equal(session.picture(), session.render(boxes, samples=64, **SMALL))


def test_sessions_at_the_same_time_do_not_know_each_other(boxes, session):
    one, two = stromboli.Session(), stromboli.Session(backend="reference")
    one.begin(boxes, samples=32, seed=3, **SMALL)
    two.begin(boxes, samples=32, seed=4, **SMALL)
    more = [True, True]
    while any(more):
        more = [s.step() if m else False for s, m in zip((one, two), more)]
    assert equal(one.picture(), session.render(boxes, samples=32, seed=3, **SMALL))
    assert equal(two.picture(), two.render(boxes, samples=32, seed=4, **SMALL))


def test_a_picture_in_bands_is_the_whole(boxes, session):
    # A film of one mebibyte holds some thousands of pixels.
    settings = {"samples": 1, "even": True, "width": 160, "height": 120, "layers": "depth"}
    whole = session.render(boxes, **settings)
    bands = stromboli.Session(film_memory=1).render(boxes, **settings)
    assert equal(bands, whole) and equal(bands.layers["depth"], whole.layers["depth"])


def test_a_crop_is_a_part(boxes, session):
    whole = session.render(boxes, samples=2, even=True, **SMALL)
    part = session.render(boxes, samples=2, even=True, crop=(5, 3, 7, 4), **SMALL)
    assert equal(part, whole[3:7, 5:12])


def test_the_process_stays_as_it_is(boxes, session):
    def state():
        getenv = ctypes.CDLL(None).getenv
        getenv.restype = ctypes.c_char_p
        with open("/proc/self/status") as status:
            signals = [line for line in status if line.startswith(("SigCgt", "SigIgn", "SigBlk"))]
        return [getenv(name) for name in (b"LP_NATIVE_VECTOR_WIDTH", b"LP_NUM_THREADS")], signals

    before = state()
    session.render(boxes, samples=1, **SMALL)
    assert state() == before


def test_what_is_wrong_is_said(boxes, session, tmp_path):
    for settings, message in [
        ({"samples": 0}, "samples: expected a whole number from 1"),
        ({"samples": 1.5}, "samples: expected a whole number"),
        ({"width": 8}, "width and height belong together"),
        ({"layers": ["colour"]}, "layers: expected albedo"),
        ({"direct": 3}, "direct: expected mis"),
        ({"look_from": (1, 2)}, "look_from: expected three coordinates"),
        ({"wdith": 3}, "no setting 'wdith': expected one of samples"),
        ({"crop": (0, 0, 900, 900), **SMALL}, "crop"),
        ({"even": True, "noise": 0.1}, "even"),
        ({"samples": [1, 2]}, "samples"),
        ({"seed": {}}, "expected a word or numbers"),
    ]:
        with pytest.raises(stromboli.UsageError, match=message):
            session.begin(boxes, **settings)
    with pytest.raises(ValueError):  # so are errors of usage, to those who do not know them
        session.begin(boxes, samples=-1)
    with pytest.raises(stromboli.UsageError, match="no sample"):
        session.begin(boxes)
        session.picture()
    with pytest.raises(stromboli.UsageError, match="no picture has been begun"):
        stromboli.Session(backend="reference").move_camera(fov=30)
    with pytest.raises(stromboli.DeviceError):
        stromboli.render(boxes, device="no such device")
    stromboli.release()
    picture = stromboli.Picture(np.zeros((2, 2, 3)))
    with pytest.raises(stromboli.OutputError):
        picture.save(tmp_path / "none" / "a.png")
    with pytest.raises(stromboli.UsageError):
        picture.save(tmp_path / "a.gif")
    assert issubclass(stromboli.OutputError, OSError)


def test_a_picture_is_an_array():
    picture = stromboli.Picture(np.ones((4, 6, 3)), info={"device": "none"})
    assert picture.width == 6 and picture.height == 4
    assert type(picture * 2) is np.ndarray and type(picture[0]) is np.ndarray
    assert isinstance(picture.mean(), float) or np.isscalar(picture.mean())
    assert np.asarray(picture).base is not None and np.shares_memory(np.asarray(picture), picture)
    copy = pickle.loads(pickle.dumps(picture))
    assert equal(copy, picture) and copy.info == {"device": "none"}
    assert "6 x 4" in repr(picture)
    with pytest.raises(stromboli.UsageError):
        stromboli.Picture(np.ones((4, 6)))
    assert os.path.exists(os.path.join(os.path.dirname(stromboli.__file__), "py.typed"))
