// SPDX-License-Identifier: Apache-2.0
#include "fuzz/targets.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>

#include "kontur/base/error.h"

namespace kontur::fuzz {
namespace {

constexpr std::array kTargets{
    Target{"nifti", nifti},
    Target{"nrrd", nrrd},
    Target{"metaimage", metaimage},
    Target{"nifti_pair", nifti_pair},
    Target{"mgh", mgh},
    Target{"gipl", gipl},
    Target{"dicom", dicom},
    Target{"dicom_seg", dicom_seg},
    Target{"rtstruct", rtstruct},
    Target{"contour_json", contour_json},
    Target{"markups", markups},
    Target{"stl", stl},
    Target{"ply", ply},
    Target{"obj", obj},
    Target{"vtk", vtk},
    Target{"vtp", vtp},
    Target{"csv", csv},
    Target{"pipeline", pipeline},
    Target{"fitting", fitting},
    Target{"messages", messages},
    Target{"project", project},
};

/// Long or unprintable sentences would let a file write what it likes to a terminal.
void check_sentence(std::string_view sentence) {
    constexpr std::size_t kMost = 2000;
    const bool printable = std::all_of(sentence.begin(), sentence.end(),
                                       [](char c) { return static_cast<unsigned char>(c) >= 0x20 && c != 0x7F; });
    if (!sentence.empty() && sentence.size() <= kMost && printable) return;
    std::fprintf(stderr, "an error says %zu bytes or unprintable ones\n", sentence.size());
    std::abort();
}

}  // namespace

std::span<const Target> targets() { return kTargets; }

const Target* find_target(std::string_view name) {
    const auto found = std::find_if(kTargets.begin(), kTargets.end(), [&](const Target& t) { return t.name == name; });
    return found == kTargets.end() ? nullptr : &*found;
}

void run(const Target& target, Bytes bytes) {
    try {
        target.run(bytes);
    } catch (const Error& error) {
        check_sentence(error.what());
    }
}

}  // namespace kontur::fuzz
