"""compare, check and denoise: what the commands do, of arrays."""

import math

import numpy as np
import pytest

import stromboli
from conftest import SMALL


def flat(value, size=(16, 16)):
    return stromboli.Picture(np.full((*size, 3), value))


@pytest.fixture(scope="module")
def reference():
    return stromboli.Session(backend="reference")


def test_figures_of_flat_pictures():
    found = stromboli.compare(flat(1), flat(1.1))
    assert found.mse == pytest.approx(0.01, rel=1e-5)
    assert found.rel_mse == pytest.approx(0.01 / 1.01, rel=1e-5)  # epsilon is 0.01 mean^2
    assert found.bias == pytest.approx([0.1] * 3, rel=1e-5)
    assert found.error_map.mean() == pytest.approx(found.rel_mse)
    assert found.flip_map.mean() == pytest.approx(found.flip) and found.flip > 0
    assert found.agrees is None  # there are no variances
    same = stromboli.compare(flat(1), np.ones((16, 16, 3)))
    assert same.mse == 0 and same.psnr == math.inf and same.flip == 0
    assert "relMSE" in str(found)
    with pytest.raises(stromboli.UsageError, match="16 x 16"):
        stromboli.compare(flat(1), flat(1, (8, 16)))


def test_pictures_of_one_scene_agree_and_others_do_not(boxes, reference):
    a, b = (
        reference.render(boxes, samples=64, even=True, seed=seed, **SMALL) for seed in (1, 2)
    )
    assert stromboli.compare(a, b).agrees is True
    darker = stromboli.Picture(a * 0.8)
    darker.variance, darker.samples = a.variance * 0.64, a.samples
    assert stromboli.compare(darker, b).agrees is False


def test_the_kernel_agrees_with_the_reference(boxes):
    found = stromboli.check(boxes, samples=64, **SMALL)
    assert found and found.agrees and found.verdict == "agree"
    assert max(map(abs, found.z)) < found.limit and "A:" in str(found)
    with pytest.raises(stromboli.UsageError, match="noise: z-tests need"):
        stromboli.check(boxes, noise=0.1)
    # So few samples prove nothing.
    assert stromboli.check(boxes, samples=1, max_bounces=0, width=2, height=2).verdict == "undecided"


def test_denoising_lowers_the_error(boxes):
    layers = ["albedo", "normal", "depth"]
    noisy = stromboli.render(boxes, samples=32, layers=layers, width=160, height=120)
    truth = stromboli.render(boxes, samples=256, seed=9, width=160, height=120)
    clean = stromboli.denoise(noisy, backend="reference")
    error, before = (stromboli.compare(truth, p).rel_mse for p in (clean, noisy))
    assert error < 0.8 * before
    assert np.array_equal(clean.layers["noisy"], noisy)
    assert clean.layers["error"].shape == (120, 160, 3) and clean.noise.estimate > 0
    with pytest.raises(stromboli.UsageError, match="variance"):
        stromboli.denoise(np.ones((8, 8, 3)), backend="reference")
    with pytest.raises(stromboli.UsageError, match="on or oidn"):
        stromboli.denoise(noisy, denoiser="best")
