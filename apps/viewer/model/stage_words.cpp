// SPDX-License-Identifier: Apache-2.0
#include "viewer/model/stage_words.h"

#include <algorithm>
#include <array>
#include <utility>

namespace kontur::viewer {
namespace {

using Row = std::pair<std::string_view, std::string_view>;
constexpr std::array kWords{Row{"solve", "fitting the surface"},
                            Row{"voxelize", "filling the surface"},
                            Row{"polygonize", "making triangles"},
                            Row{"ask the image", "following the image"},
                            Row{"trace", "tracing contours"},
                            Row{"slice", "cutting slices"},
                            Row{"find slices", "finding slices"},
                            Row{"read frames", "reading frames"},
                            Row{"read headers", "looking at the files"},
                            Row{"read slices", "reading slices"},
                            Row{"read voxels", "reading"},
                            Row{"write frames", "writing frames"},
                            Row{"look at values", "looking at the values"}};

}  // namespace

std::string_view words_of_stage(std::string_view stage) noexcept {
    const auto* const found = std::ranges::find(kWords, stage, &Row::first);
    return found == kWords.end() ? stage : found->second;
}

}  // namespace kontur::viewer
