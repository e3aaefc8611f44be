// SPDX-License-Identifier: Apache-2.0
#include "kontur/io/dicom/cie_lab.h"

#include <algorithm>
#include <cmath>

#include "kontur/shape/structure_attributes.h"

namespace kontur {
namespace {

using Triple = std::array<double, 3>;

constexpr Triple kWhiteD50{0.9642, 1.0, 0.8249};
/// Linear sRGB to XYZ, adapted from D65 to D50 (Bradford).
constexpr std::array<Triple, 3> kRgbToXyz{
    {{0.4360747, 0.3850649, 0.1430804}, {0.2225045, 0.7168786, 0.0606169}, {0.0139322, 0.0971045, 0.7141733}}};
constexpr std::array<Triple, 3> kXyzToRgb{
    {{3.1338561, -1.6168667, -0.4906146}, {-0.9787684, 1.9161415, 0.0334540}, {0.0719453, -0.2289914, 1.4052427}}};

constexpr double kEpsilon = 216.0 / 24389, kKappa = 24389.0 / 27;

Triple product(const std::array<Triple, 3>& matrix, const Triple& v) {
    Triple result{};
    for (std::size_t row = 0; row < 3; ++row)
        for (std::size_t column = 0; column < 3; ++column) result[row] += matrix[row][column] * v[column];
    return result;
}

double linear(double encoded) { return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4); }
double encoded(double linear) { return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055; }

double lab_root(double t) { return t > kEpsilon ? std::cbrt(t) : (kKappa * t + 16) / 116; }
double lab_cube(double f) { return f * f * f > kEpsilon ? f * f * f : (116 * f - 16) / kKappa; }

std::uint16_t scaled(double value, double low, double high) {
    return static_cast<std::uint16_t>(std::lround(std::clamp((value - low) / (high - low), 0.0, 1.0) * 65535));
}
double unscaled(std::uint16_t value, double low, double high) { return low + value / 65535.0 * (high - low); }

}  // namespace

DicomLab to_dicom_lab(const Rgb8& rgb) {
    const Triple xyz = product(kRgbToXyz, {linear(rgb[0] / 255.0), linear(rgb[1] / 255.0), linear(rgb[2] / 255.0)});
    Triple f{};
    for (std::size_t n = 0; n < 3; ++n) f[n] = lab_root(xyz[n] / kWhiteD50[n]);
    return {scaled(116 * f[1] - 16, 0, 100), scaled(500 * (f[0] - f[1]), -128, 127), scaled(200 * (f[1] - f[2]), -128, 127)};
}

Rgb8 to_rgb(const DicomLab& lab) {
    const double fy = (unscaled(lab[0], 0, 100) + 16) / 116;
    const Triple f{fy + unscaled(lab[1], -128, 127) / 500, fy, fy - unscaled(lab[2], -128, 127) / 200};
    Triple xyz{};
    for (std::size_t n = 0; n < 3; ++n) xyz[n] = kWhiteD50[n] * lab_cube(f[n]);
    const Triple rgb = product(kXyzToRgb, xyz);
    Triple levels{};
    for (std::size_t n = 0; n < 3; ++n) levels[n] = encoded(std::max(rgb[n], 0.0));
    return to_rgb8(levels);
}

}  // namespace kontur
