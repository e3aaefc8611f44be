// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "kontur/view/camera.h"
#include "kontur/view/panels.h"
#include "kontur/view/shade.h"

namespace kontur::picture {
namespace {

/// From the front, the patient's left and above.
constexpr Vec3 kTowardsViewer{0.50, -0.78, 0.38};

std::vector<Vec3> everything(const TriangleMesh& mesh, const ContourSet& contours) {
    std::vector<Vec3> points = mesh.points;
    for (const Contour& contour : contours.contours)
        points.insert(points.end(), contour.points.begin(), contour.points.end());
    return points;
}

/// Drawn contours on the screen, cut into runs that the surface hides or shows.
class ContourOverlay {
public:
    ContourOverlay(const ShadedSurface& surface, const Camera& camera, double tolerance_mm)
        : surface_(surface), camera_(camera), tolerance_mm_(tolerance_mm) {}

    struct Run {
        std::vector<Point2> line;
        bool visible;
    };

    std::vector<Run> runs(const Contour& contour) const {
        std::vector<Run> result;
        const std::size_t count = contour.points.size();
        for (std::size_t i = contour.closed ? 0 : 1; i < count; ++i)
            append(result, camera_.project(contour.points[(i + count - 1) % count]), camera_.project(contour.points[i]));
        return result;
    }

private:
    void append(std::vector<Run>& runs, const Vec3& from, const Vec3& to) const {
        constexpr double kStepPx = 2;
        const int steps = std::max(1, static_cast<int>(std::ceil(std::hypot(to.x - from.x, to.y - from.y) / kStepPx)));
        for (int s = 0; s < steps; ++s) {
            const Vec3 a = from + (static_cast<double>(s) / steps) * (to - from);
            const Vec3 b = from + (static_cast<double>(s + 1) / steps) * (to - from);
            const bool visible = is_visible(0.5 * (a + b));
            if (runs.empty() || runs.back().visible != visible) runs.push_back({{{a.x, a.y}}, visible});
            runs.back().line.push_back({b.x, b.y});
        }
    }

    /// A contour lies on the surface only up to the residual and the mesh's coarseness, so the nearby pixel that hides it
    /// least decides.
    bool is_visible(const Vec3& p) const {
        constexpr int kReachPx = 2;
        for (int dy = -kReachPx; dy <= kReachPx; ++dy)
            for (int dx = -kReachPx; dx <= kReachPx; ++dx) {
                const int x = std::clamp(static_cast<int>(p.x) + dx, 0, surface_.width - 1);
                const int y = std::clamp(static_cast<int>(p.y) + dy, 0, surface_.height - 1);
                const auto i =
                    static_cast<std::size_t>(y) * static_cast<std::size_t>(surface_.width) + static_cast<std::size_t>(x);
                if (surface_.depth_mm[i] <= p.z + tolerance_mm_) return true;
            }
        return false;
    }

    const ShadedSurface& surface_;
    const Camera& camera_;
    double tolerance_mm_;
};

void draw_contours(Canvas& canvas, const PanelPlace& place, const ContourOverlay& overlay, const ContourSet& contours) {
    std::vector<ContourOverlay::Run> runs;
    for (const Contour& contour : contours.contours)
        for (auto& run : overlay.runs(contour)) {
            for (Point2& p : run.line) p = {p.x + place.rect.x, p.y + place.rect.y};
            runs.push_back(std::move(run));
        }
    const auto stroke_all = [&](bool visible, const Color& color, double width) {
        for (const auto& run : runs)
            if (run.visible == visible) canvas.stroke(run.line, false, color, width * place.unit);
    };
    stroke_all(false, kDrawn.with_alpha(0.30), 1.4);
    stroke_all(true, {0.05, 0.04, 0.02, 0.55}, 4.6);
    stroke_all(true, kDrawn, 2.6);
}

/// A small cube with a letter on each of the three faces that the viewer sees.
void draw_orientation_cube(Canvas& canvas, const PanelPlace& place, const Plane& screen) {
    const double half = 21 * place.unit;
    const Point2 middle{place.rect.right() - 58 * place.unit, place.rect.bottom() - 62 * place.unit};
    const auto on_screen = [&](const Vec3& d) { return Point2{half * dot(screen.u, d), half * dot(screen.v, d)}; };
    for (int axis = 0; axis < 3; ++axis)
        for (const double sign : {-1.0, 1.0}) {
            Vec3 outward;
            outward[axis] = sign;
            const double facing = -dot(outward, screen.normal);
            if (facing <= 0) continue;
            // The text stands upright on the sides; on top it is read from the patient's front.
            const Vec3 down = axis == 2 ? Vec3{0, -sign, 0} : Vec3{0, 0, -1}, right = cross(outward, down);
            const Point2 center = on_screen(outward), r = on_screen(right), d = on_screen(down);
            const auto corner = [&](double a, double b) {
                return Point2{middle.x + center.x + a * r.x + b * d.x, middle.y + center.y + a * r.y + b * d.y};
            };
            const std::vector<std::vector<Point2>> face{{corner(-1, -1), corner(1, -1), corner(1, 1), corner(-1, 1)}};
            const double light = 0.30 + 0.42 * facing;
            canvas.fill_polygons(face, {light, 1.04 * light, 1.10 * light});
            canvas.stroke(face.front(), true, kGround, 1.2 * place.unit);
            canvas.painted_text({middle.x + center.x, middle.y + center.y}, {1.25 * r.x, 1.25 * r.y},
                                {1.25 * d.x, 1.25 * d.y}, orientation_letters(outward), {0.04, 0.05, 0.07});
        }
}

}  // namespace

void draw_surface_panel(Canvas& canvas, const PanelPlace& place, const SurfaceContent& content, const Work& work) {
    const auto& [mesh, contours, shown] = content;
    const auto clip = canvas.clip(place.rect);
    canvas.fill_gradient(place.rect, {0.155, 0.185, 0.235}, {0.075, 0.090, 0.115});
    const std::vector<Vec3> points =
        shown.empty() ? everything(mesh, contours) : std::vector<Vec3>(shown.begin(), shown.end());
    const auto width = static_cast<int>(place.rect.width), height = static_cast<int>(place.rect.height);
    const Camera camera = fit_camera(view_plane({}, kTowardsViewer), points, width, height, 0.07);

    const ShadedSurface surface = shade(mesh, camera, {.color = {kMaterial.red, kMaterial.green, kMaterial.blue}}, work);
    canvas.blend(static_cast<int>(place.rect.x), static_cast<int>(place.rect.y), width, height, surface.argb);
    draw_contours(canvas, place, ContourOverlay(surface, camera, 0.008 * bounding_box(points).diagonal()), contours);
    draw_edge_letters(canvas, place, camera.plane);
    draw_orientation_cube(canvas, place, camera.plane);
    if (!points.empty()) draw_scale_bar(canvas, place, camera.pixel_mm);
    canvas.frame(place.rect, kFrame, place.unit);
}

}  // namespace kontur::picture
