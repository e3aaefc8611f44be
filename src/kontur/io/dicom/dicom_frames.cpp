// SPDX-License-Identifier: Apache-2.0
#include "kontur/io/dicom/dicom_frames.h"

#include <fmt/format.h>

#include <dcmtk/dcmdata/dcpixel.h>
#include <dcmtk/dcmdata/dcpixseq.h>
#include <dcmtk/dcmdata/dcpxitem.h>

#include <algorithm>
#include <cmath>

#include "kontur/base/error.h"

namespace kontur::dcmtk {
namespace {

/// Directions are written with about six digits; a worse deviation means that they are not what they claim to be.
constexpr double kDirectionTolerance = 1e-3;

Error corrupt(const std::string& message) { return Error(ErrorKind::corrupt_file, message); }

std::vector<double> decimals_of_count(DcmItem& item, const DcmTagKey& tag, std::size_t count) {
    std::vector<double> values = decimals(item, tag);
    if (values.size() != count)
        throw corrupt(fmt::format("{} has {} values instead of {}", tag_name(tag), values.size(), count));
    return values;
}

DcmItem* first_item(DcmItem* item, const DcmTagKey& sequence) {
    if (!item) return nullptr;
    const std::vector<DcmItem*> found = items(*item, sequence);
    return found.empty() ? nullptr : found.front();
}

/// The items of encapsulated pixel data: the offset table, then the fragments (PS3.5 A.4).
std::vector<std::span<const Uint8>> fragments(DcmDataset& dataset) {
    DcmElement* element = nullptr;
    DcmPixelSequence* sequence = nullptr;
    dataset.findAndGetElement(DCM_PixelData, element);
    auto* pixels = dynamic_cast<DcmPixelData*>(element);
    if (!pixels || pixels->getEncapsulatedRepresentation(dataset.getCurrentXfer(), nullptr, sequence).bad() || !sequence)
        throw corrupt("the file ends before its pixels");
    std::vector<std::span<const Uint8>> items;
    for (DcmObject* child = nullptr; (child = sequence->nextInContainer(child)) != nullptr;) {
        auto* item = dynamic_cast<DcmPixelItem*>(child);
        Uint8* bytes = nullptr;
        if (!item || (item->getLength() > 0 && item->getUint8Array(bytes).bad()))
            throw corrupt("its compressed pixels are damaged");
        items.emplace_back(bytes, bytes ? item->getLength() : 0);
    }
    return items;
}

std::uint32_t little_endian(std::span<const Uint8> bytes) {
    return bytes[0] | std::uint32_t{bytes[1]} << 8 | std::uint32_t{bytes[2]} << 16 | std::uint32_t{bytes[3]} << 24;
}

/// Where each fragment starts, counted from the start of the first one; nothing is there for the offset table.
std::vector<std::uint64_t> starts_of(const std::vector<std::span<const Uint8>>& items) {
    constexpr std::uint64_t kItemHeader = 8;
    std::vector<std::uint64_t> starts;
    std::uint64_t at = 0;
    for (std::size_t n = 1; n < items.size(); at += kItemHeader + items[n++].size()) starts.push_back(at);
    return starts;
}

}  // namespace

DcmItem* Frame::group(const DcmTagKey& sequence) const {
    DcmItem* own = first_item(own_, sequence);
    return own ? own : first_item(shared_, sequence);
}

DcmItem& Frame::required_group(const DcmTagKey& sequence) const {
    DcmItem* found = group(sequence);
    if (!found) throw corrupt(tag_name(sequence) + " is missing");
    return *found;
}

SlicePlacement Frame::placement() const {
    return read_placement(required_group(DCM_PlanePositionSequence), required_group(DCM_PlaneOrientationSequence),
                          required_group(DCM_PixelMeasuresSequence));
}

std::vector<Frame> frames_of(DcmItem& dataset) {
    const std::int64_t declared = integer(dataset, DCM_NumberOfFrames).value_or(1);
    const std::vector<DcmItem*> own = items(dataset, DCM_PerFrameFunctionalGroupsSequence);
    if (declared < 1 || declared != static_cast<std::int64_t>(own.size()))
        throw corrupt(fmt::format("it declares {} frames and describes {}", declared, own.size()));
    DcmItem* shared = first_item(&dataset, DCM_SharedFunctionalGroupsSequence);
    std::vector<Frame> frames;
    frames.reserve(own.size());
    for (DcmItem* item : own) frames.emplace_back(item, shared);
    return frames;
}

CompressedFrames::CompressedFrames(DcmDataset& dataset, std::int64_t frames)
    : items_(fragments(dataset)), starts_(starts_of(items_)), count_(static_cast<std::size_t>(frames)) {
    const bool one_fragment_each = count_ == 1 || items_.size() == count_ + 1;
    if (!one_fragment_each && (items_.empty() || items_[0].size() != 4 * count_))
        throw corrupt(fmt::format("{} fragments without an offset table hold {} frames",
                                  items_.empty() ? 0 : items_.size() - 1, count_));
}

std::vector<Uint8> CompressedFrames::code(std::int64_t frame) const {
    const auto [first, end] = fragments_of(static_cast<std::size_t>(frame));
    std::vector<Uint8> code;
    for (std::size_t n = first; n < end; ++n) code.insert(code.end(), items_[n].begin(), items_[n].end());
    return code;
}

std::pair<std::size_t, std::size_t> CompressedFrames::fragments_of(std::size_t frame) const {
    if (count_ == 1) return {1, items_.size()};
    if (items_.size() == count_ + 1) return {frame, frame + 1};
    return {first_fragment(frame), frame == count_ ? items_.size() : first_fragment(frame + 1)};
}

std::size_t CompressedFrames::first_fragment(std::size_t frame) const {
    const std::uint64_t offset = little_endian(items_[0].subspan(4 * (frame - 1), 4));
    const auto found = std::lower_bound(starts_.begin(), starts_.end(), offset);
    if (found == starts_.end() || *found != offset)
        throw corrupt(fmt::format("no compressed frame starts at offset {}", offset));
    return static_cast<std::size_t>(found - starts_.begin()) + 1;
}

SlicePlacement read_placement(DcmItem& position_item, DcmItem& orientation_item, DcmItem& measures) {
    const auto position = decimals_of_count(position_item, DCM_ImagePositionPatient, 3);
    const auto orientation = decimals_of_count(orientation_item, DCM_ImageOrientationPatient, 6);
    const auto spacing = decimals_of_count(measures, DCM_PixelSpacing, 2);
    const Vec3 row{orientation[0], orientation[1], orientation[2]}, column{orientation[3], orientation[4], orientation[5]};
    const auto is_unit = [](const Vec3& v) { return std::abs(norm(v) - 1) <= kDirectionTolerance; };
    if (!is_unit(row) || !is_unit(column) || std::abs(dot(row, column)) > kDirectionTolerance)
        throw corrupt("ImageOrientationPatient (0020,0037) is not a pair of perpendicular unit vectors");
    if (!(spacing[0] > 0) || !(spacing[1] > 0)) throw corrupt("PixelSpacing (0028,0030) is not positive");
    SlicePlacement placement;
    placement.position = {position[0], position[1], position[2]};
    placement.row_direction = normalized(row);
    placement.column_direction = normalized(column);
    // PixelSpacing gives the distance between rows (along j) first.
    placement.spacing_mm = {spacing[1], spacing[0]};
    return placement;
}

std::optional<double> first_decimal(DcmItem& item, const DcmTagKey& tag) {
    DcmElement* element = nullptr;
    if (Float64 value = 0;
        item.findAndGetElement(tag, element).good() && element->ident() == EVR_FD && element->getFloat64(value).good())
        return value;
    const std::vector<double> values = decimals(item, tag);
    return values.empty() ? std::nullopt : std::optional(values.front());
}

}  // namespace kontur::dcmtk
