// SPDX-License-Identifier: Apache-2.0
#include "kontur/view/moving_picture.h"

#include <algorithm>
#include <cmath>

#include "kontur/base/checks.h"
#include "kontur/base/counted.h"
#include "kontur/base/error.h"
#include "kontur/view/panels.h"

namespace kontur {
namespace {

using picture::kGround, picture::kPanel, picture::kFrame, picture::kText;

/// Rows of surface and slice on the left; the curve, and below it the table, on the right.
class Layout {
public:
    Layout(const PictureOptions& options, std::size_t rows) : rows_(rows) {
        const double height = rows > 1 ? 1000 : 560;
        unit = std::min(options.width_px / 1600.0, options.height_px / height);
        gap_ = std::round(10 * unit);
        const double margin = std::round(16 * unit), top = std::round(66 * unit);
        inner_ = {margin, top, options.width_px - 2 * margin, options.height_px - top - std::round(36 * unit)};
    }

    Rect cell(std::size_t row, int column) const {
        const double width = std::floor(0.33 * inner_.width),
                     height =
                         std::floor((inner_.height - static_cast<double>(rows_ - 1) * gap_) / static_cast<double>(rows_));
        return {inner_.x + column * (width + gap_), inner_.y + static_cast<double>(row) * (height + gap_), width, height};
    }
    Rect curve() const {
        Rect right = this->right();
        if (rows_ > 1) right.height = std::floor(0.6 * inner_.height);
        return right;
    }
    Rect table() const {
        const Rect right = this->right(), above = curve();
        return {right.x, above.bottom() + gap_, right.width, right.bottom() - above.bottom() - gap_};
    }
    bool has_table() const { return rows_ > 1; }

    double unit = 1;

private:
    Rect right() const {
        const double x = cell(0, 1).right() + gap_;
        return {x, inner_.y, inner_.right() - x, inner_.height};
    }

    std::size_t rows_;
    double gap_ = 0;
    Rect inner_{};
};

double length_mm(const Contour& contour) {
    double sum = 0;
    for (std::size_t n = 1; n < contour.points.size(); ++n) sum += distance(contour.points[n - 1], contour.points[n]);
    return sum;
}

/// That in which most was drawn.
Slice shown_slice(const MovingPictureContent& content) {
    const PictureMoment& first = content.moments.front();
    const auto slices = choose_slices(first.mesh, content.all_contours, first.image);
    const auto drawn_mm = [&](const Slice& slice) {
        double sum = 0;
        for (const Contour& contour : content.all_contours.contours)
            if (slice.contains(contour)) sum += length_mm(contour);
        return sum;
    };
    Slice slice = *std::max_element(slices.begin(), slices.end(),
                                    [&](const Slice& a, const Slice& b) { return drawn_mm(a) < drawn_mm(b); });
    Box3 extent;
    for (const Vec3& p : content.shown) {
        const auto [u, v] = slice.plane.to_uv(p);
        extent.extend({u, v, 0});
    }
    if (extent.is_empty()) return slice;
    const Vec3 middle = 0.5 * (extent.min + extent.max);
    slice.plane.origin = slice.plane.from_uv({middle.x, middle.y});
    slice.width_mm = extent.size().x;
    slice.height_mm = extent.size().y;
    return slice;
}

void check(const MovingPictureContent& content, const PictureOptions& options) {
    const auto refuse = [](const char* problem) { throw Error(ErrorKind::invalid_input, problem); };
    if (content.moments.empty()) refuse("there is no moment to show; at least 1 is needed");
    if (content.curve.values_ml.empty()) refuse("there is no volume of a frame to show; at least 1 is needed");
    picture::check_picture_size(options);
    for (const PictureMoment& moment : content.moments) {
        check_mesh(moment.mesh);
        if (moment.image) check_image(*moment.image);
    }
}

}  // namespace

RgbImage make_moving_picture(const MovingPictureContent& content, const PictureOptions& options, const Work& work) {
    check(content, options);
    check_threads(work.threads);
    const Layout layout(options, content.moments.size());
    const double u = layout.unit;
    Canvas canvas(options.width_px, options.height_px);
    const Rect all{0, 0, static_cast<double>(options.width_px), static_cast<double>(options.height_px)};
    canvas.fill(all, kGround);
    const std::string& name = options.title.empty() ? content.all_contours.name : options.title;
    picture::draw_frame_texts(canvas, {all, u}, name.empty() ? "segmentation" : name,
                              counted(content.curve.values_ml.size(), "frame") + ", " +
                                  counted(content.all_contours.contours.size(), "drawn contour"));
    const Slice slice = shown_slice(content);
    constexpr double kFilled = 0.6;
    const Rect cell = layout.cell(0, 1);
    double pixel_mm = std::max(slice.width_mm / (kFilled * cell.width), slice.height_mm / (kFilled * cell.height));
    if (!(pixel_mm > 0)) pixel_mm = 1;
    for (std::size_t row = 0; row < content.moments.size(); ++row) {
        const PictureMoment& moment = content.moments[row];
        const Rect surface = layout.cell(row, 0);
        picture::draw_surface_panel(canvas, {surface, u}, {moment.mesh, moment.contours, content.shown}, work);
        canvas.text({surface.x + 12 * u, surface.y + 23 * u}, moment.caption,
                    {.size_px = 15 * u, .color = kText, .bold = true, .halo = true});
        picture::draw_slice_panel(canvas, {layout.cell(row, 1), u}, slice,
                                  {moment.mesh, moment.contours, moment.image, content.window, pixel_mm});
    }
    picture::draw_curve_panel(canvas, {layout.curve(), u}, content.curve);
    if (layout.has_table()) {
        const Rect table = layout.table();
        const auto clip = canvas.clip(table);
        canvas.fill(table, kPanel);
        picture::draw_facts(canvas, {table, u}, {table.x + 18 * u, table.y + 32 * u}, options.facts);
        canvas.frame(table, kFrame, u);
    }
    return canvas.image();
}

}  // namespace kontur
