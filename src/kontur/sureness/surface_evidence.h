// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "kontur/base/work.h"
#include "kontur/sampling/drawn_lines.h"
#include "kontur/sampling/surface_samples.h"
#include "kontur/shape/crossings.h"
#include "kontur/sureness/image_shares.h"

namespace kontur {

/// What is known of a fitted surface from the contours that it was made from: where band, expected Dice and the next plane
/// come from. None of it asks for the truth.
struct SurfaceEvidence {
    SurfaceSamples samples;
    std::vector<double> distances_mm;  ///< of each sample from the nearest drawn line
    std::vector<double> shares{};      ///< of each sample's error that the image leaves; 1 without one
    ImageShares image{};               ///< the same at any place
    DrawnLines lines;
    double size_mm = 0;          ///< the unit of length: diameter of the ball around the samples, twelve thicknesses at most
    double volume_mm3 = 0;       ///< that the surface encloses
    double voxel_mm = 0;         ///< smallest spacing of the image that was drawn on; 0: not known
    double residual_mm = 0;      ///< rms distance of the surface from the drawn points
    double disagreement_mm = 0;  ///< rms of contours where they cross; 0 where fewer than four cross
    double hand_mm = 0;          ///< of a drawn line, where fewer than four cross: what parallel ones tell (hand_error.h)

    std::size_t plane_count() const { return lines.planes().size(); }
    /// How many planes the lines are worth. One counts as a whole where its lines are as long as kWholeSection times the
    /// square root of the surface's area, else as the share of that. So a small contour in a further plane changes little.
    double whole_planes() const;
};

/// What a caller knows besides samples and contours.
struct EvidenceFacts {
    double volume_mm3 = 0;
    double voxel_mm = 0;
    double residual_mm = 0;
    double disagreement_mm = 0;
    std::vector<ImageShare> shares{};  ///< of the image, where it was used
};

SurfaceEvidence gather_evidence(SurfaceSamples samples, const ContourSet& contours, const EvidenceFacts& facts,
                                const Work& work = {});

/// The rms of contours where they cross; 0 where fewer than four do, of which a mean says little.
double trusted_disagreement_mm(const Disagreement& crossings);

/// With fewer planes the surface is a guess between them, and nothing can be said about its error.
inline constexpr std::size_t kLeastPlanes = 3;

}  // namespace kontur
