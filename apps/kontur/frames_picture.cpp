// SPDX-License-Identifier: Apache-2.0
#include "frames_picture.h"

#include <fmt/format.h>

#include <algorithm>

#include "kontur/base/printable.h"
#include "kontur/extract/isolines.h"
#include "kontur/io/bytes/png.h"
#include "kontur/io/image_frames.h"
#include "kontur/view/moving_picture.h"
#include "segment_frames.h"

namespace kontur::app {
namespace {

constexpr double kUsualSeconds = 0.1;  // for a frame, where the image does not say
constexpr int kMovingWidth = 1000, kMovingHeight = 350;

class FramesPicture {
public:
    explicit FramesPicture(const SegmentedFrames& segmented) : segmented_(segmented), curve_(curve_of(segmented.result)) {
        Box3 box;
        for (const TriangleMesh& mesh : segmented.result.meshes)
            for (const Vec3& p : mesh.points) box.extend(p);
        if (box.is_empty()) return;
        const auto all = corners(box);
        shown_.assign(all.begin(), all.end());
    }

    RgbImage still(const Work& work) const {
        const VolumeCurve& volumes = segmented_.result.volumes;
        const Image largest = image_of(volumes.largest, work), smallest = image_of(volumes.smallest, work);
        const ContourSet of_largest = drawn_in(volumes.largest), of_smallest = drawn_in(volumes.smallest);
        const auto moment = [&](const char* what, std::size_t n, const ContourSet& drawn, const Image& image) {
            return PictureMoment{fmt::format("{}: frame {}", what, n + 1), segmented_.result.meshes[n], drawn, &image};
        };
        MovingPictureContent content{{moment("Largest", volumes.largest, of_largest, largest),
                                      moment("Smallest", volumes.smallest, of_smallest, smallest)},
                                     segmented_.contours,
                                     shown_,
                                     curve_,
                                     suggest_window(largest)};
        return make_moving_picture(content, {.title = title(), .facts = facts()}, work);
    }

    std::vector<RgbImage> moving(const Work& work) const {
        std::vector<RgbImage> pictures;
        Window window;
        for (std::size_t n = 0; n < segmented_.result.meshes.size(); ++n) {
            work.report("draw frames", static_cast<double>(n) / static_cast<double>(segmented_.result.meshes.size()));
            const Image image = image_of(n, work);
            if (n == 0) window = suggest_window(image);
            const ContourSet drawn = drawn_in(n);
            MovingPictureContent content{
                {{fmt::format("Frame {}, {}", n + 1, in_ml(segmented_.result.volumes.volumes_ml[n])),
                  segmented_.result.meshes[n], drawn, &image}},
                segmented_.contours,
                shown_,
                curve_,
                window};
            content.curve.now = n;
            pictures.push_back(make_moving_picture(
                content, {.width_px = kMovingWidth, .height_px = kMovingHeight, .title = title()}, work.untold()));
        }
        return pictures;
    }

private:
    static PictureCurve curve_of(const MovingSegmentation& result) {
        PictureCurve curve{result.volumes.volumes_ml, {}, {}, result.volumes.largest, result.volumes.smallest};
        for (const VolumeInterval& one : result.volumes.intervals) curve.intervals.emplace_back(one.low_ml, one.high_ml);
        for (std::size_t n = 0; n < result.times.size(); ++n)
            for (const DrawnMoment& moment : result.moments)
                if (moment.time == result.times[n]) curve.drawn.push_back(n);
        return curve;
    }

    Image image_of(std::size_t frame, const Work& work) const {
        const ImageInput one =
            source_of_frame(segmented_.command.image, segmented_.frames, static_cast<std::int64_t>(frame) + 1);
        return read_image(one.path, one.options, work);
    }

    ContourSet drawn_in(std::size_t frame) const {
        ContourSet drawn;
        for (const DrawnMoment& moment : segmented_.result.moments)
            if (moment.time == segmented_.result.times[frame])
                drawn.contours.assign(moment.set.contours.begin(),
                                      moment.set.contours.begin() + static_cast<std::ptrdiff_t>(moment.contours));
        return drawn;
    }

    std::string title() const {
        return segmented_.contours.name.empty() ? printable_utf8(segmented_.command.contours.front().stem().string())
                                                : segmented_.contours.name;
    }

    std::vector<PictureFact> facts() const {
        const VolumeCurve& volumes = segmented_.result.volumes;
        const auto percent = [](double share) { return fmt::format("{:.1f} %", 100 * share); };
        std::vector<PictureFact> facts{{"Largest volume", in_ml(volumes.volumes_ml[volumes.largest])},
                                       {"Smallest volume", in_ml(volumes.volumes_ml[volumes.smallest])},
                                       {"Stroke volume", in_ml(volumes.stroke_ml())},
                                       {"Ejection fraction", percent(volumes.ejection_fraction())}};
        if (const auto interval = volumes.ejection_interval())
            facts.push_back({"... in 90 % within", percent(interval->low) + " to " + percent(interval->high)});
        facts.push_back({"Frames drawn in", fmt::format("{}", curve_.drawn.size())});
        return facts;
    }

    const SegmentedFrames& segmented_;
    PictureCurve curve_;
    std::vector<Vec3> shown_;
};

}  // namespace

void write_picture_of_frames(const std::filesystem::path& path, const SegmentedFrames& segmented,
                             const Provenance& provenance, const Work& work) {
    const FramesPicture picture(segmented);
    if (is_animation(segmented.command))
        write_animated_png(path, picture.moving(work), segmented.frames.step_s.value_or(kUsualSeconds), provenance);
    else write_png(path, picture.still(work), provenance);
}

}  // namespace kontur::app
