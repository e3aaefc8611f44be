// SPDX-License-Identifier: Apache-2.0
#include "viewer/images/image_reference.h"

#include <nlohmann/json.hpp>

#include "kontur/base/error.h"
#include "viewer/model/model_json.h"

namespace kontur::viewer {
namespace {

using nlohmann::json;

constexpr std::size_t kLongestPath = 4096, kLongestUid = 64, kLongestFingerprint = 256;
constexpr std::int64_t kMost = 1'000'000;

}  // namespace

json to_json(const ImageChoice& choice) {
    json object = json::object();
    if (choice.series_uid) object["series"] = *choice.series_uid;
    if (choice.volume) object["volume"] = *choice.volume;
    if (choice.frame) object["frame"] = *choice.frame - 1;  // projects and requests count from 0
    if (choice.prefer) object["prefer"] = *choice.prefer == NiftiTransform::sform ? "sform" : "qform";
    if (choice.resample_slices) object["resample_slices"] = true;
    return object;
}

json to_json(const ImageReference& reference) {
    json object = to_json(reference.choice);
    object["path"] = reference.path;
    object["fingerprint"] = reference.fingerprint;
    return object;
}

ImageChoice choice_from_json(const json& object) {
    const Members m(object);
    ImageChoice choice;
    if (m.has("series")) choice.series_uid = m.text("series", kLongestUid);
    if (m.has("volume")) choice.volume = static_cast<int>(m.integer("volume", 1, kMost));
    if (m.has("frame")) choice.frame = m.integer("frame", 0, kMost) + 1;
    if (m.has("prefer")) {
        const std::string word = m.text("prefer", 5);
        if (word != "sform" && word != "qform")
            throw Error(ErrorKind::invalid_input, "'prefer' is neither \"sform\" nor \"qform\"");
        choice.prefer = word == "sform" ? NiftiTransform::sform : NiftiTransform::qform;
    }
    if (m.has("resample_slices")) choice.resample_slices = m.flag("resample_slices");
    return choice;
}

ImageReference reference_from_json(const json& object) {
    const Members m(object);
    return {m.text("path", kLongestPath), m.text("fingerprint", kLongestFingerprint), choice_from_json(object)};
}

}  // namespace kontur::viewer
