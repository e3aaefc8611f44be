// SPDX-License-Identifier: Apache-2.0
#include "viewer/surfaces.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <new>

#include "kontur/base/error.h"
#include "kontur/extract/preview.h"
#include "kontur/segment.h"

namespace kontur::viewer {
namespace {

/// A hand that moves on within this time rests not yet.
constexpr std::chrono::milliseconds kRest{250};

constexpr double kPreviewCells = 48, kRefinedCells = 128;  ///< along the diagonal of the contours' box
constexpr double kPreviewQuality = 0.4;

std::vector<Vec3> all_points(const ContourSet& set) {
    std::vector<Vec3> points;
    for (const Contour& contour : set.contours) points.insert(points.end(), contour.points.begin(), contour.points.end());
    return points;
}

/// The contour's point where the function is farthest from 0.
Vec3 worst_point(const Contour& contour, const ImplicitFunction& function) {
    std::vector<double> values(contour.points.size());
    function.values(contour.points, values);
    const auto worst =
        std::max_element(values.begin(), values.end(), [](double a, double b) { return std::abs(a) < std::abs(b); });
    return contour.points[static_cast<std::size_t>(worst - values.begin())];
}

Surface make_surface(const SurfaceTask& task, SurfaceStage stage, const Progress& progress) {
    const bool is_preview = stage == SurfaceStage::preview;
    const Box3 box = bounding_box(task.set);
    const double cell = box.diagonal() / (is_preview ? kPreviewCells : kRefinedCells);
    SegmentOptions options;
    options.quality = is_preview ? kPreviewQuality : 1;
    const double coarse = box.diagonal() / 16;
    const Segmentation made = segment(task.set, grid_around(box, {coarse, coarse, coarse}, 4 * coarse), options, progress);

    Surface surface;
    surface.structure = task.structure;
    surface.stage = stage;
    surface.mesh = std::make_shared<const TriangleMesh>(
        preview_surface(made.function, all_points(task.set), {.spacing_mm = cell}, progress));
    surface.volume_ml = signed_volume_mm3(*surface.mesh) / 1000;
    surface.residual = made.report.residual;
    surface.worst_contour = task.ids[made.report.residual.worst_contour];
    surface.worst_at = worst_point(task.set.contours[made.report.residual.worst_contour], made.function);
    return surface;
}

}  // namespace

std::string_view name(SurfaceStage stage) noexcept {
    switch (stage) {
        case SurfaceStage::preview:
            return "preview";
        case SurfaceStage::refined:
            return "refined";
        case SurfaceStage::none:
            break;
    }
    return "none";
}

Surfaces::Surfaces(SurfaceListener listener)
    : listener_(std::move(listener)), worker_([this](const std::stop_token& stop) { work(stop); }) {}

Surfaces::~Surfaces() {
    worker_.request_stop();
    const std::scoped_lock lock(mutex_);
    cancel_.request_stop();
}

void Surfaces::follow(SurfaceTask task) {
    const std::scoped_lock lock(mutex_);
    const Id structure = task.structure;
    if (running_ == structure) cancel_.request_stop();
    pending_[structure] = {std::move(task), SurfaceStage::preview};
    wake_.notify_all();
}

void Surfaces::wait() {
    std::unique_lock lock(mutex_);
    idle_.wait(lock, [&] { return pending_.empty() && running_ == 0; });
}

std::map<Id, std::shared_ptr<const Surface>> Surfaces::all() const {
    const std::scoped_lock lock(mutex_);
    return latest_;
}

void Surfaces::work(const std::stop_token& stop) {
    while (const std::optional<Pending> job = take(stop)) {
        make(*job, cancel_.get_token());
        bool is_idle = false;
        {
            const std::scoped_lock lock(mutex_);
            running_ = 0;
            is_idle = pending_.empty();
        }
        if (is_idle) listener_.status("");
        idle_.notify_all();
    }
}

/// The next job: previews of all structures before the first fine surface, which waits for the hand to rest.
std::optional<Surfaces::Pending> Surfaces::take(const std::stop_token& stop) {
    std::unique_lock lock(mutex_);
    const auto preview = [&] {
        return std::find_if(pending_.begin(), pending_.end(),
                            [](const auto& item) { return item.second.next == SurfaceStage::preview; });
    };
    wake_.wait(lock, stop, [&] { return !pending_.empty(); });
    if (!stop.stop_requested() && preview() == pending_.end())
        wake_.wait_for(lock, stop, kRest, [&] { return preview() != pending_.end(); });
    if (stop.stop_requested()) return std::nullopt;
    const auto chosen = preview() != pending_.end() ? preview() : pending_.begin();
    Pending job = chosen->second;
    if (job.next == SurfaceStage::preview && !job.task.set.contours.empty()) chosen->second.next = SurfaceStage::refined;
    else pending_.erase(chosen);
    running_ = job.task.structure;
    cancel_ = std::stop_source();
    return job;
}

void Surfaces::make(const Pending& job, const std::stop_token& stop) {
    Surface none;
    none.structure = job.task.structure;
    if (job.task.set.contours.empty()) return publish(std::move(none));
    listener_.status((job.next == SurfaceStage::preview ? "Sketching " : "Refining ") + job.task.set.name);
    try {
        publish(make_surface(job.task, job.next, {{}, stop}));
    } catch (const Error& error) {
        if (error.kind() == ErrorKind::cancelled) return;
        none.warnings.emplace_back(error.what());
        publish(std::move(none));
    } catch (const std::bad_alloc&) {
        none.warnings.emplace_back("there is not enough memory for this surface");
        publish(std::move(none));
    }
}

void Surfaces::publish(Surface surface) {
    std::shared_ptr<const Surface> published;
    {
        const std::scoped_lock lock(mutex_);
        surface.revision = ++revision_;
        published = latest_[surface.structure] = std::make_shared<const Surface>(std::move(surface));
    }
    listener_.surface(published);
}

}  // namespace kontur::viewer
