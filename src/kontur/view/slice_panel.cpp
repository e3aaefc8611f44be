// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "kontur/view/outline.h"
#include "kontur/view/panels.h"
#include "kontur/view/reslice.h"

namespace kontur::picture {
namespace {

/// From mm to the panel's pixels.
class SliceDrawing {
public:
    SliceDrawing(Canvas& canvas, const PanelPlace& place, const Slice& slice, const SliceContent& content)
        : canvas_(canvas), place_(place), slice_(slice), content_(content) {}

    void draw() {
        if (content_.image) draw_image();
        const auto surface = surface_lines();
        canvas_.fill_polygons(surface, kSurface.with_alpha(content_.image ? 0.08 : 0.22));
        for (const auto& line : surface) stroke(line, true, kSurface, 2.8);
        for (const Contour& contour : content_.contours.contours)
            if (slice_.contains(contour)) stroke(to_panel(contour.points), contour.closed, kDrawn, 1.5);
        for (const Contour& contour : content_.contours.contours)
            if (!slice_.contains(contour)) draw_crossings(contour);
    }

private:
    Point2 to_panel(const Vec3& p) const {
        const auto [u, v] = slice_.plane.to_uv(p);
        const Point2 middle = place_.rect.center();
        return {middle.x + u / content_.pixel_mm, middle.y + v / content_.pixel_mm};
    }

    std::vector<Point2> to_panel(const std::vector<Vec3>& points) const {
        std::vector<Point2> result(points.size());
        std::transform(points.begin(), points.end(), result.begin(), [&](const Vec3& p) { return to_panel(p); });
        return result;
    }

    std::vector<std::vector<Point2>> surface_lines() const {
        std::vector<std::vector<Point2>> result;
        for (const Polyline& line : outline(content_.mesh, slice_.plane)) result.push_back(to_panel(line.points));
        return result;
    }

    void draw_image() {
        const auto width = static_cast<int>(std::ceil(place_.rect.width)),
                   height = static_cast<int>(std::ceil(place_.rect.height));
        const auto values = reslice(*content_.image, centered_reslice(slice_.plane, width, height, content_.pixel_mm),
                                    std::numeric_limits<float>::quiet_NaN());
        std::vector<std::uint32_t> argb(values.size());
        for (std::size_t i = 0; i < values.size(); ++i) {
            if (std::isnan(values[i])) continue;
            argb[i] = 0xff000000u +
                      0x010101u * static_cast<std::uint32_t>(std::lround(255 * brightness(values[i], content_.window)));
        }
        canvas_.blend(static_cast<int>(place_.rect.x), static_cast<int>(place_.rect.y), width, height, argb);
    }

    void stroke(const std::vector<Point2>& line, bool closed, const Color& color, double width) {
        canvas_.stroke(line, closed, {0, 0, 0, 0.35}, (width + 1.6) * place_.unit);
        canvas_.stroke(line, closed, color, width * place_.unit);
    }

    void draw_crossings(const Contour& contour) {
        for (const Vec3& p : crossings(contour, slice_.plane)) {
            canvas_.dot(to_panel(p), 4.4 * place_.unit, {0, 0, 0, 0.65});
            canvas_.dot(to_panel(p), 3.3 * place_.unit, kDrawn);
        }
    }

    Canvas& canvas_;
    const PanelPlace& place_;
    const Slice& slice_;
    const SliceContent& content_;
};

std::string slice_name(SliceKind kind) {
    return kind == SliceKind::axial ? "Axial" : kind == SliceKind::coronal ? "Coronal" : "Sagittal";
}

/// "z = 1550.0 mm" for a slice through the patient's axes, "32° oblique" for others.
std::string slice_position(const Slice& slice) {
    const double oblique = obliquity_deg(slice.plane.normal);
    if (oblique > 0.5) return rounded(oblique, 2) + "° oblique";
    const auto& p = slice.plane.origin;
    const double at = slice.kind == SliceKind::axial ? p.z : slice.kind == SliceKind::coronal ? p.y : p.x;
    const char* side = slice.kind == SliceKind::axial     ? (at < 0 ? "I " : "S ")
                       : slice.kind == SliceKind::coronal ? (at < 0 ? "A " : "P ")
                                                          : (at < 0 ? "R " : "L ");
    return side + fmt::format("{:.1f}", std::abs(at)) + " mm";
}

}  // namespace

void draw_slice_panel(Canvas& canvas, const PanelPlace& place, const Slice& slice, const SliceContent& content) {
    const auto clip = canvas.clip(place.rect);
    canvas.fill(place.rect, content.image ? Color{0.03, 0.035, 0.045} : kPanel);
    SliceDrawing(canvas, place, slice, content).draw();
    const Point2 caption{place.rect.x + 12 * place.unit, place.rect.y + 23 * place.unit};
    const double width =
        canvas.text(caption, slice_name(slice.kind),
                    {.size_px = 15 * place.unit, .color = kText, .bold = true, .align = Align::left, .halo = true});
    canvas.text({caption.x + width + 8 * place.unit, caption.y}, slice_position(slice),
                {.size_px = 12.5 * place.unit, .color = kText, .align = Align::left, .halo = true});
    draw_edge_letters(canvas, place, slice.plane);
    draw_scale_bar(canvas, place, content.pixel_mm);
    canvas.frame(place.rect, kFrame, place.unit);
}

}  // namespace kontur::picture
