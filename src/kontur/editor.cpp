// SPDX-License-Identifier: Apache-2.0
#include "kontur/editor.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "kontur/base/checks.h"
#include "kontur/base/error.h"
#include "kontur/base/stopwatch.h"
#include "kontur/drawing_check.h"
#include "kontur/extract/preview.h"
#include "kontur/extract/surface_band.h"
#include "kontur/extract/voxelize.h"
#include "kontur/image/image_memory.h"
#include "kontur/image/part_fits.h"
#include "kontur/pipeline.h"
#include "kontur/shape/section.h"

namespace kontur {
namespace {

// A thousand points tell the surface to some 0.1 mm, so the solver need not do better.
constexpr double kPreviewTolerance = 50;  // times that of the finished surface
constexpr std::size_t kPreviewLines = 2;  // times as many points as the preview has tell where lines run
// Of what follows the image's last word until the next one: a liver of 30 contours with 8,540 points is on average 0.105
// instead of 0.049 mm off that, and told in a third of the time.
constexpr std::size_t kFollowedPoints = 3000;
// A screen shows an organ on some 500 pixels: a triangle then is five of them wide, and off by a twentieth of one.
constexpr double kSpacingFraction = 0.01;   // of the contours' diameter
constexpr double kLeastSpacing = 0.5;       // of that ...
constexpr double kStepsAcross = 4;          // ... where something drawn is narrower than so many steps
constexpr double kPreviewSteps = 2;         // so many times as far apart as the finished surface's
constexpr double kShownNoise = 0.04;        // of the preview's spacing: what the image said before
constexpr double kPlaneTolerance = 0.0015;  // of the diameter: what is drawn so near to each other is in one plane
// A cut is cheap: it may be finer than the mesh.
constexpr double kCutFraction = 0.5;  // of the preview's spacing
// The same contour, as far as the surface's tilt along it goes:
constexpr double kSameDirection = 0.9999;  // cosine between normals
constexpr double kEditedBy = 0.1;          // of the diameter, at most
constexpr int kMostReuses = 16;            // of tilts, until they are found anew

bool same_drawing(const Contour& a, const Contour& b) {
    return a.points == b.points && a.plane.origin == b.plane.origin && a.plane.normal == b.plane.normal &&
           a.closed == b.closed;
}

double border_mm(const Polygon2& outline) {
    double border = 0;
    for (std::size_t n = 0, last = outline.size() - 1; n < outline.size(); last = n++)
        border += std::hypot(outline[n][0] - outline[last][0], outline[n][1] - outline[last][1]);
    return border;
}

/// Of the narrowest section that was drawn: of a ring or a strip its width, of a disk its radius.
double narrowest_mm(const Drawing& drawing) {
    double narrowest = drawing.diameter_mm();
    for (const Section& section : sections_of(drawing.tidied, kPlaneTolerance * drawing.diameter_mm())) {
        double enclosed = 0, border = 0;
        for (std::size_t n = 0; n < section.outlines.size(); ++n) {
            enclosed += section.layer(n) * area(section.outlines[n]);
            border += border_mm(section.outlines[n]);
        }
        if (border > 0) narrowest = std::min(narrowest, 2 * std::abs(enclosed) / border);
    }
    return narrowest;
}

/// Lets the fit pass the places at which the image showed the surface before; returns how many there are.
std::size_t follow_memory(PreparedContours& prepared, const ImageMemory& memory, const ContourSet& set, double noise_mm) {
    const std::vector<Vec3> places = memory.places_in(set);
    for (const Vec3& place : places)
        prepared.bounds.push_back({.position = place, .least_mm = 0, .most_mm = 0, .noise_mm = noise_mm});
    return places.size();
}

std::vector<FoundSide> sides_of(const Drawing& drawing) {
    std::vector<FoundSide> sides = drawing.sides;
    for (FoundSide& found : sides) found.contour = drawing.numbers[found.contour];
    return sides;
}

/// With `drawing` it is held against that.
EditedSurface surface_of(const FittedFunction& fit, std::span<const Vec3> starts, const PreviewOptions& lattice,
                         const Drawing* drawing, const Work& work) {
    EditedSurface surface;
    surface.function = fit.function;
    surface.solves = fit.solves;
    surface.spacing_mm = lattice.spacing_mm;
    std::optional<LatticeSurface> found = preview_with_lattice(surface.function, starts, lattice, work);
    if (!found) return surface;
    surface.mesh = std::move(found->mesh);
    if (drawing)
        surface.section_check = check_sections(*drawing, surface.function, found->lattice, fill(found->lattice, work), work);
    return surface;
}

/// Points of a contour, as the fit has them, and the cosines of the surface's tilts there.
struct TiltedLine {
    std::vector<Vec3> positions;
    std::vector<double> slopes;

    /// Of the point that lies nearest to a place, if it is near: mostly that of number `n`.
    std::optional<double> slope_near(const Vec3& place, std::size_t n, double near_mm) const {
        if (n < positions.size() && positions[n] == place) return slopes[n];
        const auto squared = [&](const Vec3& p) { return dot(p - place, p - place); };
        const auto nearest = std::min_element(positions.begin(), positions.end(),
                                              [&](const Vec3& a, const Vec3& b) { return squared(a) < squared(b); });
        if (nearest == positions.end() || squared(*nearest) > near_mm * near_mm) return std::nullopt;
        return slopes[static_cast<std::size_t>(nearest - positions.begin())];
    }
};

/// A contour of the last fit and its points there.
struct FittedLine {
    Contour contour;
    TiltedLine line;
};

/// Cosines of the surface's tilts at prepared points.
struct Tilts {
    std::vector<double> slopes;  ///< 1 where nothing is known
    bool any, all;               ///< whether something is known, and whether everything is
};

std::vector<TiltedLine> tilted_lines(const PreparedContours& prepared, const std::vector<double>& slopes,
                                     std::size_t contours) {
    std::vector<TiltedLine> lines(contours);
    for (std::size_t i = 0; i < prepared.points.size(); ++i) {
        if (prepared.points[i].contour == kNoContour) continue;
        TiltedLine& line = lines[static_cast<std::size_t>(prepared.points[i].contour)];
        line.positions.push_back(prepared.points[i].position);
        line.slopes.push_back(slopes[i]);
    }
    return lines;
}

/// What the editor takes over from the last fit of a preview.
class FitMemory {
public:
    Tilts tilts(const ContourSet& contours, const PreparedContours& prepared) const {
        const double near_mm = kEditedBy * prepared.ball.diameter();
        std::vector<const FittedLine*> earlier;
        for (std::size_t c = 0; c < contours.contours.size(); ++c) earlier.push_back(line_of(contours, c));
        std::vector<std::size_t> use_counts(earlier.size(), 0);
        Tilts tilts{std::vector<double>(prepared.points.size(), 1.0), false, lines_.size() == earlier.size()};
        for (std::size_t i = 0; i < prepared.points.size(); ++i) {
            if (prepared.points[i].contour == kNoContour) continue;
            const auto c = static_cast<std::size_t>(prepared.points[i].contour);
            const std::optional<double> slope =
                earlier[c] ? earlier[c]->line.slope_near(prepared.points[i].position, use_counts[c]++, near_mm)
                           : std::nullopt;
            tilts.slopes[i] = slope.value_or(1.0);
            tilts.any = tilts.any || slope;
            tilts.all = tilts.all && slope;
        }
        return tilts;
    }

    /// The bounds that lie where the last fit leaned on one, as well as that is known: they move a little with what is
    /// drawn.
    std::vector<std::size_t> active_bounds(const std::vector<Bound>& bounds) const {
        std::vector<std::size_t> found;
        for (const Vec3& place : active_bounds_) {
            const auto squared = [&](const Bound& bound) { return dot(bound.position - place, bound.position - place); };
            const auto nearest = std::ranges::min_element(bounds, {}, squared);
            if (nearest != bounds.end() && std::sqrt(squared(*nearest)) <= nearest->noise_mm)
                found.push_back(static_cast<std::size_t>(nearest - bounds.begin()));
        }
        return found;
    }

    void remember(const ContourSet& contours, const PreparedContours& prepared, const FittedFunction& fitted) {
        std::vector<TiltedLine> lines = tilted_lines(prepared, fitted.slopes, contours.contours.size());
        lines_.clear();
        active_bounds_.clear();
        for (const PointConstraint& bound : fitted.active_bounds) active_bounds_.push_back(bound.position);
        for (std::size_t c = 0; c < lines.size(); ++c) lines_.push_back({contours.contours[c], std::move(lines[c])});
    }

private:
    /// That of the contour, or of the one that it was before it was bent or moved in its plane; null: nothing.
    const FittedLine* line_of(const ContourSet& contours, std::size_t index) const {
        const Contour& contour = contours.contours[index];
        const auto same = std::find_if(lines_.begin(), lines_.end(),
                                       [&](const FittedLine& line) { return same_drawing(line.contour, contour); });
        if (same != lines_.end()) return &*same;
        if (lines_.size() != contours.contours.size()) return nullptr;
        const FittedLine& before = lines_[index];
        const bool is_edited = before.contour.closed == contour.closed &&
                               dot(before.contour.plane.normal, contour.plane.normal) > kSameDirection;
        return is_edited ? &before : nullptr;
    }

    std::vector<FittedLine> lines_;
    std::vector<Vec3> active_bounds_;  ///< that the last fit leaned on
};

double finished_spacing(const EditorOptions& options, const Drawing& drawing) {
    if (options.finished_spacing_mm > 0) return options.finished_spacing_mm;
    const double usual = kSpacingFraction * drawing.diameter_mm();
    return std::clamp(narrowest_mm(drawing) / kStepsAcross, kLeastSpacing * usual, usual);
}

double preview_spacing(const EditorOptions& options, const Drawing& drawing) {
    return options.preview_spacing_mm > 0 ? options.preview_spacing_mm : kPreviewSteps * finished_spacing(options, drawing);
}

}  // namespace

struct Editor::State {
    EditorOptions options;
    FitMemory fit_memory;
    int tilt_reuses = 0;  ///< how many previews in a row found no tilts anew
    std::optional<ImageMemory> image_memory;
    PartFits part_fits;
    std::optional<Grid> image;  ///< that the last finished surface was drawn on

    explicit State(EditorOptions all) : options(std::move(all)) {}
};

Editor::Editor(EditorOptions options) : state_(std::make_unique<State>(std::move(options))) {
    check_not_below_0("the preview's spacing", state_->options.preview_spacing_mm, " mm");
    check_not_below_0("the finished surface's spacing", state_->options.finished_spacing_mm, " mm");
    if (state_->options.preview_points < 1)
        throw Error(ErrorKind::invalid_input, "the preview is fitted to 0 points; at least 1 is needed");
}

Editor::~Editor() = default;
Editor::Editor(Editor&&) noexcept = default;
Editor& Editor::operator=(Editor&&) noexcept = default;

EditedSurface Editor::preview(const ContourSet& contours, const Work& work,
                              const std::function<void(const SurfaceBand&)>& ahead) {
    if (contours.contours.empty()) return {};
    const EditorOptions& options = state_->options;
    std::vector<std::pair<std::string, double>> seconds;
    Stopwatch watch(seconds);
    const Drawing drawing =
        read_drawing(thinned(contours, kPreviewLines * options.preview_points), options.segment.fill_rule);
    StageOptions stages = stage_options(options.segment, drawing.diameter_mm());
    stages.prepare.image = state_->image;
    PreparedContours prepared = prepare(drawing, stages.prepare, work);
    const double spacing_mm = preview_spacing(options, drawing);
    std::size_t earlier_places = 0;
    if (state_->image_memory)
        earlier_places = follow_memory(prepared, *state_->image_memory, contours, kShownNoise * spacing_mm);
    watch.lap("prepare");
    stages.fit.most_points = options.preview_points;
    stages.fit.tilt_points = options.preview_points;
    *stages.fit.solve.tolerance_mm *= kPreviewTolerance;
    stages.fit.early_tolerance_factor = 2;
    Tilts tilts = state_->fit_memory.tilts(drawing.contours, prepared);
    if (tilts.any) stages.fit.start_slopes = std::move(tilts.slopes);
    if (tilts.any) {  // the last round is enough, or none
        stages.fit.start_smoothing *= std::pow(stages.fit.smoothing_factor, stages.fit.rounds - 1);
        stages.fit.rounds = tilts.all && state_->tilt_reuses < kMostReuses ? 0 : 1;
        stages.fit.start_bounds = state_->fit_memory.active_bounds(prepared.bounds);
    }
    const FittedFunction fitted = fit(prepared, stages.fit, work);
    watch.lap("fit");
    const std::vector<Vec3> starts =
        start_points(drawing.contours, prepared, fitted.function, *stages.prepare.click_margin_mm);
    const PreviewOptions lattice{spacing_mm};
    if (ahead) ahead(SurfaceBand(fitted.function, starts, {kCutFraction * lattice.spacing_mm}, work));
    EditedSurface surface = surface_of(fitted, starts, lattice, nullptr, work);
    watch.lap("mesh");
    surface.sides = sides_of(drawing);
    surface.near_lines = drawing.near_lines;
    surface.seconds = std::move(seconds);
    surface.earlier_places = earlier_places;
    state_->tilt_reuses = stages.fit.rounds == 0 ? state_->tilt_reuses + 1 : 0;
    state_->fit_memory.remember(drawing.contours, prepared, fitted);
    return surface;
}

EditedSurface Editor::finish(const ContourSet& contours, const Work& work) const {
    return Editor(state_->options).finish(contours, nullptr, work);
}

EditedSurface Editor::finish(const ContourSet& contours, const Image* image, const Work& work,
                             const std::function<void(const EditedSurface&)>& alone) {
    if (contours.contours.empty()) {
        EditedSurface nothing;
        nothing.finished = true;
        return nothing;
    }
    const EditorOptions& options = state_->options;
    const Drawing drawing = read_drawing(contours, options.segment.fill_rule);
    state_->image = image ? std::optional(image->grid) : std::nullopt;
    StageOptions stages = stage_options(options.segment, drawing.diameter_mm());
    stages.prepare.image = state_->image;
    const PreparedContours prepared = prepare(drawing, stages.prepare, work);
    const double spacing_mm = finished_spacing(options, drawing);
    const auto finished_surface = [&](const FittedFunction& fitted) {
        EditedSurface surface =
            surface_of(fitted, start_points(drawing.contours, prepared, fitted.function, *stages.prepare.click_margin_mm),
                       {spacing_mm}, &drawing, work);
        surface.finished = true;
        surface.residual = residual(surface.function, drawing.contours, work, state_->image);
        surface.residual.worst_contour = drawing.numbers.at(surface.residual.worst_contour);
        surface.sides = sides_of(drawing);
        surface.near_lines = drawing.near_lines;
        return surface;
    };
    const bool asks = image && options.segment.use_image != UseImage::off;
    if (!asks) forget_image();
    if (alone && state_->image_memory) {
        PreparedContours followed = prepared;
        const std::size_t places = follow_memory(followed, *state_->image_memory, contours, kShownNoise * spacing_mm);
        FitOptions once = stages.fit;
        once.most_solves = 1;
        once.most_points = kFollowedPoints;
        if (places > 0) {
            EditedSurface surface = finished_surface(fit(followed, once, work));
            surface.earlier_places = places;
            alone(surface);
        }
    }
    const FittedFunction by_contours = fit(prepared, stages.fit, work);
    EditedSurface surface = finished_surface(by_contours);
    if (!asks) return surface;
    if (alone) alone(surface);
    state_->part_fits.begin_question();
    ImageFit with_image = follow_image({drawing, prepared, by_contours}, *image, stages, work, &state_->part_fits);
    if (with_image.report.verdict == ImageVerdict::used) surface = finished_surface(with_image.fitted);
    surface.image = std::move(with_image.report);
    follow_image_of(contours, surface.image);
    return surface;
}

void Editor::follow_image_of(const ContourSet& contours, const ImageReport& report) {
    forget_image();
    if (!report.shares.empty()) state_->image_memory.emplace(contours, report.shares);
}

void Editor::forget_image() { state_->image_memory.reset(); }

const EditorOptions& Editor::options() const { return state_->options; }

}  // namespace kontur
