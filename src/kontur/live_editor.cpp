// SPDX-License-Identifier: Apache-2.0
#include "kontur/live_editor.h"

#include <algorithm>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <optional>
#include <thread>
#include <tuple>
#include <utility>

#include "kontur/base/error.h"

namespace kontur {
namespace {

auto parts(const Contour& c) {
    return std::tie(c.plane, c.points, c.closed, c.hole, c.end, c.inside, c.weight, c.frame, c.time_s);
}

bool is_same(const ContourSet& a, const ContourSet& b) {
    const auto others = [](const ContourSet& s) {
        return std::tie(s.name, s.interior, s.exterior, s.surface, s.empty_planes);
    };
    return others(a) == others(b) && std::ranges::equal(a.contours, b.contours, [](const Contour& c, const Contour& d) {
               return parts(c) == parts(d);
           });
}

}  // namespace

struct LiveEditor::Worker {
    struct Edit {
        std::uint64_t number;  ///< of the last one that is answered with this
        ContourSet contours;
        std::shared_ptr<const Image> image;

        bool asks_the_same(const ContourSet& others, const std::shared_ptr<const Image>& other_image) const {
            return is_same(contours, others) && image == other_image;
        }
    };

    /// What an edit was told when nothing more came.
    struct Answer {
        ContourSet contours;
        std::weak_ptr<const Image> image;
        bool has_image;
        std::optional<EditedSurface> alone;  ///< told before the image was asked
        EditorUpdate last;

        bool answers(const Edit& edit) const {
            return has_image == (edit.image != nullptr) && edit.asks_the_same(contours, image.lock());
        }
    };

    Editor editor;
    int threads;
    std::chrono::milliseconds rest;
    Listener listener;
    BandListener ahead;
    // The editor's thread alone uses these.
    std::weak_ptr<const Image> last_image;  ///< of the last edit
    std::deque<Answer> answers;             ///< the one needed last first
    std::mutex mutex;                       // guards all below
    std::condition_variable changed;
    std::uint64_t newest = 0;    ///< number of edits so far
    std::uint64_t answered = 0;  ///< the newest that is done with
    std::optional<Edit> pending;
    std::shared_ptr<Edit> answering;  ///< null once the last is told of it; its number alone changes
    StopSource finishing;
    StopSource closed;  ///< what no edit that comes later stops
    bool closing = false;
    std::thread thread;  // last: starts when all else is there

    Worker(const EditorOptions& options, Listener to, BandListener band_to, int threads_of_work,
           std::chrono::milliseconds rest_before)
        : editor(options),
          threads(threads_of_work),
          rest(rest_before),
          listener(std::move(to)),
          ahead(std::move(band_to)),
          thread([this] { run(); }) {}

    ~Worker() {
        {
            const std::lock_guard lock(mutex);
            closing = true;
            closed.request_stop();
            finishing.request_stop();
            changed.notify_all();
        }
        thread.join();
    }

    void run() {
        while (const std::shared_ptr<const Edit> edit = next()) {
            answer(*edit);
            const std::lock_guard lock(mutex);
            answering = nullptr;
            answered = edit->number;
            changed.notify_all();
        }
    }

    std::shared_ptr<const Edit> next() {
        std::unique_lock lock(mutex);
        changed.wait(lock, [&] { return closing || pending; });
        if (closing) return nullptr;
        return answering = std::make_shared<Edit>(*std::exchange(pending, std::nullopt));
    }

    void answer(const Edit& edit) {
        EditorUpdate update;
        try {
            std::function<void(const SurfaceBand&)> tell_ahead;
            if (edit.image != last_image.lock()) editor.forget_image();
            last_image = edit.image;
            if (tell_again(edit)) return;
            if (ahead) tell_ahead = [&](const SurfaceBand& band) { ahead(number_of(edit), band); };
            update.surface = editor.preview(edit.contours, work_for(edit, closed.token()), tell_ahead);
            update.kind = EditorUpdate::Kind::preview;
            tell(edit, update);
            const StopToken stop = start_finishing();
            if (stop.stop_requested()) return;
            Answer answer{edit.contours, edit.image, edit.image != nullptr, std::nullopt, {}};
            answer.last.kind = EditorUpdate::Kind::finished;
            const auto tell_before = [&](const EditedSurface& surface) {
                tell_before_image(edit, surface);
                answer.alone = surface;  // the last of them
                answer.last.kind = EditorUpdate::Kind::with_image;
            };
            answer.last.surface = editor.finish(edit.contours, edit.image.get(), work_for(edit, stop), tell_before);
            tell_last(edit, answer.last);
            keep(std::move(answer));
        } catch (const std::exception& error) {
            const auto* known = dynamic_cast<const Error*>(&error);
            if (known && known->kind() == ErrorKind::cancelled) return;
            tell_problem(edit, error.what());
        }
    }

    /// What was told when the drawing was the same before; false where it never was, or too long ago.
    bool tell_again(const Edit& edit) {
        const auto known = std::ranges::find_if(answers, [&](const Answer& answer) { return answer.answers(edit); });
        if (known == answers.end()) return false;
        Answer answer = std::move(*known);
        answers.erase(known);
        editor.follow_image_of(edit.contours, answer.last.surface.image);
        if (answer.alone) tell_before_image(edit, *answer.alone);
        tell_last(edit, answer.last);
        keep(std::move(answer));
        return true;
    }

    void keep(Answer answer) {
        answers.push_front(std::move(answer));
        if (answers.size() > kKeptAnswers) answers.pop_back();
    }

    void tell_before_image(const Edit& edit, const EditedSurface& surface) {
        EditorUpdate update;
        update.kind = EditorUpdate::Kind::finished;
        update.surface = surface;
        update.asks_image = true;
        tell(edit, update);
    }

    std::uint64_t number_of(const Edit& edit) {
        const std::lock_guard lock(mutex);
        return edit.number;
    }

    void tell(const Edit& edit, EditorUpdate& update) {
        update.edit = number_of(edit);
        listener(update);
    }

    /// Later edits are not answered by it any more.
    void tell_last(const Edit& edit, EditorUpdate& update) {
        {
            const std::lock_guard lock(mutex);
            answering = nullptr;
        }
        tell(edit, update);
    }

    void tell_problem(const Edit& edit, const char* problem) {
        try {
            EditorUpdate update;
            update.kind = EditorUpdate::Kind::problem;
            update.problem = problem;
            tell_last(edit, update);
        } catch (const std::exception&) {  // without memory nothing can be told, and from a thread it would end the program
        }
    }

    /// Waits a little, then returns a token that the next edit stops; stopped already if that edit has come.
    StopToken start_finishing() {
        std::unique_lock lock(mutex);
        const bool is_disturbed = changed.wait_for(lock, rest, [&] { return pending || closing; });
        finishing = StopSource();
        if (is_disturbed) finishing.request_stop();
        return finishing.token();
    }

    Work work_for(const Edit& edit, StopToken stop) {
        return {threads,
                [this, &edit](std::string_view stage, double done) {
                    EditorUpdate update;
                    update.stage = stage;
                    update.done = done;
                    tell(edit, update);
                },
                std::move(stop)};
    }
};

LiveEditor::LiveEditor(const EditorOptions& options, Listener listener, BandListener ahead, int threads,
                       std::chrono::milliseconds rest)
    : worker_(std::make_unique<Worker>(options, std::move(listener), std::move(ahead), threads, rest)) {}

LiveEditor::~LiveEditor() = default;

std::uint64_t LiveEditor::edit(ContourSet contours, std::shared_ptr<const Image> image) {
    const std::lock_guard lock(worker_->mutex);
    const std::uint64_t number = ++worker_->newest;
    const std::shared_ptr<Worker::Edit>& answering = worker_->answering;
    if (!worker_->pending && answering && answering->asks_the_same(contours, image)) return answering->number = number;
    worker_->pending = {number, std::move(contours), std::move(image)};
    worker_->finishing.request_stop();
    worker_->changed.notify_all();
    return number;
}

void LiveEditor::wait() {
    std::unique_lock lock(worker_->mutex);
    worker_->changed.wait(lock, [&] { return worker_->answered == worker_->newest; });
}

}  // namespace kontur
