// SPDX-License-Identifier: Apache-2.0
#include "viewer/surfaces/mask_editor.h"

#include <algorithm>
#include <condition_variable>
#include <iterator>
#include <mutex>
#include <thread>
#include <utility>

#include "kontur/base/error.h"
#include "kontur/correct/corrected_section.h"
#include "kontur/correct/existing_mesh.h"
#include "kontur/correct/mask_change.h"
#include "viewer/surfaces/corrected_mask.h"

namespace kontur::viewer {
namespace {

constexpr std::size_t kLeastPlanesForImage = 3;  // of reach_by_image: with fewer it is not asked

struct Request {
    std::uint64_t edit = 0;
    Corrections corrections;
    CorrectOptions options;
    std::shared_ptr<const Image> image;
    std::uint64_t step = 0;
    MaskSurroundings around;
};

/// The voxels that corrections changed.
struct ChangedVoxels {
    std::uint64_t step = 0;
    std::vector<std::size_t> offsets{};  ///< ascending
    double volume_ml = 0;
};

ChangedVoxels changed_by(const std::vector<MadeVoxel>& voxels, const CorrectReport& report, std::uint64_t step) {
    ChangedVoxels changed{step, {}, report.volume_ml};
    changed.offsets.reserve(voxels.size());
    for (const MadeVoxel& voxel : voxels) changed.offsets.push_back(voxel.offset);
    return changed;
}

std::int64_t voxels_more(const std::vector<MadeVoxel>& voxels) {
    const auto inside = std::ranges::count_if(voxels, &MadeVoxel::is_inside);
    return 2 * inside - std::ssize(voxels);
}

MaskStep step_between(const ChangedVoxels& before, const ChangedVoxels& after) {
    std::vector<std::size_t> differing;
    std::ranges::set_symmetric_difference(before.offsets, after.offsets, std::back_inserter(differing));
    return {static_cast<std::int64_t>(differing.size()), after.volume_ml - before.volume_ml};
}

/// The mask as mask_change() takes it, and its mesh: some bytes for each of its voxels.
struct VolumeOfMask {
    explicit VolumeOfMask(Mask mask) : whole(std::move(mask)), surface(whole), mesh(surface) {}
    VolumeOfMask(const VolumeOfMask&) = delete;
    VolumeOfMask& operator=(const VolumeOfMask&) = delete;

    Mask whole;
    ExistingSurface surface;
    ExistingMesh mesh;  ///< of that
};

}  // namespace

struct MaskEditor::Worker {
    Worker(std::shared_ptr<const StoredMask> mask, Listener listener)
        : stored(std::move(mask)), tell(std::move(listener)), thread([this] { run(); }) {}

    ~Worker() {
        {
            const std::scoped_lock lock(mutex);
            closed.request_stop();
            stop_image.request_stop();
            changed.notify_all();
        }
        thread.join();
    }

    void run() {
        while (true) {
            Request request;
            StopSource newer;
            {
                std::unique_lock lock(mutex);
                is_working = false;
                changed.notify_all();
                changed.wait(lock, [&] { return next || closed.stop_requested(); });
                if (closed.stop_requested()) return;
                request = std::move(*std::exchange(next, std::nullopt));
                is_working = true;
                stop_image = newer;
            }
            answer(request, newer.token());
        }
    }

    void answer(const Request& request, const StopToken& newer) {
        MaskUpdate update{MaskUpdate::Kind::corrected, request.edit, nullptr, false, {}, 0};
        try {
            update.result = corrected(request, nullptr, closed.token());
            update.asks_image = request.image && update.result->report.planes.size() >= kLeastPlanesForImage;
            last = update.result;
        } catch (const std::exception& error) {
            if (closed.stop_requested()) return;
            update.kind = MaskUpdate::Kind::problem;
            update.problem = error.what();
            update.result = last;
        }
        tell(update);
        if (!update.asks_image) return;
        try {
            update.result = last = corrected(request, request.image.get(), newer);
        } catch (const std::exception& error) {
            if (newer.stop_requested()) return;
            update.kind = MaskUpdate::Kind::problem;
            update.problem = error.what();
        }
        update.asks_image = false;
        tell(update);
    }

    std::shared_ptr<const MaskEdit> corrected(const Request& request, const Image* image, const StopToken& stop) {
        Work work{.stop = stop};
        work.callback = [&](std::string_view, double done) {
            MaskUpdate update;
            update.edit = request.edit;
            update.done = done;
            tell(update);
        };
        const std::shared_ptr<const VolumeOfMask> mask = opened_mask();
        const MaskChange change =
            mask_change({mask->whole, mask->surface, image}, request.corrections, request.options, work);
        const std::vector<MadeVoxel> voxels = voxels_among(request.around, change.voxels);
        CorrectedMesh corrected = mask->mesh.corrected(change.lattice.get(), voxels, Work{.stop = stop});
        auto edit = std::make_shared<MaskEdit>();
        edit->report = change.report;
        edit->report.volume_ml += static_cast<double>(voxels_more(voxels) - voxels_more(change.voxels)) *
                                  mask->whole.grid.voxel_volume_mm3() / 1000;
        edit->followed = std::max<std::int64_t>(0, std::ssize(voxels) - std::ssize(change.voxels));
        if (request.around.others) {
            const auto& own = request.around.kept ? voxels : change.voxels;
            MaskExchange exchange = exchange_of(mask->whole, own, Work{.stop = stop});
            exchange.kept = request.around.kept;
            edit->exchange = std::make_shared<const MaskExchange>(std::move(exchange));
        }
        edit->origins = origins_of(corrected.made_by);
        edit->mesh = std::make_shared<const TriangleMesh>(std::move(corrected.mesh));
        edit->step = step_of(changed_by(voxels, edit->report, request.step), change.report);
        return edit;
    }

    std::vector<MadeVoxel> voxels_among(const MaskSurroundings& around, const std::vector<MadeVoxel>& own) const {
        if (around.kept) return made_and_kept(own, *stored, *around.kept);
        return around.others ? made_and_followed(own, *stored, *around.others) : own;
    }

    std::optional<MaskStep> step_of(ChangedVoxels now, const CorrectReport& report) {
        if (!present && now.step > 0) present.emplace(ChangedVoxels{0, {}, report.volume_before_ml});
        if (present && present->step < now.step) before = std::move(present);
        else if (present && present->step > now.step) before.reset();  // a draft that was given up
        present = std::move(now);
        return before ? std::optional(step_between(*before, *present)) : std::nullopt;
    }

    std::shared_ptr<const VolumeOfMask> opened_mask() {
        const std::scoped_lock lock(opened_mutex);
        if (!opened) opened = std::make_shared<const VolumeOfMask>(stored->mask());
        return opened;
    }

    const std::shared_ptr<const StoredMask> stored;
    const Listener tell;
    std::shared_ptr<const MaskEdit> last;          ///< of the thread alone
    std::optional<ChangedVoxels> before, present;  ///< of it alone: by the last step but one, and by the last

    std::mutex opened_mutex;
    std::shared_ptr<const VolumeOfMask> opened;

    std::mutex mutex;
    std::condition_variable changed;
    std::optional<Request> next;
    StopSource closed, stop_image;
    std::uint64_t edits = 0;
    bool is_working = false;
    std::thread thread;  ///< last: it uses all above
};

MaskEditor::MaskEditor(std::shared_ptr<const StoredMask> mask, Listener listener)
    : mask_(mask), worker_(std::make_unique<Worker>(std::move(mask), std::move(listener))) {}

MaskEditor::~MaskEditor() = default;

std::uint64_t MaskEditor::edit(Corrections corrections, const CorrectOptions& options, std::shared_ptr<const Image> image,
                               std::uint64_t step, MaskSurroundings around) {
    const std::scoped_lock lock(worker_->mutex);
    worker_->stop_image.request_stop();
    worker_->next = Request{++worker_->edits, std::move(corrections), options, std::move(image), step, std::move(around)};
    worker_->changed.notify_all();
    return worker_->edits;
}

void MaskEditor::check(const Corrections& corrections) const {
    const std::shared_ptr<const VolumeOfMask> mask = worker_->opened_mask();
    corrected_sections(mask->surface, corrections, smallest(mask->whole.grid.spacing_mm()));
}

void MaskEditor::wait() {
    std::unique_lock lock(worker_->mutex);
    worker_->changed.wait(lock, [&] { return !worker_->next && !worker_->is_working; });
}

}  // namespace kontur::viewer
