// SPDX-License-Identifier: Apache-2.0
#include "kontur/live_editor.h"

#include <condition_variable>
#include <mutex>
#include <optional>
#include <thread>

#include "kontur/base/error.h"

namespace kontur {

struct LiveEditor::Worker {
    struct Edit {
        std::uint64_t number;
        ContourSet contours;
        std::shared_ptr<const Image> image;
    };

    Editor editor;
    int threads;
    Listener listener;
    BandListener ahead;
    std::weak_ptr<const Image> last_image;  ///< of the last edit; the editor's thread alone uses it
    std::mutex mutex;                       // guards all below
    std::condition_variable changed;
    std::uint64_t newest = 0;    ///< number of edits so far
    std::uint64_t answered = 0;  ///< the newest that is done with
    std::optional<Edit> pending;
    std::stop_source refining{std::nostopstate};
    bool closing = false;
    std::jthread thread;  // last: starts when all else is there

    Worker(const EditorOptions& options, Listener to, BandListener band_to, int threads_of_work)
        : editor(options),
          threads(threads_of_work),
          listener(std::move(to)),
          ahead(std::move(band_to)),
          thread([this](const std::stop_token& closed) { run(closed); }) {}

    ~Worker() {
        const std::lock_guard lock(mutex);
        closing = true;
        refining.request_stop();
        changed.notify_all();
    }

    void run(const std::stop_token& closed) {
        while (const std::optional<Edit> edit = next()) {
            answer(*edit, closed);
            const std::lock_guard lock(mutex);
            answered = edit->number;
            changed.notify_all();
        }
    }

    std::optional<Edit> next() {
        std::unique_lock lock(mutex);
        changed.wait(lock, [&] { return closing || pending; });
        if (closing) return std::nullopt;
        return std::exchange(pending, std::nullopt);
    }

    void answer(const Edit& edit, const std::stop_token& closed) {
        EditorUpdate update;
        update.edit = edit.number;
        try {
            std::function<void(const SurfaceBand&)> tell_ahead;
            if (edit.image != last_image.lock()) editor.forget_image();
            last_image = edit.image;
            if (ahead) tell_ahead = [&](const SurfaceBand& band) { ahead(edit.number, band); };
            update.surface = editor.preview(edit.contours, work_for(edit, closed), tell_ahead);
            update.kind = EditorUpdate::Kind::preview;
            listener(update);
            const std::stop_token stop = start_refining();
            if (stop.stop_requested()) return;
            update.kind = EditorUpdate::Kind::refined;
            const auto tell_alone = [&](const EditedSurface& alone) {
                update.kind = EditorUpdate::Kind::refined;
                update.surface = alone;
                update.asks_image = true;
                listener(update);
                update.asks_image = false;
                update.kind = EditorUpdate::Kind::with_image;
            };
            update.surface = editor.refine(edit.contours, edit.image.get(), work_for(edit, stop), tell_alone);
            listener(update);
        } catch (const std::exception& error) {
            const auto* known = dynamic_cast<const Error*>(&error);
            if (known && known->kind() == ErrorKind::cancelled) return;
            tell_problem(edit.number, error.what());
        }
    }

    void tell_problem(std::uint64_t number, const char* problem) {
        try {
            EditorUpdate update;
            update.edit = number;
            update.kind = EditorUpdate::Kind::problem;
            update.problem = problem;
            listener(update);
        } catch (const std::exception&) {  // without memory nothing can be told, and from a thread it would end the program
        }
    }

    /// A token that the next edit stops; stopped already if that edit has come.
    std::stop_token start_refining() {
        const std::lock_guard lock(mutex);
        refining = std::stop_source();
        if (pending || closing) refining.request_stop();
        return refining.get_token();
    }

    Work work_for(const Edit& edit, std::stop_token stop) {
        return {threads,
                [this, number = edit.number](std::string_view stage, double done) {
                    EditorUpdate update;
                    update.edit = number;
                    update.stage = stage;
                    update.done = done;
                    listener(update);
                },
                std::move(stop)};
    }
};

LiveEditor::LiveEditor(const EditorOptions& options, Listener listener, BandListener ahead, int threads)
    : worker_(std::make_unique<Worker>(options, std::move(listener), std::move(ahead), threads)) {}

LiveEditor::~LiveEditor() = default;

std::uint64_t LiveEditor::edit(ContourSet contours, std::shared_ptr<const Image> image) {
    const std::lock_guard lock(worker_->mutex);
    worker_->pending = {++worker_->newest, std::move(contours), std::move(image)};
    worker_->refining.request_stop();
    worker_->changed.notify_all();
    return worker_->newest;
}

void LiveEditor::wait() {
    std::unique_lock lock(worker_->mutex);
    worker_->changed.wait(lock, [&] { return worker_->answered == worker_->newest; });
}

}  // namespace kontur
