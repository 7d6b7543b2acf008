"""The library with the C API as it is installed: what it shows, the examples, errors as codes."""

import ctypes
import os
import re
import subprocess

import numpy as np
import pytest

import stromboli
from conftest import PREFIX

EXAMPLES = os.environ["STROMBOLI_EXAMPLES"]
WARNINGS = ["-Wall", "-Wextra", "-Wpedantic", "-Werror"]


def output(*words, **more):
    done = subprocess.run([str(w) for w in words], capture_output=True, text=True, **more)
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


def find(name):
    return next(
        os.path.join(folder, name) for folder, _, files in os.walk(PREFIX) if name in files
    )


@pytest.fixture(scope="module")
def environment():
    folder = os.path.dirname(find("stromboli.pc"))
    return {**os.environ, "PKG_CONFIG_PATH": folder, "LD_LIBRARY_PATH": os.path.dirname(find("libstromboli.so"))}


def test_it_shows_the_functions_of_the_header_alone():
    shown = set(re.findall(r" [A-Z] (\S+)$", output("nm", "-D", "--defined-only", find("libstromboli.so")), re.M))
    with open(find("stromboli.h")) as header:
        declared = set(re.findall(r"\b(stromboli_\w+)\(", header.read()))
    assert shown == declared


def test_the_example_in_c_by_pkg_config(environment, tmp_path):
    flags = output("pkg-config", "--cflags", "--libs", "stromboli", env=environment).split()
    program = tmp_path / "render"
    source = os.path.join(EXAMPLES, "render.c")
    output(os.environ["CC"], "-std=c99", *WARNINGS, source, "-o", program, *flags)
    picture = tmp_path / "c.exr"
    said = output(program, "cornell_boxes", picture, env=environment)
    expected = stromboli.render("cornell_boxes", samples=16, width=64, height=48)
    assert np.array_equal(stromboli.read(picture), expected)
    mean = np.asarray(expected, np.float64).mean()
    assert said == f"mean {mean:.6f}, noise {expected.noise.estimate:.4f}\n"
    wrong = subprocess.run([program, "no_such_scene"], capture_output=True, text=True, env=environment)
    assert wrong.returncode == 1 and wrong.stderr.startswith("error 2: no_such_scene")


@pytest.mark.parametrize("target", ["stromboli::stromboli", "stromboli::static"])
def test_the_example_in_cpp_by_cmake(target, environment, tmp_path):
    (tmp_path / "CMakeLists.txt").write_text(
        f"""cmake_minimum_required(VERSION 3.22)
project(example CXX)
find_package(stromboli 0.1 REQUIRED)
add_executable(example {EXAMPLES}/render.cpp)
target_link_libraries(example PRIVATE {target})
"""
    )
    build = tmp_path / "build"
    output("cmake", "-S", tmp_path, "-B", build, "-G", "Ninja", f"-DCMAKE_PREFIX_PATH={PREFIX}",
           f"-DCMAKE_CXX_FLAGS={' '.join(WARNINGS)}")
    output("cmake", "--build", build)
    # A shared one is found by the RUNPATH that CMake gives programs in a build tree.
    assert output(build / "example", "reference") == "white 1.000\ngrey 0.500\n"


class Error(ctypes.Structure):
    _fields_ = [("code", ctypes.c_int), ("message", ctypes.c_char * 1024)]


@pytest.fixture(scope="module")
def library():
    return ctypes.CDLL(find("libstromboli.so"))


def test_versions(library, environment):
    assert library.stromboli_version() == 1000
    library.stromboli_version_text.restype = ctypes.c_char_p
    assert library.stromboli_version_text().decode() == stromboli.__version__
    assert output("pkg-config", "--modversion", "stromboli", env=environment).strip() == "0.1.0"


def test_errors_are_codes_with_messages(library):
    error, handle = Error(), ctypes.c_void_p()
    to = ctypes.byref
    number = ctypes.c_uint32()
    for code, message, call in [
        (2, "no_such_scene", lambda: library.stromboli_scene_load(b"no_such_scene", to(handle), to(error))),
        (1, "source is NULL", lambda: library.stromboli_scene_load(None, to(handle), to(error))),
        (1, "scene is NULL", lambda: library.stromboli_scene_load(b"x", None, to(error))),
        (1, "backend: expected", lambda: library.stromboli_session_create(b"metal", None, to(handle), to(error))),
        (1, "session is NULL", lambda: library.stromboli_session_run(None, to(error))),
        (1, "maker is NULL", lambda: library.stromboli_maker_add_material(None, b"diffuse", None, to(number), to(error))),
    ]:
        error.message = b""
        assert call() == code == error.code
        assert message in error.message.decode()
    assert handle.value is None
    assert library.stromboli_scene_load(b"no_such_scene", to(handle), None) == 2
    # A message that is too long is cut off between two characters.
    library.stromboli_scene_load(("é" * 2000).encode(), to(handle), to(error))
    assert len(error.message) >= 1000 and error.message.decode()
    for name in ("scene", "maker", "session"):
        getattr(library, f"stromboli_{name}_destroy")(None)


class Option(ctypes.Structure):
    _fields_ = [
        ("name", ctypes.c_char_p),
        ("word", ctypes.c_char_p),
        ("numbers", ctypes.c_double * 3),
        ("count", ctypes.c_size_t),
    ]


def test_scenes_are_loaded_as_options_say(library):
    error, scene = Error(), ctypes.c_void_p()

    def load(*options):
        array = (Option * len(options))(*options)
        return library.stromboli_scene_load_with(
            b"light_point", array, ctypes.c_size_t(len(options)), ctypes.byref(scene), ctypes.byref(error)
        )

    three = (ctypes.c_double * 3)(1, 2, 3)
    assert load((b"environment", None, three, 3), (b"strict", None, three, 1)) == 0
    library.stromboli_scene_destroy(scene)
    for options, message in [
        ((b"environment", None, three, 2), b"one or three radiances"),
        ((b"environment", None, three, 4), b"3 numbers at most"),
        ((b"lights", b"on", three, 0), b"expected one of environment"),
    ]:
        assert load(options) == 1 and message in error.message


def test_a_session_in_passes(library):
    error, scene, session = Error(), ctypes.c_void_p(), ctypes.c_void_p()
    to = ctypes.byref

    def ok(code):
        assert code == 0, error.message

    ok(library.stromboli_scene_load(b"cornell_boxes", to(scene), to(error)))
    ok(library.stromboli_session_create(b"reference", None, to(session), to(error)))
    for name, value in [(b"samples", 8), (b"width", 8), (b"height", 6), (b"even", 1)]:
        ok(library.stromboli_session_set(session, name, ctypes.c_double(value), to(error)))
    ok(library.stromboli_session_set_word(session, b"layers", b"depth", to(error)))
    assert library.stromboli_session_set_word(session, b"layers", b"hue", to(error)) == 1
    values = (ctypes.c_float * 48)()
    read = library.stromboli_session_read
    assert read(session, b"R", values, ctypes.c_size_t(48), to(error)) == 1
    assert b"no picture" in error.message
    ok(library.stromboli_session_begin(session, scene, to(error)))
    library.stromboli_scene_destroy(scene)  # the session keeps what it needs
    more, passes = ctypes.c_int(1), 0
    while more.value:
        ok(library.stromboli_session_pass(session, to(more), to(error)))
        passes += 1
    assert passes >= 1
    expected = stromboli.Session(backend="reference").render(
        "cornell_boxes", samples=8, width=8, height=6, even=True, layers="depth"
    )
    for channel, pixels in expected.channels().items():
        ok(read(session, channel.encode(), values, ctypes.c_size_t(48), to(error)))
        assert np.array_equal(np.array(values).reshape(6, 8), pixels), channel
    assert read(session, b"albedo.R", values, ctypes.c_size_t(48), to(error)) == 1
    assert b"it has" in error.message
    assert read(session, b"R", values, ctypes.c_size_t(47), to(error)) == 1
    assert b"room for 47" in error.message
    # Cancelled by what its progress returns.
    progress = ctypes.CFUNCTYPE(ctypes.c_int, ctypes.c_double, ctypes.c_void_p)(lambda share, _: 1)
    library.stromboli_session_on_progress(session, progress, None)
    place = ctypes.c_double * 3
    ok(library.stromboli_session_move_camera(session, place(0, 1, 3), place(0, 1, 0), ctypes.c_double(0), to(error)))
    ok(library.stromboli_session_run(session, to(error)))
    library.stromboli_session_destroy(session)

