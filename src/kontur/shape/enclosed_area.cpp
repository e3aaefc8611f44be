// SPDX-License-Identifier: Apache-2.0
#include "kontur/shape/enclosed_area.h"

#include "kontur/shape/section.h"

namespace kontur {
namespace {

/// The length of the rows inside of a line times their distance.
double area_by_rows(const Polygon2& line) {
    constexpr int kRows = 512;
    Box2 box;
    for (const Point2& p : line) box.extend(p);
    const double row_mm = (box.high[1] - box.low[1]) / kRows;
    if (!(row_mm > 0)) return 0;
    double inside_mm = 0;
    for (const std::vector<double>& row : row_crossings(line, box.low[1] + row_mm / 2, row_mm, kRows))
        for (std::size_t i = 0; i + 1 < row.size(); i += 2) inside_mm += row[i + 1] - row[i];
    return inside_mm * row_mm;
}

}  // namespace

double enclosed_area(const Polygon2& line) {
    constexpr double kCrossesItself = 0.95;  // of what rows say, which is exact to a part in a thousand
    const double by_signs = area(line), by_rows = area_by_rows(line);
    return by_signs < kCrossesItself * by_rows ? by_rows : by_signs;
}

}  // namespace kontur
