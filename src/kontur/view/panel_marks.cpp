// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>

#include "kontur/view/panels.h"

namespace kontur::picture {

double round_length(double limit) {
    const double power = std::pow(10, std::floor(std::log10(limit)));
    return (limit >= 5 * power ? 5 : limit >= 2 * power ? 2 : 1) * power;
}

void draw_scale_bar(Canvas& canvas, const PanelPlace& place, double pixel_mm) {
    const double length_mm = round_length(0.28 * place.rect.width * pixel_mm), length = length_mm / pixel_mm;
    const double x = place.rect.x + 16 * place.unit, y = place.rect.bottom() - 16 * place.unit, tick = 5 * place.unit;
    const std::array<Point2, 4> bar{{{x, y - tick}, {x, y}, {x + length, y}, {x + length, y - tick}}};
    canvas.stroke(bar, false, {0, 0, 0, 0.7}, 4.5 * place.unit);
    canvas.stroke(bar, false, kText, 2 * place.unit);
    canvas.text({x + 0.5 * length, y - 7 * place.unit}, rounded(length_mm, 1) + " mm",
                {.size_px = 12.5 * place.unit, .color = kText, .align = Align::center, .halo = true});
}

void draw_edge_letters(Canvas& canvas, const PanelPlace& place, const Plane& screen) {
    const EdgeLetters letters = edge_letters(screen);
    const Rect inner = place.rect.inset(10 * place.unit);
    const double size = 17 * place.unit, cap = 0.73 * size;
    TextStyle style{.size_px = size, .color = kText, .bold = true, .align = Align::left, .halo = true};
    canvas.text({inner.x, inner.center().y + 0.5 * cap}, letters.left, style);
    style.align = Align::right;
    canvas.text({inner.right(), inner.center().y + 0.5 * cap}, letters.right, style);
    style.align = Align::center;
    canvas.text({inner.center().x, inner.y + cap}, letters.top, style);
    canvas.text({inner.center().x, inner.bottom()}, letters.bottom, style);
}

}  // namespace kontur::picture
