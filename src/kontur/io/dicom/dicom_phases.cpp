// SPDX-License-Identifier: Apache-2.0
#include "kontur/io/dicom/dicom_phases.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <set>
#include <string_view>
#include <tuple>

#include "kontur/base/error.h"
#include "kontur/base/natural_order.h"
#include "kontur/base/number_from_chars.h"
#include "kontur/base/printable.h"
#include "kontur/io/dicom/dicom_content.h"
#include "kontur/io/dicom/dicom_grid.h"

namespace kontur {
namespace {

namespace fs = std::filesystem;

/// What phases of one motion have in common.
using Likeness = std::tuple<std::string, std::string, std::string, std::string>;
using Stacks = std::vector<const DicomStack*>;

const DicomHeader& first_of(const DicomStack& stack) { return stack.slices.front(); }

bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// 30 of "Gated, 30.0%".
std::optional<double> percent_of(const std::string& description) {
    const std::size_t sign = description.find('%');
    if (sign == std::string::npos) return std::nullopt;
    const std::size_t end = sign > 0 && description[sign - 1] == ' ' ? sign - 1 : sign;
    std::size_t begin = end;
    while (begin > 0 && (is_digit(description[begin - 1]) || description[begin - 1] == '.')) --begin;
    double percent = 0;
    const char* const last = description.data() + end;
    const auto [stopped, failure] = number_from_chars(description.data() + begin, last, percent);
    return failure == std::errc() && stopped == last ? std::optional(percent) : std::nullopt;
}

/// "T1" and "T2" are no moments of one thing, "phase 1" and "phase 2" are.
bool counts_moments(const std::string& description) {
    constexpr std::array<std::string_view, 5> kWords{"phase", "frame", "time", "gate", "bin"};
    constexpr std::size_t kBetween = 3;  // "phase: 3", "bin no 3"; with 1 no colon fits, with 6 another word does
    if (percent_of(description)) return true;
    const std::string small = lower_case(description);
    return std::ranges::any_of(kWords, [&](std::string_view word) {
        const std::size_t found = small.find(word);
        if (found == std::string::npos) return false;
        const std::size_t after = found + word.size();
        return std::ranges::any_of(std::string_view(small).substr(after, kBetween + 1), is_digit);
    });
}

std::string without_numbers(const std::string& text) {
    std::string rest;
    for (const char c : text)
        if (!is_digit(c) && c != '.') rest += c;
    return rest;
}

Likeness likeness_of(const DicomHeader& header) {
    const std::string& said = header.description;
    return {header.modality, header.patient_id, header.frame_of_reference_uid,
            counts_moments(said) ? without_numbers(said) : said};
}

/// Tells moments with equal descriptions apart.
std::optional<double> moment_of(const DicomStack& stack) {
    const DicomHeader& first = first_of(stack);
    if (first.temporal_position) return static_cast<double>(*first.temporal_position);
    return first.trigger_time_ms;
}

/// False where nothing puts them in order.
bool put_in_order(Stacks& stacks) {
    if (counts_moments(first_of(*stacks.front()).description)) {
        const auto before = [](const DicomStack* a, const DicomStack* b) {
            const std::string &left = first_of(*a).description, &right = first_of(*b).description;
            const auto one = percent_of(left), other = percent_of(right);
            return one && other && *one != *other ? *one < *other : comes_before(left, right);
        };
        std::ranges::sort(stacks, before);
        return std::ranges::adjacent_find(stacks, std::not_fn(before)) == stacks.end();
    }
    if (!std::ranges::all_of(stacks, [](const DicomStack* stack) { return moment_of(*stack).has_value(); })) return false;
    std::ranges::sort(stacks, {}, [](const DicomStack* stack) { return *moment_of(*stack); });
    return std::ranges::adjacent_find(stacks, [](const DicomStack* a, const DicomStack* b) {
               return *moment_of(*a) == *moment_of(*b);
           }) == stacks.end();
}

/// All groups of at least two that have an order.
std::vector<Stacks> groups_of(const DicomContent& content) {
    std::map<std::string, int> volumes;
    for (const DicomStack& stack : content.stacks) ++volumes[first_of(stack).series_uid];
    std::map<Likeness, Stacks> alike;
    for (const DicomStack& stack : content.stacks)
        if (volumes[first_of(stack).series_uid] == 1 && first_of(stack).dose_unit.empty())
            alike[likeness_of(first_of(stack))].push_back(&stack);
    std::vector<Stacks> groups;
    for (auto& [likeness, stacks] : alike)
        if (stacks.size() > 1 && put_in_order(stacks)) groups.push_back(std::move(stacks));
    return groups;
}

std::optional<Stacks> chosen(const std::vector<Stacks>& groups, const std::optional<std::string>& series_uid) {
    if (!series_uid) return groups.size() == 1 ? std::optional(groups.front()) : std::nullopt;
    for (const Stacks& stacks : groups)
        if (std::ranges::any_of(stacks, [&](const DicomStack* stack) { return first_of(*stack).series_uid == *series_uid; }))
            return stacks;
    return std::nullopt;
}

void check_grids(const fs::path& folder, const Stacks& stacks, bool resample) {
    constexpr double kSameMm = 1e-2;  // positions are decimal strings; .005 to .02 mm are far below any pixel
    const Grid first = stack_grid(*stacks.front(), resample).grid;
    for (const DicomStack* stack : stacks) {
        const Grid grid = stack_grid(*stack, resample).grid;
        if (corner_distance_mm(first, grid) <= kSameMm) continue;
        const auto said = [](const DicomStack& one, const Grid& its) {
            return fmt::format("'{}' has {} x {} x {} voxels", first_of(one).description, its.size.i, its.size.j,
                               its.size.k);
        };
        throw Error(
            ErrorKind::invalid_input,
            fmt::format("{}: its series are no phases of one grid: {}, and {} or lies elsewhere; choose one with the "
                        "option series_uid",
                        folder.string(), said(*stacks.front(), first), said(*stack, grid)));
    }
}

std::optional<double> even_step(const Stacks& stacks) {
    constexpr double kSameStep = 0.1;  // of the mean: descriptions round, and half or twice of that tell 33 % from 34 %, too
    const auto percent = [&](std::size_t n) { return percent_of(first_of(*stacks[n]).description); };
    if (!percent(0) || !percent(stacks.size() - 1)) return std::nullopt;
    const double mean = (*percent(stacks.size() - 1) - *percent(0)) / static_cast<double>(stacks.size() - 1);
    for (std::size_t n = 1; n < stacks.size(); ++n)
        if (!percent(n) || !(std::abs(*percent(n) - *percent(n - 1) - mean) <= kSameStep * mean)) return std::nullopt;
    return mean;
}

}  // namespace

DicomPhases list_dicom_phases(const fs::path& folder, const DicomSeriesOptions& options, const Work& work) {
    const auto headers = options.content ? options.content : read_dicom_headers_of(folder, work);
    const DicomContent& content = *headers;
    const auto stacks = chosen(groups_of(content), options.series_uid);
    if (!stacks) return {};
    check_grids(folder, *stacks, options.resample_slices);
    DicomPhases phases;
    std::set<std::string> taken;
    for (const DicomStack* stack : *stacks) {
        phases.series.push_back(described(*stack));
        taken.insert(first_of(*stack).series_uid);
    }
    for (const DicomStack& stack : content.stacks)
        if (taken.insert(first_of(stack).series_uid).second) phases.others.push_back(first_of(stack).description);
    phases.step_percent = even_step(*stacks);
    return phases;
}

std::vector<DicomSeries> list_dicom_frames(const fs::path& path, const DicomSeriesOptions& options, const Work& work) {
    std::error_code ignored;
    if (fs::is_directory(path, ignored) && !options.series_uid)
        if (DicomPhases phases = list_dicom_phases(path, options, work); phases.series.size() > 1)
            return std::move(phases.series);
    return list_dicom_volumes(path, options, work);
}

std::vector<DicomSeries> list_dicom_frames_with(const fs::path& path, const std::string& series_uid, const Work& work) {
    DicomSeriesOptions options{.series_uid = series_uid};
    options.content = read_dicom_headers_of(path, work);
    std::error_code ignored;
    if (fs::is_directory(path, ignored))
        if (DicomPhases phases = list_dicom_phases(path, options, work); phases.series.size() > 1)
            return std::move(phases.series);
    return list_dicom_volumes(path, options, work);
}

}  // namespace kontur
