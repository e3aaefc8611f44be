// SPDX-License-Identifier: Apache-2.0
#include "kontur/base/error.h"
#include "kontur/view/picture.h"

namespace kontur {

RgbImage make_picture(const TriangleMesh&, const ContourSet&, const Image*, const PictureOptions&, const Work&) {
    throw Error(ErrorKind::unsupported,
                "this kontur draws no pictures, because it was built without Cairo; the command line and Debian's "
                "python3-kontur draw them");
}

}  // namespace kontur
