// SPDX-License-Identifier: Apache-2.0
// Painted slices to whole labels.
#include <memory>

#include "kontur/fill_labels.h"
#include "requests.h"
#include "result.h"
#include "samples.h"

using namespace kontur;
using namespace kontur::wasm;

namespace {

using nlohmann::json;

/// As `kontur fill --report` writes it.
json to_json(const FillReport& report) {
    json labels = json::array();
    for (const FilledLabel& one : report.labels)
        labels.push_back({{"label", one.label},
                          {"slices", one.slices},
                          {"painted_voxels", one.painted_voxels},
                          {"added_voxels", one.added_voxels},
                          {"warnings", one.warnings}});
    return {{"labels", labels}, {"contested_voxels", report.contested_voxels}, {"closed_voxels", report.closed_voxels}};
}

/// Of two typed arrays on one grid; without an image, 0.
Result* filled(std::string_view text, const void* labels, const void* image) {
    const FillRequest request = fill_request_from(text);
    const Image painted_on = image ? image_from(image, request.image_type, request.grid) : Image{};
    const Filling filling = fill_labels(image_from(labels, request.labels_type, request.grid), image ? &painted_on : nullptr,
                                        request.options, told_work());
    auto result = std::make_unique<Result>();
    result->about = {{"report", to_json(filling.report)}, {"type", type_of(filling.labels)}};
    result->voxels = bytes_of(filling.labels);
    return result.release();
}

}  // namespace

KONTUR_EXPORT(kontur_fill)(const char* request, std::size_t length, const void* labels, const void* image)->Result* {
    return or_error([&] { return filled({request, length}, labels, image); });
}
