// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "kontur/base/error.h"
#include "viewer/images/same_space.h"
#include "viewer/model/model_json.h"
#include "viewer/session/session.h"

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

}  // namespace

void Session::put_second_image(OpenedImage opened) {
    const OpenedImage first{image_, title_, {}, {}, frame_of_reference_uid_, {}, identity_};
    // The page keeps its notes in sight: what of its folder was passed over need be told but once.
    const auto is_passing = [](const std::string& note) { return note.starts_with("left out "); };
    for (const std::string& note : opened.notes)
        if (is_passing(note)) notice("info", note);
    std::erase_if(opened.notes, is_passing);
    for (std::string& sentence : assumptions_of_one_space(first, opened)) opened.notes.push_back(std::move(sentence));
    const ImageReference reference = opened.reference;
    auto shown = std::make_shared<const FurtherImage>(further_image(std::move(opened)));
    const std::scoped_lock lock(mutex_);
    project_.save_further_images({reference});
    show_second_image(std::move(shown));
}

json Session::remove_image(const Members&) {
    project_.save_further_images({});
    show_second_image(nullptr);
    return json::object();
}

void Session::show_second_image(std::shared_ptr<const FurtherImage> shown) {
    edges_.set_further(1, shown ? shown->opened.image : nullptr);
    {
        const std::scoped_lock lock(second_mutex_);
        second_ = std::move(shown);
    }
    tell({{"event", "images"}, {"images", further_images()}});
}

std::shared_ptr<const FurtherImage> Session::second_image() const {
    const std::scoped_lock lock(second_mutex_);
    return second_;
}

std::optional<ImageReference> Session::kept_second_image() const {
    const std::scoped_lock lock(mutex_);
    if (project_.further_images().empty()) return std::nullopt;
    return project_.further_images().front();
}

std::string Session::second_title() const {
    const auto second = second_image();
    return second ? second->opened.title : "";
}

void Session::add_note(const std::string& sentence) {
    const std::scoped_lock lock(mutex_);
    notes_.push_back(sentence);
}

json Session::further_images() const {
    json images = json::array();
    if (const auto second = second_image()) images.push_back(to_json(*second, 1));
    return images;
}

std::shared_ptr<const Image> Session::image_numbered(int number, std::optional<int> time) {
    if (number == 0) return image_at(time);
    if (number > kLastImage)
        throw Error(ErrorKind::invalid_input,
                    fmt::format("there is no image {}: the last one is image {}", number, kLastImage));
    const auto second = second_image();
    return second ? second->times->image(time.value_or(second->times->own())) : nullptr;
}

json Session::value(const Members& m) {
    const Vec3 at = m.point("at");
    const std::shared_ptr<const Image> image = image_at(m.time());
    json values{value_json(*image, image->grid.index_to_mm.inverse(), at)};
    if (const auto second = second_image()) {
        const bool moves = second->times->count() == times_.count() && second->times->own() == times_.own();
        const auto shown = second->times->image(moves ? m.time().value_or(second->times->own()) : second->times->own());
        values.push_back(value_json(*shown, second->mm_to_index, at));
    }
    return {{"values", std::move(values)}};
}

}  // namespace kontur::viewer
