"""What the tests of the Python module share."""

import os
import subprocess

import pytest

import stromboli

PREFIX = os.environ["STROMBOLI_PREFIX"]
SMALL = {"width": 24, "height": 18}


def pytest_sessionstart():
    assert stromboli.__file__.startswith(PREFIX), "the module is not the installed one"


@pytest.fixture
def run():
    """Runs the program, which must succeed."""

    def call(*words):
        program = os.environ["STROMBOLI_PROGRAM"]
        done = subprocess.run([program, *map(str, words)], capture_output=True, text=True)
        assert done.returncode == 0, done.stderr

    return call


@pytest.fixture(scope="session")
def boxes():
    return stromboli.load("cornell_boxes")


@pytest.fixture(scope="session")
def session():
    """One device for tests that need one."""
    return stromboli.Session()
