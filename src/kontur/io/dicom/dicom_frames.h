// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to io/: the frames of a multi-frame object (enhanced image or segmentation). Uses DCMTK's types.

#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "kontur/io/dicom/dcmtk.h"
#include "kontur/io/dicom/dicom_header.h"

namespace kontur::dcmtk {

/// The functional groups of one frame: what it says itself goes before what is shared by all frames.
class Frame {
public:
    Frame(DcmItem* own, DcmItem* shared) : own_(own), shared_(shared) {}

    /// The first item of the group's sequence, such as PlanePositionSequence; null when the frame has none.
    DcmItem* group(const DcmTagKey& sequence) const;
    /// The same, which must be there: throws Error(corrupt_file) naming it.
    DcmItem& required_group(const DcmTagKey& sequence) const;

    SlicePlacement placement() const;

private:
    DcmItem* own_;
    DcmItem* shared_;
};

/// As many as NumberOfFrames says. Throws Error(corrupt_file) when the groups of some frame are missing.
std::vector<Frame> frames_of(DcmItem& dataset);

/// Compressed pixel data, taken apart once: its fragments, and which of them hold a frame (PS3.5 A.4).
class CompressedFrames {
public:
    /// Of `dataset`, to which the bytes belong. Throws Error(corrupt_file) when the fragments cannot be told to belong to
    /// frames.
    CompressedFrames(DcmDataset& dataset, std::int64_t frames);

    /// The code of one frame (from 1), its fragments joined.
    std::vector<Uint8> code(std::int64_t frame) const;

private:
    /// [first, end) of the items: all of them, one each, or what the offset table says.
    std::pair<std::size_t, std::size_t> fragments_of(std::size_t frame) const;
    std::size_t first_fragment(std::size_t frame) const;

    std::vector<std::span<const Uint8>> items_;  ///< the offset table, then the fragments
    std::vector<std::uint64_t> starts_;          ///< of the fragments, counted from the first one's
    std::size_t count_;                          ///< of frames
};

/// A placement out of the items that hold position, orientation and pixel spacing; one item in a single-frame image.
/// Throws Error(corrupt_file), naming the element, for a missing or contradictory one.
SlicePlacement read_placement(DcmItem& position, DcmItem& orientation, DcmItem& measures);

/// First value of a decimal-string or floating-point element.
std::optional<double> first_decimal(DcmItem& item, const DcmTagKey& tag);

}  // namespace kontur::dcmtk
