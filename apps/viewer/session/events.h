// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <vector>

#include "viewer/session/session_state.h"

// What pages are told, as docs/viewer-protocol.md has it, and what it is made of.

namespace kontur::viewer {

nlohmann::json surface_event(const SessionState& s, const Surface& surface);
/// In all views, before anybody asks: a page that is busy drawing would come to ask much later.
nlohmann::json outlines_event(const std::vector<WatchedPlane>& watched, Id structure, std::int64_t revision,
                              const PlaneCutters& cut);
nlohmann::json to_json(const std::vector<BorderPair>& pairs);
nlohmann::json further_images_json(const SessionState& s);
/// After how many frames motion repeats: 0 where it does not, null where nobody has said.
nlohmann::json cycle_json(const SessionState& s);
nlohmann::json motion_json(const Motion& motion);
nlohmann::json motion_event(const Motion& motion);
/// As contours have it: unset for the one that was opened. Throws Error(invalid_input) for a time that there is not.
std::optional<int> time_from(const SessionState& s, std::optional<int> time);
/// Throws Error(invalid_input) for a contour that is drawn into a mask of another time.
void check_time(const SessionState& s, const Structure& structure, const DrawnContour& contour);
/// Null where the image cannot tell borders.
nlohmann::json use_image_json(const SessionState& s);

/// How sure the surface is, at the image's resolution, and the volume that lies within the image.
SurfaceEvidence evidence_of(const SessionState& s, const Surface& surface);
/// The image that fits follow between contours; null where the project does not use it, or it cannot tell borders.
std::shared_ptr<const Image> image_for_fits(const SessionState& s);
/// The same at another time.
std::shared_ptr<const Image> image_for_fits_at(SessionState& s, int time);
/// 0: the project's own. Null: it is not there. Throws Error(invalid_input) for a number that none can have.
std::shared_ptr<const Image> image_numbered(SessionState& s, int number, std::optional<int> time);
/// Shows it beside the project's own image, in place of the one that was; null: none.
void show_second_image(SessionState& s, std::shared_ptr<const FurtherImage> second);
/// Neighbours' contours in the plane of a changed contour, where their lines ran along its old one.
std::vector<DrawnContour> carried_with(SessionState& s, const DrawnContour& contour);

}  // namespace kontur::viewer
