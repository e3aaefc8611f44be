// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <unordered_map>

#include "kontur/base/error.h"
#include "kontur/base/printable.h"
#include "kontur/io/meshes/mesh_formats.h"

static_assert(std::endian::native == std::endian::little, "binary STL is little endian");

namespace kontur {
namespace {

constexpr std::size_t kTitleSize = 80;
constexpr std::size_t kHeaderSize = kTitleSize + 4;

using Float3 = std::array<float, 3>;

/// One facet as it lies in the file, but for the two attribute bytes that follow.
struct Facet {
    Float3 normal;
    std::array<Float3, 3> corners;
};
constexpr std::size_t kFacetSize = sizeof(Facet) + 2;
static_assert(kFacetSize == 50);

Float3 to_floats(const Vec3& v) { return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)}; }

void append_triangle(const std::array<std::uint32_t, 3>& triangle, TriangleMesh& mesh) {
    const auto& [a, b, c] = triangle;
    if (a != b && b != c && c != a) mesh.triangles.push_back(triangle);
}

/// Points by their exact coordinates; 0 and -0 are the same.
class PointMerger {
public:
    PointMerger(TriangleMesh& mesh, PatientFrame frame) : mesh_(mesh), frame_(frame) {}

    std::uint32_t index(Float3 p) {
        for (float& c : p) c += 0.0f;
        const auto [it, is_new] = indices_.try_emplace(p, static_cast<std::uint32_t>(mesh_.points.size()));
        if (is_new) mesh_.points.push_back(to_lps(frame_, {p[0], p[1], p[2]}));
        return it->second;
    }

private:
    struct Hash {
        std::size_t operator()(const Float3& p) const {
            std::uint64_t h = 0;
            for (const float c : p) {
                h = (h ^ std::bit_cast<std::uint32_t>(c)) * 0x9e3779b97f4a7c15u;
                h ^= h >> 29;
            }
            return h;
        }
    };

    TriangleMesh& mesh_;
    PatientFrame frame_;
    std::unordered_map<Float3, std::uint32_t, Hash> indices_;
};

/// Titles of binary files begin with this word, too.
bool is_text(std::string_view bytes) {
    const std::string begin = lower_case(bytes.substr(0, 1024));
    return begin.starts_with("solid") && begin.find("facet") != std::string::npos;
}

/// Facets of a text file, line by line.
class TextParser {
public:
    TriangleMesh parse(std::string_view text) {
        const PatientFrame frame = declared_frame(text.substr(0, text.find('\n')), PatientFrame::lps);
        TriangleMesh mesh;
        PointMerger merger(mesh, frame);
        for (std::uint64_t line = 1; !text.empty(); ++line) try {
                parse_line(take_line(text), merger, mesh);
            } catch (const Error& error) {
                throw error.with_context(fmt::format("line {}", line));
            }
        if (is_open_ || is_facet_) throw Error(ErrorKind::corrupt_file, "the file ends amid its triangles");
        return mesh;
    }

private:
    void parse_line(std::string_view line, PointMerger& merger, TriangleMesh& mesh) {
        const std::string keyword = lower_case(take_word(line));
        if (keyword == "solid") is_open_ = true;
        else if (keyword == "facet") is_facet_ = true;
        else if (keyword == "vertex") append_corner(line, merger);
        else if (keyword == "endfacet") end_triangle(mesh);
        else if (keyword == "endsolid") is_open_ = is_facet_;
        else if (keyword != "outer" && keyword != "endloop" && !keyword.empty())
            throw Error(ErrorKind::corrupt_file, fmt::format("\"{}\" is no word of STL", keyword.substr(0, 40)));
    }

    void append_corner(std::string_view line, PointMerger& merger) {
        Float3 corner{};
        for (float& c : corner) {
            const double value = number_of(take_word(line));
            if (std::abs(value) > std::numeric_limits<float>::max())
                throw Error(ErrorKind::corrupt_file, fmt::format("the coordinate {:g} is beyond 32-bit floats", value));
            c = static_cast<float>(value);
        }
        corners_.push_back(merger.index(corner));
    }

    void end_triangle(TriangleMesh& mesh) {
        if (corners_.size() != 3)
            throw Error(ErrorKind::corrupt_file, fmt::format("a facet has {} corners; 3 are needed", corners_.size()));
        append_triangle({corners_[0], corners_[1], corners_[2]}, mesh);
        corners_.clear();
        is_facet_ = false;
    }

    std::vector<std::uint32_t> corners_;
    bool is_open_ = false, is_facet_ = false;
};

std::uint32_t checked_facet_count(std::string_view bytes) {
    if (bytes.size() < kHeaderSize)
        throw Error(ErrorKind::corrupt_file,
                    fmt::format("{} bytes are no STL file; its header alone has {}", bytes.size(), kHeaderSize));
    std::uint32_t count = 0;
    std::memcpy(&count, bytes.data() + kTitleSize, sizeof count);
    if (const std::uint64_t expected = kHeaderSize + std::uint64_t{count} * kFacetSize; expected != bytes.size())
        throw Error(ErrorKind::corrupt_file,
                    fmt::format("the header declares {} triangles, that is {} bytes, but the file has {}", count, expected,
                                bytes.size()));
    return count;
}

}  // namespace

void write_stl(AtomicFile& file, const TriangleMesh& mesh, const Provenance& provenance) {
    constexpr std::size_t kMostTriangles = std::numeric_limits<std::uint32_t>::max();
    if (mesh.triangles.size() > kMostTriangles)
        throw Error(ErrorKind::too_large,
                    fmt::format("{} triangles; an STL file holds at most {}", mesh.triangles.size(), kMostTriangles));
    std::array<char, kTitleSize> title{};
    fmt::format_to_n(title.data(), title.size(), "kontur {} SPACE=LPS UNIT=mm{}{}", KONTUR_VERSION,
                     provenance.empty() ? "" : " ", short_text(provenance, title.size()));
    file.write(title.data(), title.size());
    const auto count = static_cast<std::uint32_t>(mesh.triangles.size());
    file.write(&count, sizeof count);
    for (const auto& [a, b, c] : mesh.triangles) {
        const Vec3 &p = mesh.points[a], &q = mesh.points[b], &r = mesh.points[c];
        const Facet facet{to_floats(normalized(cross(q - p, r - p))), {to_floats(p), to_floats(q), to_floats(r)}};
        std::array<char, kFacetSize> record{};
        std::memcpy(record.data(), &facet, sizeof facet);
        file.write(record.data(), record.size());
    }
}

TriangleMesh parse_stl(std::string_view bytes) {
    if (is_text(bytes)) return TextParser().parse(bytes);
    const std::uint32_t count = checked_facet_count(bytes);
    TriangleMesh mesh;
    mesh.triangles.reserve(count);
    PointMerger merger(mesh, declared_frame(bytes.substr(0, kTitleSize), PatientFrame::lps));
    for (std::uint32_t i = 0; i < count; ++i) {
        Facet facet;
        std::memcpy(&facet, bytes.data() + kHeaderSize + std::size_t{i} * kFacetSize, sizeof facet);
        std::array<std::uint32_t, 3> triangle{};
        for (std::size_t corner = 0; corner < 3; ++corner) {
            for (const float c : facet.corners[corner])
                if (!std::isfinite(c))
                    throw Error(ErrorKind::corrupt_file, fmt::format("triangle {} has the coordinate {}", i + 1, c));
            triangle[corner] = merger.index(facet.corners[corner]);
        }
        append_triangle(triangle, mesh);
    }
    return mesh;
}

}  // namespace kontur
