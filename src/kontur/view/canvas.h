// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "kontur/shape/rgb_image.h"

namespace kontur {

/// A point on a picture: pixels from its left and top edge; pixel (0, 0) covers 0 to 1.
struct Point2 {
    double x = 0, y = 0;
};

struct Rect {
    double x = 0, y = 0, width = 0, height = 0;

    Point2 center() const { return {x + 0.5 * width, y + 0.5 * height}; }
    double right() const { return x + width; }
    double bottom() const { return y + height; }
    Rect inset(double by) const { return {x + by, y + by, width - 2 * by, height - 2 * by}; }
};

/// sRGB and opacity, 0 to 1.
struct Color {
    double red = 0, green = 0, blue = 0, alpha = 1;

    Color with_alpha(double a) const { return {red, green, blue, a}; }
};

enum class Align { left, center, right };

struct TextStyle {
    double size_px = 14;
    Color color{1, 1, 1};
    bool bold = false;
    Align align = Align::left;
    bool halo = false;  ///< a dark rim, for text on an image
};

/// Anti-aliased drawing onto an RGB picture. Text is in "DejaVu Sans" where that is installed, else in another
/// font, in cairo's own line font where there is none at all; should even that fail, text is left out and the rest drawn.
class Canvas {
public:
    /// Black. Throws Error(too_large) when the picture does not fit into memory or exceeds 32767 pixels on a side.
    Canvas(int width, int height);
    ~Canvas();
    Canvas(Canvas&&) noexcept;
    Canvas& operator=(Canvas&&) noexcept;

    void fill(const Rect& rect, const Color& color, double corner_radius = 0);
    void fill_gradient(const Rect& rect, const Color& top, const Color& bottom);
    void frame(const Rect& rect, const Color& color, double line_width);
    void stroke(std::span<const Point2> line, bool closed, const Color& color, double line_width);
    /// The inside of closed lines by the even-odd rule.
    void fill_polygons(std::span<const std::vector<Point2>> polygons, const Color& color);
    void dot(const Point2& at, double radius, const Color& color);
    /// Pixels with colour multiplied by alpha (0xAARRGGBB), row after row, their first one's corner at (x, y).
    void blend(int x, int y, int width, int height, std::span<const std::uint32_t> argb);

    /// One line of UTF-8; `at` is on its baseline, at the end or middle that `align` names. Returns the width in pixels.
    double text(const Point2& at, std::string_view text, const TextStyle& style);
    double text_width(std::string_view text, const TextStyle& style) const;
    /// Centred text on the parallelogram `middle` +- `right` / 2 +- `down` / 2, as if painted on it; its height is `down`.
    void painted_text(const Point2& middle, const Point2& right, const Point2& down, std::string_view text,
                      const Color& color);

    /// Keeps everything drawn until the returned guard dies within the rectangle.
    class ClipGuard;
    [[nodiscard]] ClipGuard clip(const Rect& rect);

    RgbImage image() const;

private:
    struct State;
    std::unique_ptr<State> state_;
};

class Canvas::ClipGuard {
public:
    explicit ClipGuard(State& state) : state_(&state) {}
    ~ClipGuard();
    ClipGuard(const ClipGuard&) = delete;
    ClipGuard& operator=(const ClipGuard&) = delete;

private:
    State* state_;
};

}  // namespace kontur
