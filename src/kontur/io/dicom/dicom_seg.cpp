// SPDX-License-Identifier: Apache-2.0
#include "kontur/io/dicom/dicom_seg.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <span>

#include "kontur/base/checks.h"
#include "kontur/base/counted.h"
#include "kontur/base/error.h"
#include "kontur/io/dicom/cie_lab.h"
#include "kontur/io/dicom/dicom_code.h"
#include "kontur/io/dicom/dicom_frames.h"
#include "kontur/io/dicom/dicom_seg_pixels.h"
#include "kontur/io/dicom/dicom_stack.h"
#include "kontur/io/dicom/dicom_start.h"

namespace kontur {
namespace {

constexpr double kOffLatticeMm = 0.1;

Error corrupt(const std::string& message) { return Error(ErrorKind::corrupt_file, message); }
[[noreturn]] void refuse(const std::string& message) { throw Error(ErrorKind::unsupported, message); }

struct SegFrame {
    SlicePlacement placement;
    std::int64_t segment = 0;  ///< 0: the frame is a label map, whose pixels name their segments
    std::int64_t k = 0;
    std::optional<std::int64_t> time;  ///< from 1, where it is one of several
};

void check_limit(std::int64_t max_voxels) { check_at_least("the limit of voxels", max_voxels, 1); }

/// A segmentation in memory, its frames placed on a grid.
class SegFile {
public:
    SegFile(const std::filesystem::path& path, std::int64_t max_voxels) {
        dcmtk::load(file_, path);
        check_kind();
        read_segments();
        read_frames();
        place_frames(max_voxels);
        const Grid& grid = description_.grid;
        pixels_ = SegPixels(file_, path, {bits_, grid.size.i, grid.size.j, static_cast<std::int64_t>(frames_.size())});
        if (kind_ == Kind::label_map) check_labels();
    }

    const DicomSegmentation& description() const { return description_; }
    const std::vector<SegFrame>& frames() const { return frames_; }
    std::size_t index_of(std::int64_t number) const { return index_of_.at(number); }
    const DicomSegment& segment(std::int64_t number) const { return description_.segments[index_of(number)]; }

    /// Calls `visit(n, segment)` for every pixel n of the frame that is inside of a segment.
    template <class Visit>
    void for_each_inside(std::size_t frame, const Visit& visit) const {
        const std::size_t pixels = pixels_per_frame();
        const std::int64_t segment = frames_[frame].segment;
        for (std::size_t n = 0; n < pixels; ++n) {
            const std::uint16_t value = pixels_.value(frame, n);
            if (kind_ != Kind::label_map) {
                if (value >= threshold_) visit(n, segment);
            } else if (is_segment_[value]) {
                visit(n, value);
            }
        }
    }

    /// How many each segment has, and how many of them others have, too.
    void count_voxels() {
        std::map<std::int64_t, std::vector<std::size_t>> frames_at;  // by slice
        for (std::size_t f = 0; f < frames_.size(); ++f) frames_at[frames_[f].k].push_back(f);
        for (const auto& [k, frames] : frames_at) count_slice(frames);
        if (const std::string overlap = shared_voxels_of(description_.segments); !overlap.empty())
            description_.notes.push_back("segments overlap: " + overlap);
    }

private:
    void count_slice(const std::vector<std::size_t>& frames) {
        constexpr std::int64_t kShared = -1;
        std::vector<std::int64_t> owner(static_cast<std::size_t>(description_.grid.size.i * description_.grid.size.j));
        const auto visit_all = [&](const auto& visit) {
            for (const std::size_t f : frames)
                for_each_inside(f, [&](std::size_t n, std::int64_t number) { visit(number, owner[n]); });
        };
        visit_all([](std::int64_t number, std::int64_t& its_owner) {
            its_owner = its_owner == 0 || its_owner == number ? number : kShared;
        });
        visit_all([&](std::int64_t number, std::int64_t its_owner) {
            DicomSegment& segment = description_.segments[index_of(number)];
            ++segment.voxels;
            segment.shared_voxels += its_owner == kShared;
        });
    }

    static std::string shared_voxels_of(const std::vector<DicomSegment>& segments) {
        std::string text;
        for (const DicomSegment& segment : segments)
            if (segment.shared_voxels > 0)
                text += fmt::format("{}{} of {} of {} '{}'", text.empty() ? "" : ", ", segment.shared_voxels,
                                    counted(segment.voxels, "voxel"), segment.number, segment.label);
        return text;
    }

    DcmItem& dataset() { return *file_.getDataset(); }

    void check_kind() {
        if (const std::string modality = dcmtk::text(dataset(), DCM_Modality); modality != "SEG")
            throw Error(ErrorKind::invalid_input, fmt::format("is no segmentation but DICOM of modality '{}'", modality));
        const std::string kind = dcmtk::text(dataset(), DCM_SegmentationType);
        const std::int64_t bits = dcmtk::integer(dataset(), DCM_BitsAllocated).value_or(0);
        bits_ = static_cast<int>(bits == 1 || bits == 8 || bits == 16 ? bits : 0);
        if (kind == "BINARY" && bits_ == 1) return;
        if (kind == "LABELMAP" && (bits_ == 8 || bits_ == 16)) {
            kind_ = Kind::label_map;
            background_ = dcmtk::integer(dataset(), DCM_PixelPaddingValue).value_or(0);
            return;
        }
        if (kind != "FRACTIONAL" || bits_ != 8)
            refuse(
                fmt::format("a segmentation of type '{}' with {} bits per pixel is not supported; BINARY with 1, "
                            "FRACTIONAL with 8 and LABELMAP with 8 or 16 are",
                            kind, bits));
        const std::int64_t most = dcmtk::integer(dataset(), DCM_MaximumFractionalValue).value_or(255);
        if (most < 1 || most > 255)
            throw corrupt(fmt::format("its MaximumFractionalValue is {}; 1 to 255 are possible", most));
        threshold_ = static_cast<int>((most + 1) / 2);
        description_.notes.push_back("a fractional segmentation; voxels from one half on count as inside");
    }

    void read_segments() {
        for (DcmItem* item : dcmtk::items(dataset(), DCM_SegmentSequence)) {
            DicomSegment segment;
            segment.number = dcmtk::integer(*item, DCM_SegmentNumber).value_or(0);
            segment.label = dcmtk::text(*item, DCM_SegmentLabel);
            segment.algorithm_type = dcmtk::text(*item, DCM_SegmentAlgorithmType);
            segment.algorithm_name = dcmtk::text(*item, DCM_SegmentAlgorithmName);
            segment.color = read_color(*item);
            segment.description = dcmtk::lines(*item, DCM_SegmentDescription);
            segment.category = dcmtk::read_code(*item, DCM_SegmentedPropertyCategoryCodeSequence);
            segment.code = dcmtk::read_code(*item, DCM_SegmentedPropertyTypeCodeSequence);
            if (kind_ == Kind::label_map && segment.number == background_) continue;
            if (kind_ == Kind::label_map && segment.number == 0)
                refuse("its segment 0 cannot be told from what lies in no segment");
            if (segment.number < 1 || segment.number > 65535)
                throw corrupt(fmt::format("a segment has the number {}", segment.number));
            if (!index_of_.emplace(segment.number, description_.segments.size()).second)
                throw corrupt(fmt::format("two segments have the number {}", segment.number));
            description_.segments.push_back(std::move(segment));
        }
        description_.frame_of_reference_uid = dcmtk::text(dataset(), DCM_FrameOfReferenceUID);
        for (DcmItem* item : dcmtk::items(dataset(), DCM_ReferencedSeriesSequence))
            description_.referenced_series_uid = dcmtk::text(*item, DCM_SeriesInstanceUID);
    }

    static std::optional<Rgb8> read_color(DcmItem& segment) {
        DicomLab lab{};
        for (unsigned long n = 0; n < 3; ++n)
            if (segment.findAndGetUint16(DCM_RecommendedDisplayCIELabValue, lab[n], n).bad()) return std::nullopt;
        return to_rgb(lab);
    }

    void read_frames() {
        const std::vector<dcmtk::Frame> frames = dcmtk::frames_of(dataset());
        for (std::size_t n = 0; n < frames.size(); ++n) try {
                SegFrame frame;
                frame.placement = frames[n].placement();
                if (DcmItem* content = frames[n].group(DCM_FrameContentSequence))
                    frame.time = dcmtk::integer(*content, DCM_TemporalPositionIndex);
                if (kind_ == Kind::label_map) {
                    frames_.push_back(frame);
                    continue;
                }
                DcmItem& about = frames[n].required_group(DCM_SegmentIdentificationSequence);
                frame.segment = dcmtk::integer(about, DCM_ReferencedSegmentNumber).value_or(0);
                if (!index_of_.contains(frame.segment))
                    throw corrupt(fmt::format("it belongs to segment {}, which is not listed", frame.segment));
                frames_.push_back(frame);
            } catch (const Error& error) {
                throw error.with_context(fmt::format("frame {}", n + 1));
            }
        check_times();
        DcmItem& measures = frames.front().required_group(DCM_PixelMeasuresSequence);
        spacing_ = dcmtk::first_decimal(measures, DCM_SpacingBetweenSlices);
        thickness_ = dcmtk::first_decimal(measures, DCM_SliceThickness);
    }

    /// Frames of different times would lie on top of each other.
    void check_times() const {
        std::set<std::optional<std::int64_t>> times;
        for (const SegFrame& frame : frames_) times.insert(frame.time);
        if (times.size() > 1)
            refuse(fmt::format("the segmentation has {} moments, and one is read; masks of all frames are read from .nii.gz",
                               times.size()));
    }

    double height(const SegFrame& frame) const {
        const SlicePlacement& first = frames_.front().placement;
        return dot(first.normal(), frame.placement.position - first.position);
    }

    /// Different positions along the normal, in ascending order.
    std::vector<double> heights() const {
        std::vector<double> heights;
        for (const SegFrame& frame : frames_) heights.push_back(height(frame));
        std::sort(heights.begin(), heights.end());
        const auto same = [](double a, double b) { return b - a <= kSamePositionMm; };
        heights.erase(std::unique(heights.begin(), heights.end(), same), heights.end());
        return heights;
    }

    /// The distance of slices: the declared one if all frames lie on multiples of it, else the least between two frames.
    double slice_step(const std::vector<double>& heights) {
        const auto fits = [&](double step) {
            return std::all_of(heights.begin(), heights.end(), [&](double h) {
                const double off = h - heights.front() - step * std::round((h - heights.front()) / step);
                return std::abs(off) <= std::min(std::max(0.01 * step, 0.01), 0.1 * step);
            });
        };
        const bool is_declared = spacing_ && *spacing_ > 0 && fits(*spacing_);
        if (heights.size() == 1) {
            if (is_declared) return *spacing_;
            if (!thickness_ || !(*thickness_ > 0))
                refuse("all frames lie at one position, and their thickness is not given");
            return *thickness_;
        }
        double least = heights[1] - heights[0];
        for (std::size_t n = 2; n < heights.size(); ++n) least = std::min(least, heights[n] - heights[n - 1]);
        if (is_declared) {
            if (heights.size() > 2 && least > 1.5 * *spacing_)
                description_.notes.push_back(
                    fmt::format("slices are declared {:.6g} mm apart, but no two frames lie less than {:.6g} mm apart; the "
                                "slices between them stay empty",
                                *spacing_, least));
            return *spacing_;
        }
        if (!fits(least))
            refuse(fmt::format(
                "its frames lie on no regular lattice of slices {:.6g} mm apart; 3D Slicer exports it again on the "
                "grid of its images",
                least));
        return least;
    }

    void place_frames(std::int64_t max_voxels) {
        const std::vector<double> heights = this->heights();
        const double step = slice_step(heights);
        const auto by_height = [&](const SegFrame& a, const SegFrame& b) { return height(a) < height(b); };
        const auto [low, high] = std::minmax_element(frames_.begin(), frames_.end(), by_height);
        const SlicePlacement &first = low->placement, &last = high->placement;
        const double slices = std::round((heights.back() - heights.front()) / step) + 1;
        if (!(slices <= static_cast<double>(max_voxels)))
            throw Error(
                ErrorKind::too_large,
                fmt::format("its frames span {:.6g} slices of {:.6g} mm; the limit is {} voxels", slices, step, max_voxels));
        const std::int64_t steps = static_cast<std::int64_t>(slices) - 1;
        Grid& grid = description_.grid;
        grid.size = {dcmtk::integer(dataset(), DCM_Columns).value_or(0), dcmtk::integer(dataset(), DCM_Rows).value_or(0),
                     steps + 1};
        check_size(max_voxels);
        Affine3& affine = grid.index_to_mm;
        affine.set_column(0, first.spacing_mm[0] * first.row_direction);
        affine.set_column(1, first.spacing_mm[1] * first.column_direction);
        affine.set_column(2,
                          steps > 0 ? (last.position - first.position) / static_cast<double>(steps) : step * first.normal());
        affine.translation = first.position;
        check_grid(grid);
        const double lowest = height(*low);
        for (std::size_t n = 0; n < frames_.size(); ++n) {
            frames_[n].k = std::llround((height(frames_[n]) - lowest) / step);
            check_placement(n, first);
        }
    }

    void check_size(std::int64_t max_voxels) const {
        const Index3& n = description_.grid.size;
        if (n.i < 1 || n.j < 1) throw corrupt(fmt::format("it has {} rows and {} columns", n.j, n.i));
        if (n.k > max_voxels / (n.i * n.j))
            throw Error(ErrorKind::too_large, fmt::format("the segmentation has {} x {} x {} voxels; the limit is {} voxels",
                                                          n.i, n.j, n.k, max_voxels));
    }

    void check_placement(std::size_t n, const SlicePlacement& first) const {
        const SlicePlacement& own = frames_[n].placement;
        const double off = distance(own.position, description_.grid.center_mm(0, 0, frames_[n].k));
        const bool parallel = distance(own.row_direction, first.row_direction) < 1e-4 &&
                              distance(own.column_direction, first.column_direction) < 1e-4;
        if (!parallel) refuse(fmt::format("frame {} is not parallel to the others", n + 1));
        if (off > kOffLatticeMm)
            refuse(fmt::format("frame {} lies {:.3g} mm off the lattice of the others; the limit is {:g} mm", n + 1, off,
                               kOffLatticeMm));
    }

    std::size_t pixels_per_frame() const {
        return static_cast<std::size_t>(description_.grid.size.i * description_.grid.size.j);
    }

    /// Each value must be a segment or the background.
    void check_labels() {
        is_segment_.resize(std::size_t{1} << bits_);
        for (const auto& [number, index] : index_of_)
            if (static_cast<std::size_t>(number) < is_segment_.size()) is_segment_[static_cast<std::size_t>(number)] = true;
        for (std::size_t f = 0; f < frames_.size(); ++f)
            for (std::size_t n = 0; n < pixels_per_frame(); ++n)
                if (const std::uint16_t value = pixels_.value(f, n);
                    value != 0 && value != background_ && !is_segment_[value])
                    throw corrupt(
                        fmt::format("frame {}: a pixel has the value {}, which is no segment's number", f + 1, value));
    }

    DcmFileFormat file_;
    DicomSegmentation description_;
    std::map<std::int64_t, std::size_t> index_of_;  ///< of a segment's number
    std::vector<bool> is_segment_;                  ///< by the values of a label map
    std::vector<SegFrame> frames_;
    std::optional<double> spacing_, thickness_;
    enum class Kind { one_segment_each, label_map } kind_ = Kind::one_segment_each;  ///< of the frames
    int bits_ = 1;
    int threshold_ = 1;
    std::int64_t background_ = 0;  ///< in label maps, what lies in no segment
    SegPixels pixels_;
};

std::string listed(const std::vector<DicomSegment>& segments) {
    std::string text;
    for (const DicomSegment& segment : segments)
        text += fmt::format("{}{} '{}'", text.empty() ? "" : ", ", segment.number, segment.label);
    return text.empty() ? "none" : text;
}

void check_segment(const DicomSegmentation& found, std::int64_t number) {
    const auto& all = found.segments;
    if (std::none_of(all.begin(), all.end(), [&](const DicomSegment& s) { return s.number == number; }))
        throw Error(ErrorKind::invalid_input, fmt::format("there is no segment {}; there are: {}", number, listed(all)));
}

template <class T>
std::vector<T> label_map(const SegFile& file, std::optional<std::int64_t> only, const Work& work) {
    const Grid& grid = file.description().grid;
    std::vector<T> labels(static_cast<std::size_t>(grid.voxel_count()));
    for (std::size_t f = 0; f < file.frames().size(); ++f) {
        work.report("read frames", static_cast<double>(f) / static_cast<double>(file.frames().size()));
        const SegFrame& frame = file.frames()[f];
        T* const slice = labels.data() + grid.offset(0, 0, frame.k);
        file.for_each_inside(f, [&](std::size_t n, std::int64_t segment) {
            if (only && segment != *only) return;
            if (slice[n] != 0 && slice[n] != segment)
                throw Error(ErrorKind::invalid_input,
                            fmt::format("the segments {} '{}' and {} '{}' overlap; choose one with the option label",
                                        +slice[n], file.segment(slice[n]).label, segment, file.segment(segment).label));
            slice[n] = static_cast<T>(segment);
        });
    }
    return labels;
}

std::vector<Mask> masks_of(const SegFile& file, std::int64_t max_voxels, const Work& work) {
    const Grid& grid = file.description().grid;
    const auto count = static_cast<std::int64_t>(file.description().segments.size());
    if (count > 0 && grid.voxel_count() > max_voxels / count)
        throw Error(ErrorKind::too_large, fmt::format("{} masks of {} voxels are more than the limit of {} voxels", count,
                                                      grid.voxel_count(), max_voxels));
    std::vector<Mask> masks(static_cast<std::size_t>(count),
                            {grid, std::vector<std::uint8_t>(static_cast<std::size_t>(grid.voxel_count()))});
    for (std::size_t f = 0; f < file.frames().size(); ++f) {
        work.report("read frames", static_cast<double>(f) / static_cast<double>(file.frames().size()));
        const auto offset = static_cast<std::size_t>(grid.offset(0, 0, file.frames()[f].k));
        file.for_each_inside(
            f, [&](std::size_t n, std::int64_t segment) { masks[file.index_of(segment)].values[offset + n] = 1; });
    }
    return masks;
}

template <class Body>
auto named_after(const std::filesystem::path& path, const Body& body) {
    try {
        return body();
    } catch (const Error& error) {
        if (std::string_view(error.what()).starts_with(path.string())) throw;
        throw error.with_context(path.string());
    }
}

}  // namespace

bool is_dicom_seg(const std::filesystem::path& path) {
    std::error_code ignored;
    if (!std::filesystem::is_regular_file(path, ignored) || !has_dicom_prefix(path)) return false;
    DcmFileFormat file;
    dcmtk::load(file, path, DCM_Manufacturer);  // the element after Modality
    return dcmtk::text(*file.getDataset(), DCM_Modality) == "SEG";
}

DicomSegmentation read_dicom_segmentation(const std::filesystem::path& path, std::int64_t max_voxels) {
    check_limit(max_voxels);
    return named_after(path, [&] {
        SegFile file(path, max_voxels);
        file.count_voxels();
        return file.description();
    });
}

DicomSegment fitted_segment(const StructureAttributes& attributes) {
    return {.label = "",
            .algorithm_type = fitted_attributes(attributes).generation_algorithm,
            .algorithm_name = "kontur",
            .color = attributes.color,
            .description = attributes.description,
            .category = attributes.category,
            .code = attributes.code};
}

DicomSeg read_dicom_seg(const std::filesystem::path& path, std::optional<std::int64_t> segment, std::int64_t max_voxels,
                        const Work& work) {
    check_limit(max_voxels);
    return named_after(path, [&] {
        const SegFile file(path, max_voxels);
        const DicomSegmentation& found = file.description();
        if (segment) check_segment(found, *segment);
        const bool small =
            std::all_of(found.segments.begin(), found.segments.end(), [](const DicomSegment& s) { return s.number <= 255; });
        Image image{found.grid, {}};
        if (small) image.samples = label_map<std::uint8_t>(file, segment, work);
        else image.samples = label_map<std::uint16_t>(file, segment, work);
        return DicomSeg{std::move(image), found.notes};
    });
}

std::vector<Mask> read_dicom_seg_masks(const std::filesystem::path& path, std::int64_t max_voxels, const Work& work) {
    check_limit(max_voxels);
    return named_after(path, [&] { return masks_of(SegFile(path, max_voxels), max_voxels, work); });
}

DicomSegments read_dicom_segments(const std::filesystem::path& path, std::int64_t max_voxels, const Work& work) {
    check_limit(max_voxels);
    return named_after(path, [&] {
        SegFile file(path, max_voxels);
        file.count_voxels();
        return DicomSegments{file.description(), masks_of(file, max_voxels, work)};
    });
}

StructureAttributes attributes_of(const DicomSegment& segment) {
    return {.color = segment.color,
            .generation_algorithm = segment.algorithm_type,
            .description = segment.description,
            .category = segment.category,
            .code = segment.code};
}

}  // namespace kontur
