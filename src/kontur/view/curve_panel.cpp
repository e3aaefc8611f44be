// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "kontur/view/panels.h"

namespace kontur::picture {
namespace {

/// From frames and millilitres to the panel's pixels.
class CurveDrawing {
public:
    CurveDrawing(Canvas& canvas, const PanelPlace& place, const PictureCurve& curve)
        : canvas_(canvas), curve_(curve), unit_(place.unit) {
        const double u = unit_;
        axes_ = {place.rect.x + 62 * u, place.rect.y + 58 * u, place.rect.width - 84 * u, place.rect.height - 104 * u};
        most_ = *std::max_element(curve.values_ml.begin(), curve.values_ml.end());
        for (const auto& [low, high] : curve.intervals) most_ = std::max(most_, high);
        if (!(most_ > 0)) most_ = 1;
    }

    void draw() {
        draw_scales();
        draw_band();
        mark(curve_.largest, "largest");
        mark(curve_.smallest, "smallest");
        if (curve_.now) vertical(*curve_.now, kText, 1.6);
        std::vector<Point2> line;
        for (std::size_t n = 0; n < curve_.values_ml.size(); ++n) line.push_back(at(n, curve_.values_ml[n]));
        canvas_.stroke(line, false, kSurface, 2.4 * unit_);
        for (const std::size_t n : curve_.drawn) canvas_.dot(line.at(n), 4.2 * unit_, kDrawn);
        if (curve_.now) canvas_.dot(line.at(*curve_.now), 5.5 * unit_, kText);
    }

private:
    Point2 at(std::size_t frame, double ml) const {
        const double last = std::max(1.0, static_cast<double>(curve_.values_ml.size()) - 1);
        return {axes_.x + axes_.width * static_cast<double>(frame) / last, axes_.bottom() - axes_.height * ml / most_};
    }

    void line(const Point2& from, const Point2& to, const Color& color, double width) {
        const std::array<Point2, 2> ends{from, to};
        canvas_.stroke(ends, false, color, width * unit_);
    }

    void vertical(std::size_t frame, const Color& color, double width) {
        line({at(frame, 0).x, axes_.y}, {at(frame, 0).x, axes_.bottom()}, color, width);
    }

    /// From 0, so that an ejection fraction is seen as it is; the first and every so many frames.
    void draw_scales() {
        const double step = round_length(most_ / 4);
        for (int n = 0; n * step <= most_; ++n) {
            const double y = at(0, n * step).y;
            line({axes_.x, y}, {axes_.right(), y}, kFrame, 1);
            canvas_.text({axes_.x - 8 * unit_, y + 4.5 * unit_}, fmt::format("{:g}", n * step),
                         {.size_px = 13 * unit_, .color = kMuted, .align = Align::right});
        }
        const std::size_t frames = curve_.values_ml.size();
        const auto every = static_cast<std::size_t>(std::max(1.0, round_length(static_cast<double>(frames) / 6.0)));
        for (std::size_t frame = 1; frame <= frames; ++frame)
            if (frame == 1 || (frame > every && frame % every == 0))
                canvas_.text({at(frame - 1, 0).x, axes_.bottom() + 18 * unit_}, fmt::format("{}", frame),
                             {.size_px = 13 * unit_, .color = kMuted, .align = Align::center});
        canvas_.text({axes_.right(), axes_.bottom() + 36 * unit_}, "frame",
                     {.size_px = 13 * unit_, .color = kMuted, .align = Align::right});
    }

    void draw_band() {
        if (curve_.intervals.size() != curve_.values_ml.size()) return;
        std::vector<Point2> border;
        for (std::size_t n = 0; n < curve_.intervals.size(); ++n) border.push_back(at(n, curve_.intervals[n].second));
        for (std::size_t n = curve_.intervals.size(); n-- > 0;) border.push_back(at(n, curve_.intervals[n].first));
        const std::vector<std::vector<Point2>> band{border};
        canvas_.fill_polygons(band, kSurface.with_alpha(0.22));
    }

    void mark(std::size_t frame, const char* what) {
        vertical(frame, kMuted, 1);
        const double x = at(frame, 0).x;
        const bool is_left = x < axes_.center().x;
        canvas_.text({x + (is_left ? 5 : -5) * unit_, axes_.y - 5 * unit_}, fmt::format("{}: {}", what, frame + 1),
                     {.size_px = 13 * unit_, .color = kText, .align = is_left ? Align::left : Align::right});
    }

    Canvas& canvas_;
    const PictureCurve& curve_;
    double unit_, most_ = 1;
    Rect axes_{};
};

}  // namespace

void draw_curve_panel(Canvas& canvas, const PanelPlace& place, const PictureCurve& curve) {
    const auto clip = canvas.clip(place.rect);
    canvas.fill(place.rect, kPanel);
    canvas.text({place.rect.x + 12 * place.unit, place.rect.y + 23 * place.unit}, "Volume, ml",
                {.size_px = 15 * place.unit, .color = kText, .bold = true});
    if (!curve.intervals.empty())
        canvas.text({place.rect.right() - 12 * place.unit, place.rect.y + 23 * place.unit}, "band: 90 % interval",
                    {.size_px = 12.5 * place.unit, .color = kMuted, .align = Align::right});
    CurveDrawing(canvas, place, curve).draw();
    canvas.frame(place.rect, kFrame, place.unit);
}

}  // namespace kontur::picture
