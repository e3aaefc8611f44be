// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "kontur/base/work.h"
#include "kontur/drawing/found_side.h"
#include "kontur/fit/residual.h"
#include "kontur/function/implicit_function.h"
#include "kontur/image/image_report.h"
#include "kontur/measure/section_check.h"
#include "kontur/segment_options.h"
#include "kontur/shape/contour.h"
#include "kontur/shape/mesh.h"
#include "kontur/shape/near_lines.h"
#include "kontur/shape/volume.h"

namespace kontur {

class SurfaceBand;

struct EditorOptions {
    SegmentOptions segment;             ///< how the contours are fitted; `voxelizer` and `mesh` do not matter
    double preview_spacing_mm = 0;      ///< of the preview's lattice; 0: twice what that of the finished surface would be
    double finished_spacing_mm = 0;     ///< of the finished surface's lattice; 0: a hundredth of the contours' diameter, or
                                        ///< down to half of that where a drawn section is narrower than four steps
    std::size_t preview_points = 1000;  ///< about how many of the drawn points a preview is fitted to; at least 1
};

/// The surface through a set of contours.
struct EditedSurface {
    bool finished = false;  ///< false: a preview
    ImplicitFunction function;
    TriangleMesh mesh;                    ///< in mm, with normals; empty without contours
    double spacing_mm = 0;                ///< of the lattice that the mesh was made on
    Residual residual;                    ///< at all drawn points, contours as they came; finished surfaces only
    std::vector<FoundSide> sides;         ///< of the open contours that do not tell, numbered as they came
    std::vector<NearLines> near_lines{};  ///< of one plane, numbered as they came
    SectionCheck section_check{};         ///< against what was drawn, numbered as it came; finished surfaces only
    int solves = 0;                       ///< how often a linear system was solved for it
    ImageReport image{};                  ///< what became of the image; finished surfaces only
    std::size_t earlier_places = 0;       ///< at which it follows what the image said before the edit: of previews, and of
                                          ///< surfaces that bridge the time until the image has answered again
    std::vector<std::pair<std::string, double>> seconds;  ///< wall time by stage, in order; previews only
};

/// Follows contours while they are edited. After each edit, `preview` gives a surface within about a tenth of a second for
/// organs, then `finish` the one that `segment` would give, with an image or without: the same function, to the last bit,
/// whatever came before.
///
/// A preview is fitted to a part of the points, to a fraction of a voxel, and of lines with many more than that a part is
/// looked at at all. What it keeps from the edit before is the surface's tilt along every contour, which saves the rounds
/// that would find it, and where the image showed the border, so that the surface stays there until the image has been asked
/// again. A contour that was moved or bent in its plane has the tilts of its nearest points before, as they turn with the
/// surface, not with the line; where contours came, went or lie elsewhere, and with every seventeenth preview, one
/// round finds all tilts anew. Nothing else is worth keeping: every weight and every value of the function change with each
/// edit (weights of the edit before start the solver at a residual of 1e5 mm and more), and the set-up of a thousand points
/// takes milliseconds. To ask the image parts of the drawing are fitted; a part that has been fitted in one of the last
/// questions is not fitted again.
class Editor {
public:
    /// Throws Error(invalid_input) for a spacing that is not finite or below 0 and for a preview of no points.
    explicit Editor(EditorOptions options = {});
    ~Editor();
    Editor(Editor&&) noexcept;
    Editor& operator=(Editor&&) noexcept;

    /// Throws Error as check_contours and solve do; then the edit before stays the last one. A set without contours gives an
    /// empty surface. `ahead` gets a band that planes can cut, halfway to the mesh; not without contours.
    EditedSurface preview(const ContourSet& contours, const Work& work = {},
                          const std::function<void(const SurfaceBand&)>& ahead = {});
    EditedSurface finish(const ContourSet& contours, const Work& work = {}) const;
    /// With an image, which has to stay until the call returns. Where it is to be asked, `alone` gets first what the
    /// contours alone make, which stays the result where the image does not help; and before that, where the image has been
    /// asked about an earlier drawing, what some 3,000 of the drawn points make with what it said then. Throws as
    /// `follow_image`, too.
    EditedSurface finish(const ContourSet& contours, const Image* image, const Work& work = {},
                         const std::function<void(const EditedSurface&)>& alone = {});
    /// Previews follow what an image said of these contours, as the report of their finished surface has it.
    void follow_image_of(const ContourSet& contours, const ImageReport& report);
    /// Previews no longer follow what an image said: it is another one now, or none.
    void forget_image();

    const EditorOptions& options() const;

private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace kontur
