// SPDX-License-Identifier: Apache-2.0
#include "kontur/io/dicom/dicom_grid.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "kontur/base/error.h"
#include "kontur/io/dicom/uneven_slices_error.h"

namespace kontur {
namespace {

constexpr double kRelativeTolerance = 0.01;
constexpr double kAlongToleranceMm = 0.01;
constexpr double kAcrossToleranceMm = 0.1;
constexpr std::size_t kGapsNamed = 10;
constexpr const char* kWayOut = "; kontur segment --spacing-mm needs no image";
constexpr const char* kWaysOut =
    "; the option resample_slices interpolates slices, and kontur segment --spacing-mm needs no image";
constexpr double kMostResampled = 1e5;  // slices

[[noreturn]] void refuse(const std::string& message) { throw Error(ErrorKind::unsupported, message); }

/// Positions in the words of the user: z for axial slices, else mm along the slice normal.
class PositionNames {
public:
    explicit PositionNames(const DicomStack& stack)
        : normal_(stack.slices.front().placement.normal()), axial_(std::abs(normal_.z) > 1 - 1e-4) {}

    std::string at(const DicomHeader& slice) const { return unit_text(fmt::format("{:.6g}", value(slice))); }
    std::string between(const DicomHeader& a, const DicomHeader& b) const {
        const auto [low, high] = std::minmax({value(a), value(b)});
        return fmt::format("{:.6g} and {:.6g}", low, high);
    }
    std::string unit_text(const std::string& values) const {
        return axial_ ? "z = " + values + " mm" : values + " mm along the slice normal";
    }

private:
    double value(const DicomHeader& slice) const {
        return axial_ ? slice.placement.position.z : dot(normal_, slice.placement.position);
    }

    Vec3 normal_;
    bool axial_;
};

std::vector<double> steps_between(const std::vector<double>& positions) {
    std::vector<double> steps;
    for (std::size_t k = 1; k < positions.size(); ++k) steps.push_back(positions[k] - positions[k - 1]);
    return steps;
}

double lower_median(std::vector<double> values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>((values.size() - 1) / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

void refuse_duplicates(const DicomStack& stack, const std::vector<double>& positions) {
    for (std::size_t k = 1; k < positions.size(); ++k)
        if (positions[k] - positions[k - 1] <= kSamePositionMm)
            refuse(fmt::format(
                "two slices lie at {}, and nothing tells them apart: {} and {}; move one of them out of the folder",
                PositionNames(stack).at(stack.slices[k]), name_of(stack.slices[k - 1]), name_of(stack.slices[k])));
}

[[noreturn]] void refuse_gaps(const DicomStack& stack, const std::vector<double>& steps, double usual) {
    const PositionNames names(stack);
    std::vector<std::string> gaps;
    double missing = 0;  // positions of a damaged file may be 1e300 mm apart
    for (std::size_t k = 0; k < steps.size(); ++k) {
        if (steps[k] < 1.5 * usual) continue;
        missing += std::round(steps[k] / usual) - 1;
        gaps.push_back(names.between(stack.slices[k], stack.slices[k + 1]));
    }
    const std::size_t count = gaps.size();
    if (count > kGapsNamed) gaps.resize(kGapsNamed);
    throw UnevenSlicesError(
        fmt::format("slices are missing between {}{}: {:.6g} of them at the usual spacing of {:.6g} mm{}",
                    names.unit_text(fmt::format("{}", fmt::join(gaps, ", "))),
                    count > kGapsNamed ? fmt::format(" and in {} more places", count - kGapsNamed) : "", missing, usual,
                    missing < kMostResampled ? kWaysOut : kWayOut));
}

/// The unit in the last place to which a coordinate was written, such as 0.1 of 12.3; 0: none that rounds visibly.
double written_unit(double value) {
    constexpr int kMostDigits = 3;
    constexpr double kFloatNoise = 2e-5;
    double unit = 1;
    for (int digits = 0; digits <= kMostDigits; ++digits, unit /= 10)
        if (std::abs(value - std::round(value / unit) * unit) <= kFloatNoise) return unit;
    return 0;
}

/// To which one coordinate of all slices is rounded: writers leave out zeros at the end. 0 for one that never changes.
double written_unit(const std::vector<DicomHeader>& slices, double Vec3::*coordinate) {
    const auto value = [&](const DicomHeader& slice) { return slice.placement.position.*coordinate; };
    if (std::ranges::all_of(slices, [&](const DicomHeader& s) { return value(s) == value(slices.front()); })) return 0;
    double unit = 1;
    for (const DicomHeader& slice : slices) unit = std::min(unit, written_unit(value(slice)));
    return unit;
}

/// How far rounding may put a slice off a grid whose first and last slices are rounded, too: half a unit each, by the share
/// of each coordinate, and never so much that a missing slice would pass.
double rounding_mm(const DicomStack& stack, const Vec3& shares, double step) {
    constexpr double kMostOfStep = 0.25, kDecimalNoise = 1e-4;
    const auto part = [&](double Vec3::*coordinate) {
        return std::abs(shares.*coordinate) * written_unit(stack.slices, coordinate);
    };
    return std::min(part(&Vec3::x) + part(&Vec3::y) + part(&Vec3::z) + kDecimalNoise, kMostOfStep * step);
}

/// The shares of the coordinates in a direction within the planes.
Vec3 shares_across(const Vec3& normal) {
    const auto share = [](double along) { return std::sqrt(std::max(0.0, 1 - along * along)); };
    return {share(normal.x), share(normal.y), share(normal.z)};
}

/// How far the slices lie off a regular grid from the first to the last one, along the normal.
double off_even_mm(const std::vector<double>& positions) {
    const double mean = positions.back() / static_cast<double>(positions.size() - 1);
    double worst = 0;
    for (std::size_t k = 0; k < positions.size(); ++k)
        worst = std::max(worst, std::abs(positions[k] - static_cast<double>(k) * mean));
    return worst;
}

/// Whether the slices count as even; a note where their positions are rounded.
bool is_even(const DicomStack& stack, const std::vector<double>& positions, std::vector<std::string>& notes) {
    const double mean = positions.back() / static_cast<double>(positions.size() - 1), worst = off_even_mm(positions);
    const double exact = std::max(kRelativeTolerance * mean, kAlongToleranceMm);
    if (worst <= exact) return true;
    if (worst > rounding_mm(stack, stack.slices.front().placement.normal(), mean)) return false;
    notes.push_back(
        fmt::format("the slices' positions are rounded: they lie up to {:.3g} mm off a regular grid with "
                    "steps of {:.6g} mm, on which they are taken to lie",
                    worst, mean));
    return true;
}

[[noreturn]] void refuse_uneven(const DicomStack& stack, const std::vector<double>& positions) {
    const std::vector<double> steps = steps_between(positions);
    const double usual = lower_median(steps), mean = positions.back() / static_cast<double>(positions.size() - 1);
    const auto [shortest, longest] = std::minmax_element(steps.begin(), steps.end());
    if (*longest >= 1.5 * usual) refuse_gaps(stack, steps, usual);
    const double tolerance = std::max(
        {kRelativeTolerance * mean, kAlongToleranceMm, rounding_mm(stack, stack.slices.front().placement.normal(), mean)});
    throw UnevenSlicesError(fmt::format(
        "the slice spacing is irregular: steps from {:.6g} to {:.6g} mm put slices up to {:.3g} mm off a regular grid; the "
        "limit is {:.3g} mm{}",
        *shortest, *longest, off_even_mm(positions), tolerance, kWaysOut));
}

/// Even steps from the first to the last position, near the usual step; a note says how many slices are made up.
std::vector<SliceBetween> resampled(const DicomStack& stack, const std::vector<double>& positions,
                                    std::vector<std::string>& notes) {
    const std::vector<double> steps = steps_between(positions);
    const double total = positions.back(), usual = lower_median(steps);
    if (!(total / usual < kMostResampled)) refuse_uneven(stack, positions);
    const auto count = static_cast<std::size_t>(std::llround(total / usual)) + 1;
    const double step = total / static_cast<double>(count - 1);
    std::vector<SliceBetween> slices;
    std::size_t made_up = 0, before = 0;
    for (std::size_t k = 0; k < count; ++k) {
        const double place = static_cast<double>(k) * step;
        while (before + 2 < positions.size() && positions[before + 1] <= place) ++before;
        const double share = std::clamp((place - positions[before]) / steps[before], 0.0, 1.0);
        const bool is_there = std::min(share, 1 - share) * steps[before] <= kRelativeTolerance * step;
        made_up += !is_there;
        if (is_there) slices.push_back({share < 0.5 ? before : before + 1, 0});
        else slices.push_back({before, share});
    }
    const auto [shortest, longest] = std::minmax_element(steps.begin(), steps.end());
    notes.push_back(fmt::format(
        "the slices lie {:.6g} to {:.6g} mm apart and are resampled to steps of {:.6g} mm: {} of {} slices are interpolated",
        *shortest, *longest, step, made_up, count));
    return slices;
}

/// Slices may be shifted against each other within their planes, but by the same amount from each to the next.
void check_shift(const DicomStack& stack, const std::vector<double>& positions, const Vec3& step) {
    const SlicePlacement& first = stack.slices.front().placement;
    const double along = dot(step, first.normal());
    const double tolerance = std::max({kRelativeTolerance * norm(step), kAcrossToleranceMm,
                                       rounding_mm(stack, shares_across(first.normal()), norm(step))});
    for (std::size_t k = 0; k < stack.slices.size(); ++k) {
        const Vec3 off_plane = stack.slices[k].placement.position - (first.position + positions[k] / along * step);
        const double off = norm(off_plane);
        if (off > tolerance)
            refuse(fmt::format("the slice at {} is shifted by {:.3g} mm against its neighbours; the limit is {:.3g} mm{}",
                               PositionNames(stack).at(stack.slices[k]), off, tolerance, kWayOut));
    }
}

/// Empty unless the slices are shifted across their normal, in total, by more than rounding would explain.
std::string tilt_note(const Vec3& step, const Vec3& normal, std::size_t slices) {
    const double along = dot(step, normal), across = norm(step - along * normal);
    if (across * static_cast<double>(slices - 1) <= kAcrossToleranceMm) return {};
    return fmt::format(
        "gantry tilt: each slice is shifted by {:.4g} mm against the one before ({:.3g} degrees); the grid is "
        "sheared accordingly",
        across, std::atan2(across, along) * 180 / std::numbers::pi);
}

Vec3 single_slice_step(const DicomHeader& slice, std::vector<std::string>& notes) {
    if (!slice.thickness_mm || !(*slice.thickness_mm > 0))
        refuse(fmt::format("the series has a single slice without a SliceThickness (0018,0050), so its depth is unknown{}",
                           kWayOut));
    notes.push_back(fmt::format("a single slice; its depth of {:.6g} mm is its SliceThickness", *slice.thickness_mm));
    return *slice.thickness_mm * slice.placement.normal();
}

/// The step from slice to slice, and where these are resampled.
struct Steps {
    Vec3 step;
    std::vector<SliceBetween> resampled{};
};

Steps slice_steps(const DicomStack& stack, bool resample, std::vector<std::string>& notes) {
    const DicomHeader &first = stack.slices.front(), &last = stack.slices.back();
    if (stack.slices.size() == 1) return {single_slice_step(first, notes)};
    const std::vector<double> positions = positions_along_normal(stack.slices);
    refuse_duplicates(stack, positions);
    Steps steps;
    if (!is_even(stack, positions, notes)) {
        if (!resample) refuse_uneven(stack, positions);
        steps.resampled = resampled(stack, positions, notes);
    }
    const std::size_t count = steps.resampled.empty() ? positions.size() : steps.resampled.size();
    steps.step = (last.placement.position - first.placement.position) / static_cast<double>(count - 1);
    check_shift(stack, positions, steps.step);
    if (std::string note = tilt_note(steps.step, first.placement.normal(), count); !note.empty())
        notes.push_back(std::move(note));
    return steps;
}

}  // namespace

StackGrid stack_grid(const DicomStack& stack, bool resample) {
    const DicomHeader& first = stack.slices.front();
    StackGrid result;
    result.notes = stack.notes;
    Steps steps = slice_steps(stack, resample, result.notes);
    const std::size_t slices = steps.resampled.empty() ? stack.slices.size() : steps.resampled.size();
    result.grid.size = {first.columns, first.rows, static_cast<std::int64_t>(slices)};
    result.resampled = std::move(steps.resampled);
    Affine3& affine = result.grid.index_to_mm;
    affine.set_column(0, first.placement.spacing_mm[0] * first.placement.row_direction);
    affine.set_column(1, first.placement.spacing_mm[1] * first.placement.column_direction);
    affine.set_column(2, steps.step);
    affine.translation = first.placement.position;
    check_grid(result.grid);
    return result;
}

}  // namespace kontur
