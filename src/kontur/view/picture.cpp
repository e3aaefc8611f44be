// SPDX-License-Identifier: Apache-2.0
#include "kontur/view/picture.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "kontur/base/checks.h"
#include "kontur/base/counted.h"
#include "kontur/base/error.h"
#include "kontur/extract/isolines.h"
#include "kontur/view/panels.h"

namespace kontur {
namespace {

using picture::kDrawn, picture::kFrame, picture::kGround, picture::kMuted, picture::kPanel, picture::kSurface,
    picture::kText;
using picture::PanelPlace, picture::rounded, picture::window_about;

/// The picture's places: the surface on the left, 2 x 2 on the right (three slices and the table), title above, footer
/// below.
struct Layout {
    double unit;
    Rect surface;
    std::array<Rect, 3> slices;
    Rect table;
};

Layout lay_out(int width, int height) {
    const double unit = std::min(width / 1600.0, height / 1000.0);
    const double margin = std::round(16 * unit), gap = std::round(10 * unit);
    const double top = std::round(66 * unit), bottom = std::round(height - 36 * unit);
    const double left_width = std::round(0.5 * (width - 2 * margin - gap));
    const double right = margin + left_width + gap;
    const double cell_width = std::floor(0.5 * (width - margin - right - gap)),
                 cell_height = std::floor(0.5 * (bottom - top - gap));
    const auto cell = [&](int column, int row) {
        return Rect{right + column * (cell_width + gap), top + row * (cell_height + gap), cell_width, cell_height};
    };
    return {unit, {margin, top, left_width, 2 * cell_height + gap}, {cell(0, 0), cell(0, 1), cell(1, 1)}, cell(1, 0)};
}

/// One scale for all slices: the largest extent in any of them leaves a margin for the surroundings.
double common_pixel_mm(const std::array<Slice, 3>& slices, const Rect& cell) {
    constexpr double kFilled = 0.78;
    double pixel_mm = 0;
    for (const Slice& slice : slices)
        pixel_mm = std::max({pixel_mm, slice.width_mm / (kFilled * cell.width), slice.height_mm / (kFilled * cell.height)});
    return pixel_mm > 0 ? pixel_mm : 1;
}

std::string volume(const TriangleMesh& mesh) { return in_ml(signed_volume_mm3(mesh) / 1000); }

/// Without contours only the surface, which came without them.
std::string subtitle(const TriangleMesh& mesh, const ContourSet& contours, bool has_surface) {
    const std::string contour_text = counted(contours.contours.size(), "drawn contour");
    if (!has_surface) return contour_text;
    const std::string surface = "surface of " + volume(mesh);
    return contours.contours.empty() ? surface : surface + " from " + contour_text;
}

std::string extent(const TriangleMesh& mesh) {
    const Vec3 size = bounding_box(mesh.points).size();
    return rounded(size.x, 3) + " × " + rounded(size.y, 3) + " × " + rounded(size.z, 3) + " mm";
}

std::vector<PictureFact> all_facts(const TriangleMesh& mesh, const ContourSet& contours, const PictureOptions& options) {
    std::vector<PictureFact> facts;
    if (options.has_surface) facts = {{"Volume (surface)", volume(mesh)}, {"Extent RL × AP × SI", extent(mesh)}};
    if (!contours.contours.empty()) {
        facts.push_back({"Contours", std::to_string(contours.contours.size())});
        facts.push_back({"Points", std::to_string(point_count(contours))});
    }
    facts.insert(facts.end(), options.facts.begin(), options.facts.end());
    return facts;
}

void draw_legend(Canvas& canvas, const PanelPlace& place, Point2 at, bool has_surface) {
    const double u = place.unit, line = 25 * u;
    const TextStyle style{.size_px = 14 * u, .color = kText};
    const auto caption = [&](std::string_view text) { canvas.text({at.x + 44 * u, at.y + 5 * u}, text, style); };
    const auto swatch = [&](const Color& color, double width) {
        const std::array<Point2, 2> ends{{{at.x + 2 * u, at.y}, {at.x + 30 * u, at.y}}};
        canvas.stroke(ends, false, color, width * u);
    };
    if (has_surface) {
        swatch(kSurface, 3.2);
        caption("surface of the segmentation");
        at.y += line;
    }
    swatch(kDrawn, 2.4);
    caption("contour drawn in this slice");
    at.y += line;
    canvas.dot({at.x + 16 * u, at.y}, 4 * u, kDrawn);
    caption("contour of another plane crosses");
}

void draw_table(Canvas& canvas, const PanelPlace& place, const std::vector<PictureFact>& facts, bool has_surface) {
    const double u = place.unit;
    const auto clip = canvas.clip(place.rect);
    canvas.fill(place.rect, kPanel);
    draw_legend(canvas, place, {place.rect.x + 18 * u, place.rect.y + 28 * u}, has_surface);
    const double rule = place.rect.y + 104 * u;
    const std::array<Point2, 2> ends{{{place.rect.x + 18 * u, rule}, {place.rect.right() - 18 * u, rule}}};
    canvas.stroke(ends, false, kFrame, u);
    picture::draw_facts(canvas, place, {place.rect.x + 18 * u, rule + 30 * u}, facts);
    canvas.frame(place.rect, kFrame, u);
}

void check_window(const Window& window) {
    check_finite("the window's centre", window.center);
    check_above_0("the window's width", window.width);
}

}  // namespace

void picture::check_picture_size(const PictureOptions& options) {
    const std::string size = std::to_string(options.width_px) + " x " + std::to_string(options.height_px) + " pixels";
    if (options.width_px < 320 || options.height_px < 200)
        throw Error(ErrorKind::invalid_input, "a picture of " + size + "; at least 320 x 200 are needed");
    if (options.width_px > 16384 || options.height_px > 16384)
        throw Error(ErrorKind::too_large, "a picture of " + size + "; at most 16384 x 16384 are possible");
}

void picture::draw_facts(Canvas& canvas, const PanelPlace& place, Point2 at, const std::vector<PictureFact>& facts) {
    const double right = place.rect.right() - 18 * place.unit, line = 25 * place.unit;
    for (const PictureFact& fact : facts) {
        if (at.y > place.rect.bottom() - 10 * place.unit) return;
        canvas.text(at, fact.caption, {.size_px = 14 * place.unit, .color = kMuted});
        canvas.text({right, at.y}, fact.value, {.size_px = 14 * place.unit, .color = kText, .align = Align::right});
        at.y += line;
    }
}

void picture::draw_frame_texts(Canvas& canvas, const PanelPlace& picture, const std::string& title,
                               const std::string& subtitle) {
    const double u = picture.unit, margin = std::round(16 * u);
    const Point2 top{margin, 44 * u}, bottom{margin, picture.rect.height - 13 * u};
    const double width = canvas.text(top, title, {.size_px = 29 * u, .color = kText, .bold = true});
    canvas.text({top.x + width + 18 * u, top.y}, subtitle, {.size_px = 19 * u, .color = kMuted});
    canvas.text(bottom, "kontur " KONTUR_VERSION " · research software, not a medical device",
                {.size_px = 12.5 * u, .color = kMuted});
    canvas.text({picture.rect.width - margin, bottom.y},
                "slices in radiological convention: the patient's right is on the left",
                {.size_px = 12.5 * u, .color = kMuted, .align = Align::right});
}

Window picture::window_about(const Image& image, const Box3& box_mm) {
    const Window of_all = suggest_window(image);
    if (of_all == Window{} || box_mm.is_empty()) return of_all;
    const Affine3 mm_to_index = image.grid.index_to_mm.inverse();
    const Vec3 around = 0.5 * box_mm.size();
    Box3 box;
    for (const Vec3& corner : corners({box_mm.min - around, box_mm.max + around})) box.extend(mm_to_index.apply(corner));
    Index3 low, high;
    for (int axis = 0; axis < 3; ++axis) {
        const auto last = static_cast<double>(image.grid.size[axis] - 1);
        low[axis] = static_cast<std::int64_t>(std::clamp(std::floor(box.min[axis]), 0.0, last));
        high[axis] = static_cast<std::int64_t>(std::clamp(std::ceil(box.max[axis]), 0.0, last));
    }
    Image part;
    part.samples = std::visit(
        [&](const auto& samples) {
            std::decay_t<decltype(samples)> values;
            for (std::int64_t k = low.k; k <= high.k; ++k)
                for (std::int64_t j = low.j; j <= high.j; ++j) {
                    const auto row = samples.begin() + static_cast<std::ptrdiff_t>(image.grid.offset(low.i, j, k));
                    values.insert(values.end(), row, row + (high.i - low.i + 1));
                }
            return Image::Samples(std::move(values));
        },
        image.samples);
    return suggest_window(part);
}

RgbImage make_picture(const TriangleMesh& mesh, const ContourSet& contours, const Image* image,
                      const PictureOptions& options, const Work& work) {
    picture::check_picture_size(options);
    check_mesh(mesh);
    if (image) check_image(*image);
    check_threads(work.threads);
    if (options.window) check_window(*options.window);
    const Layout layout = lay_out(options.width_px, options.height_px);
    Canvas canvas(options.width_px, options.height_px);
    const Rect all{0, 0, static_cast<double>(options.width_px), static_cast<double>(options.height_px)};
    canvas.fill(all, kGround);

    const std::string& name = options.title.empty() ? contours.name : options.title;
    picture::draw_frame_texts(canvas, {all, layout.unit}, name.empty() ? "segmentation" : name,
                              subtitle(mesh, contours, options.has_surface));
    picture::draw_surface_panel(canvas, {layout.surface, layout.unit}, {mesh, contours}, work);
    if (options.has_surface && mesh.triangles.empty())
        canvas.text(layout.surface.center(), "empty: there is no surface",
                    {.size_px = 24 * layout.unit, .color = kText, .align = Align::center, .halo = true});

    const std::array<Slice, 3> slices = choose_slices(mesh, contours, image);
    const Window window = options.window ? *options.window
                          : image        ? window_about(*image, bounding_box(mesh.points))
                                         : Window{};
    const picture::SliceContent content{mesh, contours, image, window, common_pixel_mm(slices, layout.slices.front())};
    for (std::size_t i = 0; i < slices.size(); ++i)
        picture::draw_slice_panel(canvas, {layout.slices[i], layout.unit}, slices[i], content);
    draw_table(canvas, {layout.table, layout.unit}, all_facts(mesh, contours, options), options.has_surface);
    return canvas.image();
}

}  // namespace kontur
