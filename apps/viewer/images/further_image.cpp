// SPDX-License-Identifier: Apache-2.0
#include "viewer/images/further_image.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "kontur/base/error.h"
#include "kontur/io/dicom/dicom_suv.h"
#include "viewer/model/model_json.h"

namespace kontur::viewer {
namespace {

using nlohmann::json;

Window from_zero_to(double most) { return {most / 2, most}; }

std::vector<WindowPreset> emission_presets(const Image& image, const std::string& unit) {
    const double largest = value_range(image).second;
    std::vector<WindowPreset> presets{{"Automatic", emission_window(image, unit)}};
    if (unit == kSuvUnit)
        for (const int suv : {5, 7, 10, 15}) presets.push_back({"SUV 0 to " + std::to_string(suv), from_zero_to(suv)});
    presets.push_back({"From 0 to the largest", from_zero_to(largest > 0 ? largest : 1)});
    return presets;
}

}  // namespace

std::string patient_words(const DicomIdentity& identity) {
    if (identity.patient_id.empty()) return identity.patient_name;
    const std::string id = "ID " + identity.patient_id;
    return identity.patient_name.empty() ? id : fmt::format("{} ({})", identity.patient_name, id);
}

std::string unit_of(const DicomIdentity& identity, const Image& image) {
    if (!identity.modality.empty()) return identity.unit;
    return looks_like_ct(image) ? "HU" : "";
}

bool is_emission(const DicomIdentity& identity) { return identity.modality == "PT" || identity.modality == "NM"; }

Window emission_window(const Image& image, const std::string& unit) {
    constexpr std::size_t kEnough = 1u << 18;
    constexpr double kShare = 0.995, kLeastSuv = 5;
    std::vector<double> values;
    std::visit(
        [&](const auto& samples) {
            for (std::size_t i = 0; i < samples.size(); i += samples.size() / kEnough + 1)
                if (const auto value = static_cast<double>(samples[i]); std::isfinite(value)) values.push_back(value);
        },
        image.samples);
    double most = 0;
    if (!values.empty()) {
        const auto at = values.begin() + static_cast<std::ptrdiff_t>(kShare * static_cast<double>(values.size() - 1));
        std::nth_element(values.begin(), at, values.end());
        most = *at;
    }
    if (!(most > 0)) most = value_range(image).second;
    if (unit == kSuvUnit) most = std::max(most, kLeastSuv);
    return from_zero_to(most > 0 ? most : 1);
}

FurtherImage further_image(OpenedImage opened) {
    const Image& image = *opened.image;
    FurtherImage further;
    further.mm_to_index = image.grid.index_to_mm.inverse();
    further.unit = unit_of(opened.identity, image);
    further.range = value_range(image);
    const bool is_counted = is_emission(opened.identity);
    further.window = is_counted ? emission_window(image, further.unit) : suggest_window(image);
    further.presets = is_counted ? emission_presets(image, further.unit) : window_presets(image);
    further.times = std::make_shared<TimeAxis>(opened.image, opened.times);
    further.opened = std::move(opened);
    return further;
}

json to_json(const DicomIdentity& identity) {
    return {{"patient_name", identity.patient_name},
            {"patient_id", identity.patient_id},
            {"birth_date", identity.birth_date},
            {"study_date", identity.study_date},
            {"study_description", identity.study_description},
            {"series_number", identity.series_number},
            {"series_description", identity.series_description},
            {"modality", identity.modality}};
}

json to_json(const std::vector<WindowPreset>& presets) {
    json array = json::array();
    for (const WindowPreset& preset : presets)
        array.push_back({{"name", preset.name}, {"center", preset.window.center}, {"width", preset.window.width}});
    return array;
}

json to_json(const FurtherImage& further, int number) {
    const Grid& grid = further.opened.image->grid;
    return {{"image", number},
            {"key", further.opened.reference.fingerprint},
            {"title", further.opened.title},
            {"size", {grid.size.i, grid.size.j, grid.size.k}},
            {"spacing_mm", to_json(grid.spacing_mm())},
            {"unit", further.unit},
            {"times", further.times->count()},
            {"time", further.times->own()},
            {"range", {further.range.first, further.range.second}},
            {"notes", further.opened.notes},
            {"identity", to_json(further.opened.identity)},
            {"emission", is_emission(further.opened.identity)},
            {"window", {{"center", further.window.center}, {"width", further.window.width}}},
            {"presets", to_json(further.presets)}};
}

}  // namespace kontur::viewer
