// SPDX-License-Identifier: Apache-2.0
#include "kontur/io/dicom_frames.h"

#include <fmt/format.h>

#include <dcmtk/dcmdata/dcpixel.h>
#include <dcmtk/dcmdata/dcpixseq.h>
#include <dcmtk/dcmdata/dcpxitem.h>

#include <cmath>
#include <span>
#include <utility>

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
    for (unsigned long n = 0; n < sequence->card(); ++n) {
        DcmPixelItem* item = nullptr;
        Uint8* bytes = nullptr;
        if (sequence->getItem(item, n).bad() || !item || (item->getLength() > 0 && item->getUint8Array(bytes).bad()))
            throw corrupt("its compressed pixels are damaged");
        items.emplace_back(bytes, bytes ? item->getLength() : 0);
    }
    return items;
}

std::uint32_t little_endian(std::span<const Uint8> bytes) {
    return bytes[0] | std::uint32_t{bytes[1]} << 8 | std::uint32_t{bytes[2]} << 16 | std::uint32_t{bytes[3]} << 24;
}

/// Index of the first fragment at this distance from the start of the first one.
std::size_t fragment_at(const std::vector<std::span<const Uint8>>& items, std::uint64_t offset) {
    constexpr std::uint64_t kItemHeader = 8;
    std::uint64_t at = 0;
    for (std::size_t n = 1; n < items.size(); at += kItemHeader + items[n++].size())
        if (at == offset) return n;
    throw corrupt(fmt::format("no compressed frame starts at offset {}", offset));
}

/// [first, end) of the items that hold a frame: all of them, one each, or what the offset table says.
std::pair<std::size_t, std::size_t> fragments_of_frame(const std::vector<std::span<const Uint8>>& items, std::int64_t frame,
                                                       std::int64_t frames) {
    const auto index = static_cast<std::size_t>(frame), count = static_cast<std::size_t>(frames);
    if (count == 1) return {1, items.size()};
    if (items.size() == count + 1) return {index, index + 1};
    if (items.empty() || items[0].size() != 4 * count)
        throw corrupt(fmt::format("{} fragments without an offset table hold {} frames", items.size() - 1, count));
    const auto start = [&](std::size_t n) { return fragment_at(items, little_endian(items[0].subspan(4 * (n - 1), 4))); };
    return {start(index), index == count ? items.size() : start(index + 1)};
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

std::vector<Uint8> compressed_frame(DcmDataset& dataset, std::int64_t frame, std::int64_t frames) {
    const std::vector<std::span<const Uint8>> items = fragments(dataset);
    const auto [first, end] = fragments_of_frame(items, frame, frames);
    std::vector<Uint8> code;
    for (std::size_t n = first; n < end; ++n) code.insert(code.end(), items[n].begin(), items[n].end());
    return code;
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
