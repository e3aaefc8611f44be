// SPDX-License-Identifier: Apache-2.0
#include "kontur/shape/provenance.h"

#include <bit>
#include <optional>
#include <span>

#include "kontur/shape/sha256.h"

namespace kontur {
namespace {

/// Numbers as 8 bytes each, the same on every machine; lists with their length in front, so that no two inputs run together.
class Digest {
public:
    void add(std::uint64_t number) {
        std::array<std::byte, 8> bytes;
        for (std::size_t n = 0; n < 8; ++n) bytes[n] = static_cast<std::byte>(number >> (8 * n));
        hash_.update(bytes);
    }
    void add(double number) { add(std::bit_cast<std::uint64_t>(number + 0.0)); }  // -0 is 0, as it is in files
    void add(const Vec3& v) {
        for (int axis = 0; axis < 3; ++axis) add(v[axis]);
    }
    void add(const std::vector<Vec3>& points) {
        add(std::uint64_t{points.size()});
        for (const Vec3& p : points) add(p);
    }
    void add(const Plane& plane) {
        for (const Vec3& v : {plane.origin, plane.normal, plane.u, plane.v}) add(v);
    }
    std::string hex() const { return hash_.hex(); }

private:
    Sha256 hash_;
};

}  // namespace

std::string contours_sha256(const ContourSet& set) {
    Digest digest;
    digest.add(std::uint64_t{set.contours.size()});
    for (const Contour& contour : set.contours) {
        digest.add(contour.plane);
        digest.add(contour.points);
        for (const bool mark : {contour.closed, contour.hole}) digest.add(std::uint64_t{mark});
        digest.add(static_cast<std::uint64_t>(contour.end));
        digest.add(contour.inside ? 1 + static_cast<std::uint64_t>(*contour.inside) : std::uint64_t{0});
        if (contour.weight != 1) digest.add(contour.weight);  // digests from before there were weights stay valid
        for (const std::optional<double>& moment : {contour.frame, contour.time_s})
            if (moment) digest.add(*moment);
        if (contour.time_s) digest.add(std::uint64_t{1});  // no frame
    }
    for (const std::optional<double>& cycle : {set.cycle_frames, set.cycle_s})
        if (cycle) digest.add(*cycle);
    digest.add(set.interior);
    digest.add(set.exterior);
    digest.add(std::uint64_t{set.surface.size()});
    for (const SurfacePoint& point : set.surface) {
        digest.add(point.position);
        digest.add(std::uint64_t{point.outward.has_value()});
        digest.add(point.outward.value_or(Vec3{}));
    }
    for (const Plane& plane : set.empty_planes) digest.add(plane);  // none: as before there were any
    return digest.hex();
}

std::string grid_sha256(const Grid& grid) {
    Digest digest;
    for (int axis = 0; axis < 3; ++axis) digest.add(static_cast<std::uint64_t>(grid.size[axis]));
    for (int axis = 0; axis < 3; ++axis) digest.add(grid.index_to_mm.column(axis));
    digest.add(grid.index_to_mm.translation);
    return digest.hex();
}

std::string to_json(const Provenance& provenance) {
    const auto quoted = [](const std::string& text) {
        std::string result = "\"";
        for (const char c : text) {
            if (c == '"' || c == '\\') result += '\\';
            result += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
        }
        return result + "\"";
    };
    std::string text = "{";
    for (const auto& [name, value] : provenance) {
        if (text.size() > 1) text += ", ";
        text += quoted(name) + ": " + quoted(value);
    }
    return text + "}";
}

std::string short_text(const Provenance& provenance, std::size_t most_bytes) {
    constexpr std::size_t kDigits = 12;
    std::string text;
    for (const auto& [name, value] : provenance) {
        if (!text.empty()) text += ' ';
        text += name;
        text += '=';
        text += name.ends_with("_sha256") ? value.substr(0, kDigits) : value;
    }
    return text.substr(0, most_bytes);
}

}  // namespace kontur
