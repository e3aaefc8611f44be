// SPDX-License-Identifier: Apache-2.0
#include "viewer/surfaces/mask_editor.h"

#include <condition_variable>
#include <mutex>
#include <thread>
#include <utility>

#include "kontur/base/error.h"
#include "kontur/correct/corrected_section.h"
#include "viewer/surfaces/corrected_mask.h"

namespace kontur::viewer {
namespace {

constexpr std::size_t kLeastPlanesForImage = 3;  // of reach_by_image: with fewer it is not asked

struct Request {
    std::uint64_t edit = 0;
    Corrections corrections;
    CorrectOptions options;
    std::shared_ptr<const Image> image;
};

/// The mask as correct() takes it: some bytes for each of its voxels.
struct Opened {
    explicit Opened(Mask mask) : whole(std::move(mask)), surface(whole) {}
    Mask whole;
    ExistingSurface surface;
};

std::shared_ptr<const MaskEdit> edit_of(const CorrectedMask& corrected, const Work& work) {
    auto made = std::make_shared<MaskEdit>();
    made->report = corrected.report;
    auto mesh = std::make_shared<TriangleMesh>(mesh_of(corrected.mask, work));
    made->origins = origins_of(*mesh, corrected);
    made->mesh = std::move(mesh);
    return made;
}

}  // namespace

struct MaskEditor::Worker {
    Worker(std::shared_ptr<const StoredMask> mask, Listener listener)
        : stored(std::move(mask)),
          tell(std::move(listener)),
          thread([this](const std::stop_token& closed) { run(closed); }) {}

    void run(const std::stop_token& closed) {
        while (true) {
            Request request;
            std::stop_source newer;
            {
                std::unique_lock lock(mutex);
                is_working = false;
                changed.notify_all();
                if (!changed.wait(lock, closed, [&] { return next.has_value(); })) return;
                request = std::move(*std::exchange(next, std::nullopt));
                is_working = true;
                stop_image = newer;
            }
            const std::stop_callback closing(closed, [&] { newer.request_stop(); });
            answer(request, closed, newer.get_token());
        }
    }

    void answer(const Request& request, const std::stop_token& closed, const std::stop_token& newer) {
        MaskUpdate update{MaskUpdate::Kind::corrected, request.edit, nullptr, false, {}, 0};
        try {
            update.result = corrected(request, nullptr, closed);
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

    std::shared_ptr<const MaskEdit> corrected(const Request& request, const Image* image, const std::stop_token& stop) {
        Work work{.stop = stop};
        work.callback = [&](std::string_view, double done) {
            MaskUpdate update;
            update.edit = request.edit;
            update.done = done;
            tell(update);
        };
        const std::shared_ptr<const Opened> mask = opened_mask();
        return edit_of(correct({mask->whole, mask->surface, image}, request.corrections, request.options, work),
                       Work{.stop = stop});
    }

    std::shared_ptr<const Opened> opened_mask() {
        const std::scoped_lock lock(opened_mutex);
        if (!opened) opened = std::make_shared<const Opened>(stored->mask());
        return opened;
    }

    const std::shared_ptr<const StoredMask> stored;
    const Listener tell;
    std::shared_ptr<const MaskEdit> last;  ///< of the thread alone

    std::mutex opened_mutex;
    std::shared_ptr<const Opened> opened;

    std::mutex mutex;
    std::condition_variable_any changed;
    std::optional<Request> next;
    std::stop_source stop_image;
    std::uint64_t edits = 0;
    bool is_working = false;
    std::jthread thread;  ///< last: it uses all above
};

MaskEditor::MaskEditor(std::shared_ptr<const StoredMask> mask, Listener listener)
    : mask_(mask), worker_(std::make_unique<Worker>(std::move(mask), std::move(listener))) {}

MaskEditor::~MaskEditor() = default;

std::uint64_t MaskEditor::edit(Corrections corrections, const CorrectOptions& options, std::shared_ptr<const Image> image) {
    const std::scoped_lock lock(worker_->mutex);
    worker_->stop_image.request_stop();
    worker_->next = Request{++worker_->edits, std::move(corrections), options, std::move(image)};
    worker_->changed.notify_all();
    return worker_->edits;
}

void MaskEditor::check(const Corrections& corrections) const {
    const std::shared_ptr<const Opened> mask = worker_->opened_mask();
    corrected_sections(mask->surface, corrections, smallest(mask->whole.grid.spacing_mm()));
}

void MaskEditor::wait() {
    std::unique_lock lock(worker_->mutex);
    worker_->changed.wait(lock, [&] { return !worker_->next && !worker_->is_working; });
}

}  // namespace kontur::viewer
