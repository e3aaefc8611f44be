// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

#include "kontur/sureness/surface_uncertainty.h"
#include "viewer/model/model.h"

// The model as JSON, the same in project files and in messages to the page (docs/viewer-protocol.md). Reading refuses what
// is missing, of another type, not finite or beyond a limit by Error(invalid_input), which names the member.

namespace kontur::viewer {

constexpr Id kLargestId = Id{1} << 53;        ///< JavaScript's whole numbers end here
constexpr std::size_t kMostPoints = 100'000;  ///< of one contour

constexpr int kMostImages = 16;                  ///< of one project, as far as messages and files go
constexpr std::size_t kMostRuleBytes = 4000;     ///< of a line that makes a structure
constexpr std::size_t kMostNameBytes = 400;      ///< of a structure's name: the protocol allows 100 characters
constexpr std::size_t kMostCommentBytes = 4096;  ///< of one on a structure: the protocol allows 1024 characters

/// How much a value may hold.
struct Limits {
    std::size_t points = kMostPoints;
    double farthest_mm = 1e6;  ///< largest coordinate
};
/// Of project files, more than is taken from anybody: what has once been stored must open.
constexpr Limits kStoredLimits{10 * kMostPoints, 1e7};

/// In one line; bytes that are no UTF-8 (names from files) become replacement characters.
std::string to_text(const nlohmann::json& value);

/// What others have written as JSON. Throws nlohmann's exception, and Error(invalid_input) for a key that stands twice
/// in one object and for what is nested deeper than `kDeepest`: JSON is copied and written by recursion, which would
/// overflow the stack.
constexpr int kDeepest = 64;
nlohmann::json parsed(std::string_view text);

nlohmann::json to_json(const Vec3& v);
nlohmann::json to_json(const std::vector<Vec3>& points);
nlohmann::json to_json(const Plane& plane);
nlohmann::json to_json(const ExpectedDice& dice);
nlohmann::json to_json(const SurfaceUncertainty& uncertainty);
nlohmann::json to_json(const StructureMask& mask);
nlohmann::json to_json(const Structure& structure);
nlohmann::json to_json(const ControlPoint& point);
nlohmann::json to_json(const DrawnContour& contour);

/// Of one structure.
constexpr std::size_t kMostEmptyPlanes = 1000, kMostSinglePoints = 1000;
StructureMask mask_from_json(const nlohmann::json& value);
Structure structure_from_json(const nlohmann::json& value);
DrawnContour contour_from_json(const nlohmann::json& value, const Limits& limits = {});

/// Typed access to the members of one object.
class Members {
public:
    explicit Members(const nlohmann::json& object, const Limits& limits = {});

    bool has(const char* key) const;
    const nlohmann::json& at(const char* key) const;
    double number(const char* key) const;
    double number_or(const char* key, double fallback) const;
    /// A whole number between the two.
    std::int64_t integer(const char* key, std::int64_t least, std::int64_t most) const;
    Id id(const char* key) const;
    bool flag(const char* key) const;
    /// Of a structure's fit; nullopt: "usual", what the library chooses.
    std::optional<double> smoothing(const char* key) const;
    /// From 1 to 65535; unset for "automatic".
    std::optional<std::int64_t> label_value(const char* key) const;
    bool flag_or(const char* key, bool fallback) const;
    /// At most `most` bytes of UTF-8 (nlohmann's parser has checked that it is).
    std::string text(const char* key, std::size_t most) const;
    Vec3 point(const char* key) const;
    std::vector<Vec3> points(const char* key) const;
    /// An orthonormal plane; cosines up to 1e-3 off are corrected.
    Plane plane(const char* key) const;
    std::vector<SurfacePoint> surface_points(const char* key) const;
    std::vector<Plane> planes(const char* key, std::size_t most = kMostEmptyPlanes) const;
    Stretch stretch(const char* key) const;
    Hand hand(const char* key) const;
    ContourEnd end(const char* key) const;
    double weight(const char* key) const;
    /// Of a correction, from 0.25 to 4.
    double reach(const char* key) const;
    /// The number of an image, from 0; 0 where it is missing.
    int image(const char* key) const;
    /// The member `time`, from 0; unset where it is missing.
    std::optional<int> time() const;
    std::string color(const char* key) const;

private:
    const nlohmann::json& object_;
    Limits limits_;
};

}  // namespace kontur::viewer
