# SPDX-License-Identifier: Apache-2.0
"""nibabel and SimpleITK objects keep their place in the patient."""
import sys
import types

import kontur
import nibabel
import numpy
import pytest


def random_image(grid, dtype="int16"):
    return kontur.Image(numpy.random.default_rng(5).integers(-100, 100, grid.shape).astype(dtype), grid)


def test_nibabel_there_and_back(oblique):
    image = random_image(oblique)
    other = kontur.to_nibabel(image)
    assert isinstance(other, nibabel.Nifti1Image)
    assert numpy.array_equal(other.affine, oblique.affine("RAS"))
    assert other.shape == oblique.size
    assert other.dataobj[4, 3, 2] == image.samples[2, 3, 4]
    assert numpy.shares_memory(other.dataobj, image.samples)
    back = kontur.from_nibabel(other)
    assert back.grid == oblique
    assert numpy.array_equal(back.samples, image.samples)


def test_nibabel_and_kontur_read_the_same_file(tmp_path, oblique):
    image = random_image(oblique)
    kontur.write_image(tmp_path / "a.nii.gz", image)
    read = kontur.from_nibabel(nibabel.load(tmp_path / "a.nii.gz"))
    assert kontur.corner_distance_mm(read.grid, oblique) < 1e-4
    assert numpy.array_equal(read.samples, image.samples)


def test_a_mask_becomes_a_nibabel_image(case, kidney):
    other = kontur.to_nibabel(kidney.mask, image_class=nibabel.Nifti2Image)
    assert isinstance(other, nibabel.Nifti2Image)
    assert numpy.asarray(other.dataobj).sum() == kidney.mask.values.sum()


def test_a_4d_image_is_refused():
    with pytest.raises(kontur.InvalidInputError, match="4 axes"):
        kontur.from_nibabel(nibabel.Nifti1Image(numpy.zeros((2, 2, 2, 2), "i2"), numpy.eye(4)))


@pytest.fixture
def sitk(monkeypatch):
    """A stand-in with SimpleITK's conventions: sizes and geometry in x, y, z and LPS, arrays in z, y, x, direction by rows."""

    class Image:
        __module__ = "fake_sitk.core"

        def __init__(self, array):
            self.array, self.spacing, self.origin, self.direction = array, (1,) * 3, (0,) * 3, tuple(numpy.eye(3).ravel())

        def GetDimension(self):
            return self.array.ndim

        def GetNumberOfComponentsPerPixel(self):
            return 1

        def GetSize(self):
            return self.array.shape[::-1]

        def GetSpacing(self):
            return self.spacing

        def GetOrigin(self):
            return self.origin

        def GetDirection(self):
            return self.direction

        def SetSpacing(self, spacing):
            self.spacing = tuple(spacing)

        def SetOrigin(self, origin):
            self.origin = tuple(origin)

        def SetDirection(self, direction):
            self.direction = tuple(direction)

    package = types.ModuleType("fake_sitk")
    package.GetImageFromArray = lambda array: Image(array.copy())
    package.GetArrayViewFromImage = lambda image: image.array
    monkeypatch.setitem(sys.modules, "fake_sitk", package)
    return package


def test_sitk_there_and_back(sitk):
    angle = 0.3
    turned = [[numpy.cos(angle), -numpy.sin(angle), 0], [numpy.sin(angle), numpy.cos(angle), 0], [0, 0, -1]]
    grid = kontur.Grid.from_spacing((5, 4, 3), (0.5, 0.7, 2.5), (10, -20, 30), turned)
    image = random_image(grid)
    other = kontur.to_sitk(image, package=sitk)
    assert numpy.allclose(numpy.reshape(other.direction, (3, 3)), turned)
    assert numpy.allclose(other.spacing, (0.5, 0.7, 2.5)) and other.origin == (10, -20, 30)
    back = kontur.from_sitk(other)
    assert kontur.corner_distance_mm(back.grid, grid) < 1e-12
    assert numpy.array_equal(back.samples, image.samples)


def test_sitk_cannot_hold_shear(sitk, oblique):
    with pytest.raises(kontur.UnsupportedError, match="sheared"):
        kontur.to_sitk(random_image(oblique), package=sitk)


