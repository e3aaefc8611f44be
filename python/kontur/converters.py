# SPDX-License-Identifier: Apache-2.0
"""Volumes of other packages to kontur's and back, with their exact geometry. None of the packages is imported to read."""
import sys

import numpy

from . import _core


def _as_array(volume):
    return volume.values if isinstance(volume, _core.Mask) else volume.samples


def from_nibabel(image):
    """The volume of a nibabel image.

    Parameters
    ----------
    image : nibabel.spatialimages.SpatialImage
        Any object with `dataobj` (shape (x, y, z)) and `affine` (shape (4, 4), to mm, RAS), in millimetres.

    Returns
    -------
    Image
        Its array has the shape (z, y, x).
    """
    array = numpy.asanyarray(image.dataobj)
    if array.ndim != 3:
        raise _errors().InvalidInputError(f"the image has {array.ndim} axes; 3 are needed (choose a frame first)")
    return _core.Image(array.T, _core.Grid(array.shape, image.affine, frame="RAS"))


def to_nibabel(volume, image_class=None):
    """An image of nibabel on the same grid.

    Parameters
    ----------
    volume : Image or Mask
    image_class : callable, optional
        Called with the array, shape (x, y, z), and the affine, to mm, RAS; nibabel.Nifti1Image when left out.

    Returns
    -------
    nibabel.Nifti1Image
        Its array is a view of the volume's.
    """
    if image_class is None:
        from nibabel import Nifti1Image as image_class
    return image_class(_as_array(volume).T, volume.grid.affine("RAS"))


def from_sitk(image):
    """The volume of a SimpleITK image.

    Parameters
    ----------
    image : SimpleITK.Image
        Scalar, 3D.

    Returns
    -------
    Image
    """
    if image.GetDimension() != 3 or image.GetNumberOfComponentsPerPixel() != 1:
        raise _errors().InvalidInputError(
            f"the image has {image.GetDimension()} axes and {image.GetNumberOfComponentsPerPixel()} components;"
            " 3 axes and 1 component are needed"
        )
    package = sys.modules[type(image).__module__.partition(".")[0]]
    direction = numpy.reshape(image.GetDirection(), (3, 3))
    grid = _core.Grid.from_spacing(image.GetSize(), image.GetSpacing(), image.GetOrigin(), direction)
    return _core.Image(package.GetArrayViewFromImage(image), grid)


def to_sitk(volume, package=None):
    """An image of SimpleITK on the same grid.

    Parameters
    ----------
    volume : Image or Mask
    package : module, optional
        SimpleITK, when it is not to be imported under that name.

    Returns
    -------
    SimpleITK.Image

    Raises
    ------
    UnsupportedError
        For a sheared grid, which SimpleITK cannot hold.
    """
    if package is None:
        import SimpleITK as package
    grid = volume.grid
    direction = grid.index_to_mm[:3, :3] / grid.spacing_mm
    if not numpy.allclose(direction.T @ direction, numpy.eye(3), rtol=0, atol=1e-6):
        raise _errors().UnsupportedError("the grid is sheared, which SimpleITK cannot hold; write it as NIfTI or NRRD")
    image = package.GetImageFromArray(numpy.ascontiguousarray(_as_array(volume)))
    image.SetSpacing(grid.spacing_mm.tolist())
    image.SetOrigin(grid.index_to_mm[:3, 3].tolist())
    image.SetDirection(direction.ravel().tolist())
    return image


def _errors():
    from . import errors

    return errors
