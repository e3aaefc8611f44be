// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "kontur/base/error.h"
#include "viewer/images/same_space.h"
#include "viewer/model/model_json.h"
#include "viewer/session/calls.h"
#include "viewer/session/events.h"
#include "viewer/session/replies.h"

// Images that are shown beside the one that the project is drawn on. There is room for one, number 1; messages name images
// by their numbers, so that there can be more.

namespace kontur::viewer {
namespace {

using nlohmann::json;

constexpr int kLastImage = 1;

json value_json(const Image& image, const Affine3& mm_to_index, const Vec3& at) {
    const double value = interpolate(image, mm_to_index, at, std::numeric_limits<double>::quiet_NaN());
    return std::isfinite(value) ? json(value) : json(nullptr);
}

json remove_image(SessionState& s, const Members&) {
    s.project.save_further_images({});
    show_second_image(s, nullptr);
    return json::object();
}

json value(SessionState& s, const Members& m) {
    const Vec3 at = m.point("at");
    const std::shared_ptr<const Image> image = s.image.times.image(m.time().value_or(s.image.times.own()));
    json values{value_json(*image, image->grid.index_to_mm.inverse(), at)};
    if (const auto second = s.second.get()) {
        const bool moves = second->times->count() == s.image.times.count() && second->times->own() == s.image.times.own();
        const auto of_second = second->times->image(moves ? m.time().value_or(second->times->own()) : second->times->own());
        values.push_back(value_json(*of_second, second->mm_to_index, at));
    }
    return {{"values", std::move(values)}};
}

}  // namespace

Calls second_image_calls() { return {{"image.remove", {remove_image}}, {"value", {value, false}}}; }

void put_second_image(SessionState& s, OpenedImage opened) {
    const OpenedImage first{s.image.voxels, s.image.title, {}, {}, s.image.frame_of_reference_uid, {}, s.image.identity};
    // The page keeps its notes in sight: what of its folder was passed over need be told but once.
    const auto is_passing = [](const std::string& note) { return note.starts_with("left out "); };
    for (const std::string& note : opened.notes)
        if (is_passing(note)) s.pages.notice("info", note);
    std::erase_if(opened.notes, is_passing);
    for (std::string& sentence : assumptions_of_one_space(first, opened)) opened.notes.push_back(std::move(sentence));
    const ImageReference reference = opened.reference;
    auto second = std::make_shared<const FurtherImage>(further_image(std::move(opened)));
    const std::scoped_lock lock(s.mutex);
    s.project.save_further_images({reference});
    show_second_image(s, std::move(second));
}

void show_second_image(SessionState& s, std::shared_ptr<const FurtherImage> second) {
    s.edges.set_further(1, second ? second->opened.image : nullptr);
    s.second.set(std::move(second));
    s.pages.tell({{"event", "images"}, {"images", further_images_json(s)}});
}

json further_images_json(const SessionState& s) {
    json images = json::array();
    if (const auto second = s.second.get()) images.push_back(to_json(*second, 1));
    return images;
}

std::shared_ptr<const Image> image_numbered(SessionState& s, int number, std::optional<int> time) {
    if (number == 0) return s.image.times.image(time.value_or(s.image.times.own()));
    if (number > kLastImage)
        throw Error(ErrorKind::invalid_input,
                    fmt::format("there is no image {}: the last one is image {}", number, kLastImage));
    const auto second = s.second.get();
    return second ? second->times->image(time.value_or(second->times->own())) : nullptr;
}

}  // namespace kontur::viewer
