// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <set>

#include "kontur/base/checks.h"
#include "kontur/base/error.h"
#include "kontur/io/dicom/cie_lab.h"
#include "kontur/io/dicom/decimal_string.h"
#include "kontur/io/dicom/dicom_code.h"
#include "kontur/io/dicom/dicom_document.h"
#include "kontur/io/dicom/dicom_names.h"
#include "kontur/io/dicom/dicom_seg.h"
#include "kontur/io/dicom/dicom_stack.h"
#include "kontur/io/dicom/dicom_uid.h"

namespace kontur {
namespace {

using dcmtk::append_item;
using dcmtk::put;
using dcmtk::put_code;
using dcmtk::put_file_reference;
using dcmtk::put_image_reference;

constexpr dcmtk::Code kTissue{"85756007", "SCT", "Tissue"};  // what other programs write for want of a better word
constexpr dcmtk::Code kSegmentation{"113076", "DCM", "Segmentation"};
constexpr dcmtk::Code kSource{"121322", "DCM", "Source image for image processing operation"};
constexpr dcmtk::Code kManual{"123109", "DCM", "Manual Processing"};  // the family: drawn contours, joined by a function

Error invalid(const std::string& message) { return Error(ErrorKind::invalid_input, message); }

std::string decimals(std::initializer_list<double> values) {
    std::string text;
    for (const double value : values) {
        if (!text.empty()) text += '\\';
        text += to_decimal_string(value);
    }
    return text;
}

/// Where the voxels of the images lie in a label map or a mask.
class Lookup {
public:
    Lookup(const Grid& labels, const Grid& images) : labels_(labels), images_(images) {
        const Affine3 to_index = labels.index_to_mm.inverse();
        to_label_ = compose(to_index, images.index_to_mm);
        check_lattices();
    }

    /// `value_at(offset)` by voxel of the images, i fastest; 0 outside of the labels. Throws Error(invalid_input) when
    /// voxels of the labels that are not 0 lie outside of the images, where no frame could hold them.
    template <class Value, class ValueAt>
    std::vector<Value> values(const ValueAt& value_at) const {
        std::vector<Value> values;
        values.reserve(static_cast<std::size_t>(images_.voxel_count()));
        for (std::int64_t k = 0; k < images_.size.k; ++k)
            for (std::int64_t j = 0; j < images_.size.j; ++j)
                for (std::int64_t i = 0; i < images_.size.i; ++i) {
                    const std::optional<std::size_t> offset = offset_at(i, j, k);
                    values.push_back(offset ? static_cast<Value>(value_at(*offset)) : Value{});
                }
        check_all_found(values, value_at);
        return values;
    }

private:
    template <class Value, class ValueAt>
    void check_all_found(const std::vector<Value>& values, const ValueAt& value_at) const {
        const auto found = std::count_if(values.begin(), values.end(), [](Value value) { return value != 0; });
        std::ptrdiff_t all = 0;
        for (std::size_t offset = 0; offset < static_cast<std::size_t>(labels_.voxel_count()); ++offset)
            all += value_at(offset) != 0;
        if (all > found) throw invalid(fmt::format("{} of its {} voxels lie outside of the images", all - found, all));
    }

    std::optional<std::size_t> offset_at(std::int64_t i, std::int64_t j, std::int64_t k) const {
        const Vec3 p = to_label_.apply({static_cast<double>(i), static_cast<double>(j), static_cast<double>(k)});
        const Index3 n{std::llround(p.x), std::llround(p.y), std::llround(p.z)}, &size = labels_.size;
        if (n.i < 0 || n.j < 0 || n.k < 0 || n.i >= size.i || n.j >= size.j || n.k >= size.k) return std::nullopt;
        return labels_.offset(n.i, n.j, n.k);
    }

    /// A voxel of one grid is a voxel of the other, everywhere, within a twentieth of a voxel.
    void check_lattices() const {
        constexpr double kTolerance = 0.05;
        const auto last = [](std::int64_t n) { return static_cast<double>(n - 1); };
        double off = 0, spread = 0;
        for (unsigned corner = 0; corner < 8; ++corner) {
            const Vec3 p = to_label_.apply({corner & 1 ? last(images_.size.i) : 0, corner & 2 ? last(images_.size.j) : 0,
                                            corner & 4 ? last(images_.size.k) : 0});
            for (const double x : {p.x, p.y, p.z}) off = std::max(off, std::abs(x - std::round(x)));
        }
        for (const auto& row : to_label_.linear)
            for (const double x : row) spread = std::max(spread, std::abs(x - std::round(x)));
        if (const double volumes = std::abs(to_label_.determinant()); std::abs(volumes - 1) > kTolerance) {
            const Vec3 own = labels_.spacing_mm(), theirs = images_.spacing_mm();
            throw invalid(fmt::format(
                "its voxels of {:.6g} x {:.6g} x {:.6g} mm are not those of the images, which have {:.6g} x {:.6g} x {:.6g} "
                "mm; kontur convert --image puts a label map on their grid",
                own.x, own.y, own.z, theirs.x, theirs.y, theirs.z));
        }
        if (off <= kTolerance && spread <= kTolerance) return;
        throw invalid(
            fmt::format("its voxels do not lie on those of the images: they are up to {:.3g} of a voxel off; the limit is "
                        "{:g}; kontur convert --image puts a label map on their grid",
                        std::max(off, spread), kTolerance));
    }

    const Grid& labels_;
    const Grid& images_;
    Affine3 to_label_;
};

/// The values that occur, each of which needs a segment, and the other way round.
void check_segments(const Image& labels, const std::vector<DicomSegment>& segments) {
    std::set<std::int64_t> wanted;
    for (const DicomSegment& segment : segments) {
        if (segment.number < 1 || segment.number > 65535)
            throw invalid(fmt::format("segment number {} cannot be written; 1 to 65535 can", segment.number));
        if (!wanted.insert(segment.number).second)
            throw invalid(fmt::format("two segments have the number {}", segment.number));
    }
    const auto counts = count_labels(labels, 65536);
    for (const auto& [label, count] : counts)
        if (!wanted.contains(label))
            throw invalid(fmt::format("{} voxels have the label {}, which no segment has", count, label));
    for (const DicomSegment& segment : segments)
        if (!counts.contains(segment.number))
            throw invalid(fmt::format("segment {} '{}' has no voxels", segment.number, segment.label));
}

void check_masks(const std::vector<Mask>& masks, const std::vector<DicomSegment>& segments) {
    if (masks.size() != segments.size())
        throw invalid(fmt::format("there are {} masks for {} segments", masks.size(), segments.size()));
    for (std::size_t s = 0; s < masks.size(); ++s)
        if (std::none_of(masks[s].values.begin(), masks[s].values.end(), [](std::uint8_t v) { return v != 0; }))
            throw invalid(fmt::format("the segment '{}' has no voxels", segments[s].label));
}

/// Each segment by itself onto the voxels of the images; a fault names it.
std::vector<bool> voxels_of_segment(const MaskedSegments& content, std::size_t s, const Grid& images) {
    const Mask& mask = content.masks[s];
    try {
        return Lookup(mask.grid, images).values<bool>([&](std::size_t offset) { return mask.values[offset] != 0; });
    } catch (const Error& error) {
        throw error.with_context(fmt::format("segment '{}'", content.segments[s].label));
    }
}

class SegWriter {
public:
    SegWriter(DcmItem& document, const std::vector<std::vector<DicomHeader>>& times)
        : document_(document), times_(times), slices_(times.front()) {}

    void put_header(std::size_t segments) {
        const DicomHeader& first = slices_.front();
        put(document_, DCM_ImageType, "DERIVED\\PRIMARY");
        put(document_, DCM_ContentDate, dcmtk::text(document_, DCM_InstanceCreationDate));
        put(document_, DCM_ContentTime, dcmtk::text(document_, DCM_InstanceCreationTime));
        put(document_, DCM_ContentLabel, "SEGMENTATION");
        put(document_, DCM_ContentDescription, "");
        put(document_, DCM_ContentCreatorName, "");
        put(document_, DCM_NumberOfFrames, static_cast<std::int64_t>(segments * times_.size() * slices_.size()));
        put(document_, DCM_SamplesPerPixel, 1);
        put(document_, DCM_PhotometricInterpretation, "MONOCHROME2");
        put(document_, DCM_Rows, first.rows);
        put(document_, DCM_Columns, first.columns);
        put(document_, DCM_BitsAllocated, 1);
        put(document_, DCM_BitsStored, 1);
        put(document_, DCM_HighBit, 0);
        put(document_, DCM_PixelRepresentation, 0);
        put(document_, DCM_LossyImageCompression, "00");
        put(document_, DCM_SegmentationType, "BINARY");
    }

    void put_overlap(bool overlap) { put(document_, DCM_SegmentsOverlap, overlap ? "YES" : "NO"); }

    void put_segment(const DicomSegment& segment, const std::string& name, std::size_t number,
                     const DicomAlgorithm& algorithm, std::vector<std::string>& notes) {
        DcmItem& item = append_item(document_, DCM_SegmentSequence);
        put(item, DCM_SegmentNumber, static_cast<std::int64_t>(number));
        put(item, DCM_SegmentLabel, name);
        const auto of_segment = [&](const char* what) { return fmt::format("the {} of segment '{}'", what, name); };
        if (!segment.description.empty())
            put(item, DCM_SegmentDescription,
                dcmtk::noted_text(segment.description, dcmtk::kMostTextCharacters, of_segment("description"), notes));
        put(item, DCM_SegmentAlgorithmType, segment.algorithm_type);
        if (segment.algorithm_type != "MANUAL")
            put(item, DCM_SegmentAlgorithmName,
                dcmtk::one_value(segment.algorithm_name.empty() ? "unknown" : segment.algorithm_name, 64));
        const auto put_property = [&](const DcmTagKey& tag, std::optional<CodedConcept> property, const char* what) {
            if (property) property = dcmtk::storable(*property, of_segment(what), notes);
            if (property) put_code(item, tag, *property);
            else put_code(item, tag, kTissue);
        };
        put_property(DCM_SegmentedPropertyCategoryCodeSequence, segment.category, "category");
        put_property(DCM_SegmentedPropertyTypeCodeSequence, segment.code, "code");
        if (segment.color) put_color(item, *segment.color);
        if (!algorithm.name.empty())
            put_algorithm(append_item(item, DCM_SegmentationAlgorithmIdentificationSequence), algorithm);
    }

    void put_image_references() {
        std::map<std::string, DcmItem*> items;  // phases are series of their own
        std::set<std::string> named;
        for (const std::vector<DicomHeader>& slices : times_)
            for (const DicomHeader& slice : slices) {
                DcmItem*& series = items[slice.series_uid];
                if (!series) {
                    series = &append_item(document_, DCM_ReferencedSeriesSequence);
                    put(*series, DCM_SeriesInstanceUID, slice.series_uid);
                }
                if (named.insert(slice.sop_instance_uid).second)
                    put_file_reference(append_item(*series, DCM_ReferencedInstanceSequence), slice);
            }
    }

    void put_dimensions() {
        const std::string uid = new_uid();
        put(append_item(document_, DCM_DimensionOrganizationSequence), DCM_DimensionOrganizationUID, uid);
        put_dimension(uid, DCM_ReferencedSegmentNumber, DCM_SegmentIdentificationSequence, "segment");
        if (has_times()) put_dimension(uid, DCM_TemporalPositionIndex, DCM_FrameContentSequence, "time");
        put_dimension(uid, DCM_ImagePositionPatient, DCM_PlanePositionSequence, "position");
    }

    void put_shared_groups(const Vec3& step) {
        const SlicePlacement& place = slices_.front().placement;
        const Vec3 &row = place.row_direction, &column = place.column_direction;
        const double spacing = std::abs(dot(place.normal(), step));
        DcmItem& shared = append_item(document_, DCM_SharedFunctionalGroupsSequence);
        put(append_item(shared, DCM_PlaneOrientationSequence), DCM_ImageOrientationPatient,
            decimals({row.x, row.y, row.z, column.x, column.y, column.z}));
        DcmItem& measures = append_item(shared, DCM_PixelMeasuresSequence);
        put(measures, DCM_PixelSpacing, decimals({place.spacing_mm[1], place.spacing_mm[0]}));
        put(measures, DCM_SliceThickness, to_decimal_string(spacing));
        put(measures, DCM_SpacingBetweenSlices, to_decimal_string(spacing));
    }

    void put_frame(std::size_t segment, std::size_t time, std::size_t k) {
        const DicomHeader& slice = times_[time][k];
        const Vec3& position = slices_[k].placement.position;
        DcmItem& frame = append_item(document_, DCM_PerFrameFunctionalGroupsSequence);
        DcmItem& content = append_item(frame, DCM_FrameContentSequence);
        std::vector<Uint32> numbers{static_cast<Uint32>(segment)};
        if (has_times()) {
            numbers.push_back(static_cast<Uint32>(time + 1));
            put_numbers(content, DCM_TemporalPositionIndex, {numbers.back()});
        }
        numbers.push_back(static_cast<Uint32>(k + 1));
        put_numbers(content, DCM_DimensionIndexValues, numbers);
        put(append_item(frame, DCM_PlanePositionSequence), DCM_ImagePositionPatient,
            decimals({position.x, position.y, position.z}));
        DcmItem& derivation = append_item(frame, DCM_DerivationImageSequence);
        put_code(derivation, DCM_DerivationCodeSequence, kSegmentation);
        DcmItem& source = append_item(derivation, DCM_SourceImageSequence);
        put_image_reference(source, slice);
        put_code(source, DCM_PurposeOfReferenceCodeSequence, kSource);
        put(append_item(frame, DCM_SegmentIdentificationSequence), DCM_ReferencedSegmentNumber,
            static_cast<std::int64_t>(segment));
    }

private:
    static void put_color(DcmItem& segment, const Rgb8& color) {
        const DicomLab lab = to_dicom_lab(color);
        segment.putAndInsertUint16Array(DCM_RecommendedDisplayCIELabValue, lab.data(), lab.size());
    }

    static void put_numbers(DcmItem& item, const DcmTagKey& tag, const std::vector<Uint32>& numbers) {
        auto element = std::make_unique<DcmUnsignedLong>(DcmTag(tag));
        element->putUint32Array(numbers.data(), numbers.size());
        if (item.insert(element.get(), /*replaceOld=*/OFTrue).good()) (void)element.release();  // now the item's
    }

    static void put_algorithm(DcmItem& item, const DicomAlgorithm& algorithm) {
        put_code(item, DCM_AlgorithmFamilyCodeSequence, kManual);
        put(item, DCM_AlgorithmName, dcmtk::one_value(algorithm.name, 64));
        put(item, DCM_AlgorithmVersion, dcmtk::one_value(algorithm.version, 64));
        if (!algorithm.parameters.empty()) put(item, DCM_AlgorithmParameters, dcmtk::one_value(algorithm.parameters, 10240));
        put(item, DCM_AlgorithmSource, "kontur");
    }

    void put_dimension(const std::string& uid, const DcmTagKey& index, const DcmTagKey& group, const char* name) {
        DcmItem& item = append_item(document_, DCM_DimensionIndexSequence);
        put(item, DCM_DimensionOrganizationUID, uid);
        item.putAndInsertTagKey(DCM_DimensionIndexPointer, index);
        item.putAndInsertTagKey(DCM_FunctionalGroupPointer, group);
        put(item, DCM_DimensionDescriptionLabel, name);
    }

    bool has_times() const { return times_.size() > 1; }

    DcmItem& document_;
    const std::vector<std::vector<DicomHeader>>& times_;
    const std::vector<DicomHeader>& slices_;  ///< of the first of them, where all lie
};

/// All frames as one row of bits without gaps between them, the lowest bit of a byte first (PS3.5 8.1.1).
class BitRow {
public:
    explicit BitRow(std::uint64_t bits) : bytes_((bits + 15) / 16 * 2) {}
    void append(bool bit) {
        if (bit) bytes_[count_ >> 3] = static_cast<Uint8>(bytes_[count_ >> 3] | 1u << (count_ & 7));
        ++count_;
    }
    const std::vector<Uint8>& bytes() const { return bytes_; }

private:
    std::vector<Uint8> bytes_;
    std::uint64_t count_ = 0;
};

std::uint64_t checked_bits(const Grid& grid, std::size_t segments, std::size_t times) {
    const std::uint64_t bits = static_cast<std::uint64_t>(grid.voxel_count()) * segments * times;
    const std::uint64_t limit = std::numeric_limits<std::uint32_t>::max();
    if (bits / 8 >= limit - 16)
        throw Error(ErrorKind::too_large, fmt::format("{} segments of {} voxels need {} bytes; a DICOM file holds up to {}",
                                                      segments * times, grid.voxel_count(), bits / 8, limit));
    return bits;
}

/// Slices that were resampled lie on no grid, and a segmentation is written on theirs.
void check_even(const std::vector<DicomHeader>& slices) {
    const std::vector<double> positions = positions_along_normal(slices);
    const double step = positions.back() / static_cast<double>(slices.size() - 1);
    for (std::size_t k = 0; k < slices.size(); ++k)
        if (std::abs(positions[k] - static_cast<double>(k) * step) > 0.3 * step)
            throw Error(ErrorKind::unsupported,
                        "the slices of the images do not lie evenly, and a DICOM segmentation has their grid; write an "
                        "RTSTRUCT, or a mask as .seg.nrrd or .nii.gz");
}

/// The images' voxels, from slices that were found to form a grid. Throws Error(unsupported) where they do not.
Grid grid_of(const std::vector<DicomHeader>& slices) {
    if (slices.size() > 1) check_even(slices);
    const SlicePlacement& first = slices.front().placement;
    Grid grid;
    grid.size = {slices.front().columns, slices.front().rows, static_cast<std::int64_t>(slices.size())};
    grid.index_to_mm.set_column(0, first.spacing_mm[0] * first.row_direction);
    grid.index_to_mm.set_column(1, first.spacing_mm[1] * first.column_direction);
    grid.index_to_mm.set_column(
        2, slices.size() > 1 ? (slices.back().placement.position - first.position) / static_cast<double>(slices.size() - 1)
                             : slices.front().thickness_mm.value_or(1) * first.normal());
    grid.index_to_mm.translation = first.position;
    return grid;
}

/// Segments on the voxels of the images.
struct SegmentVoxels {
    const std::vector<DicomSegment>& segments;
    const std::vector<std::vector<DicomHeader>>& times;  ///< slices of the images, at each time; one without times
    /// For each voxel whether it lies in segment s at time t.
    std::function<std::vector<bool>(std::size_t, std::size_t)> voxels_of;
};

std::vector<std::string> names_of(const std::vector<DicomSegment>& segments) {
    std::vector<std::string> names;
    for (const DicomSegment& segment : segments) names.push_back(segment.label.empty() ? "segment" : segment.label);
    return names;
}

std::vector<std::string> write_segments(const std::filesystem::path& path, const SegmentVoxels& content,
                                        const DicomSeries& images, const WriteDicomSegOptions& options, const Work& work) {
    const auto& [segments, times, voxels_of] = content;
    std::vector<std::string> notes;
    const std::vector<std::string> names = dcmtk::stored_names(names_of(segments), "segment", notes);
    const Grid grid = grid_of(times.front());
    BitRow bits(checked_bits(grid, segments.size(), times.size()));
    DcmFileFormat file;
    DcmItem& document = *file.getDataset();
    const std::string description =
        dcmtk::description_with_names(options.series_description, WriteDicomSegOptions{}.series_description, names);
    dcmtk::start_document(document, images, {UID_SegmentationStorage, "SEG", description, options.series_number});
    dcmtk::put_contribution(document, options.provenance);
    SegWriter writer(document, times);
    writer.put_header(segments.size());
    writer.put_image_references();
    writer.put_dimensions();
    writer.put_shared_groups(grid.index_to_mm.column(2));
    std::vector<std::vector<bool>> taken(times.size(), std::vector<bool>(static_cast<std::size_t>(grid.voxel_count())));
    bool overlap = false;
    for (std::size_t s = 0; s < segments.size(); ++s) {
        writer.put_segment(segments[s], names[s], s + 1, options.algorithm, notes);
        for (std::size_t t = 0; t < times.size(); ++t) {
            const std::vector<bool> inside = voxels_of(s, t);
            for (std::int64_t k = 0; k < grid.size.k; ++k) {
                work.report("write frames", static_cast<double>(k) / static_cast<double>(grid.size.k));
                writer.put_frame(s + 1, t, static_cast<std::size_t>(k));
                for (std::size_t n = grid.offset(0, 0, k); n < grid.offset(0, 0, k + 1); ++n) {
                    bits.append(inside[n]);
                    overlap = overlap || (inside[n] && taken[t][n]);
                    taken[t][n] = taken[t][n] || inside[n];
                }
            }
        }
    }
    writer.put_overlap(overlap);
    document.putAndInsertUint8Array(DCM_PixelData, bits.bytes().data(), static_cast<unsigned long>(bits.bytes().size()));
    dcmtk::save(file, path, EXS_LittleEndianExplicit);
    return notes;
}

void check_moving(const MovingSegments& content) {
    check_same_count("sequences of masks", content.masks.size(), "segments", content.segments.size());
    const auto is_inside = [](std::uint8_t v) { return v != 0; };
    for (std::size_t s = 0; s < content.segments.size(); ++s) {
        const std::span<const Mask> masks = content.masks[s];
        if (masks.empty() || masks.size() != content.volumes.size())
            throw invalid(fmt::format("there are {} masks for {} volumes in time; each needs one", masks.size(),
                                      content.volumes.size()));
        for (const Mask& mask : masks) check_mask(mask);
        if (std::ranges::none_of(masks, [&](const Mask& m) { return std::ranges::any_of(m.values, is_inside); }))
            throw invalid(fmt::format("the segment '{}' has no voxels", content.segments[s].label));
    }
}

}  // namespace

std::vector<std::string> write_dicom_seg(const std::filesystem::path& path, const LabelledSegments& content,
                                         const DicomSeries& images, const WriteDicomSegOptions& options, const Work& work) {
    const auto& [labels, segments] = content;
    dcmtk::set_up();
    const std::vector<std::vector<DicomHeader>> slices{read_slice_headers(images)};
    const Grid grid = grid_of(slices.front());
    check_image(labels, "the label map");
    check_segments(labels, segments);
    const auto values =
        Lookup(labels.grid, grid).values<std::uint16_t>([&](std::size_t offset) { return sample(labels, offset); });
    const auto voxels_of = [&values, &segments = content.segments](std::size_t s, std::size_t) {
        std::vector<bool> inside(values.size());
        std::transform(values.begin(), values.end(), inside.begin(),
                       [number = segments[s].number](std::uint16_t value) { return value == number; });
        return inside;
    };
    return write_segments(path, {segments, slices, voxels_of}, images, options, work);
}

std::vector<std::string> write_dicom_seg_masks(const std::filesystem::path& path, const MaskedSegments& content,
                                               const DicomSeries& images, const WriteDicomSegOptions& options,
                                               const Work& work) {
    const auto& [masks, segments] = content;
    dcmtk::set_up();
    const std::vector<std::vector<DicomHeader>> slices{read_slice_headers(images)};
    const Grid grid = grid_of(slices.front());
    check_masks(masks, segments);
    for (const Mask& mask : masks) check_mask(mask);
    const auto voxels_of = [&](std::size_t s, std::size_t) { return voxels_of_segment(content, s, grid); };
    return write_segments(path, {segments, slices, voxels_of}, images, options, work);
}

std::vector<std::string> write_dicom_seg_over_time(const std::filesystem::path& path, const MovingSegments& content,
                                                   const WriteDicomSegOptions& options, const Work& work) {
    const auto& [masks, segments, volumes] = content;
    dcmtk::set_up();
    check_moving(content);
    std::vector<std::vector<DicomHeader>> times;
    for (const DicomSeries& volume : volumes) {
        times.push_back(read_slice_headers(volume));
        if (times.back().size() != times.front().size())
            throw invalid(fmt::format("volume {} has {} slices, and volume 1 has {}", times.size(), times.back().size(),
                                      times.front().size()));
    }
    const auto voxels_of = [&](std::size_t s, std::size_t t) {
        const Mask& mask = content.masks[s][t];
        return Lookup(mask.grid, grid_of(times[t])).values<bool>([&](std::size_t n) { return mask.values[n] != 0; });
    };
    return write_segments(path, {segments, times, voxels_of}, volumes.front(), options, work);
}

}  // namespace kontur
