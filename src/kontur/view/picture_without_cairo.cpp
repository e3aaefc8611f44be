// SPDX-License-Identifier: Apache-2.0
#include "kontur/base/error.h"
#include "kontur/view/moving_picture.h"
#include "kontur/view/picture.h"

namespace kontur {

namespace {

[[noreturn]] void refuse() {
    throw Error(ErrorKind::unsupported,
                "this kontur draws no pictures, because it was built without Cairo; the command line and Debian's "
                "python3-kontur draw them");
}

}  // namespace

RgbImage make_picture(const TriangleMesh&, const ContourSet&, const Image*, const PictureOptions&, const Work&) { refuse(); }

RgbImage make_moving_picture(const MovingPictureContent&, const PictureOptions&, const Work&) { refuse(); }

}  // namespace kontur
