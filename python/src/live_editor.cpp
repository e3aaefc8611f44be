// SPDX-License-Identifier: Apache-2.0
#include "live_editor.h"

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <future>
#include <mutex>
#include <set>
#include <thread>

#include "bindings.h"
#include "kontur/live_editor.h"

namespace kontur::python {
namespace {

using namespace std::chrono_literals;

bool has_surface(const EditorUpdate& update) {
    return update.kind != EditorUpdate::Kind::problem && update.kind != EditorUpdate::Kind::progress;
}

/// Python's image, not a copy: kept as long as the editor's thread may read it, and let go by whichever thread is the last.
std::shared_ptr<const Image> kept(const Image* image) {
    if (!image) return nullptr;
    py::object known = py::cast(image, py::return_value_policy::reference);  // the object that holds it
    return {image, [owner = std::move(known)](const Image*) mutable {
                const py::gil_scoped_acquire acquire;
                owner = {};
            }};
}

/// What the editor's thread and Python's threads share; the last of them takes it along. Whoever waits for the editor's
/// thread must not hold the interpreter's lock, which that thread takes for each update.
class Session {
public:
    explicit Session(py::object listener) : listener_(std::move(listener)) {}
    ~Session() {
        const py::gil_scoped_acquire acquire;  // the editor's callback may have been the last owner
        listener_ = {};
    }
    Session(const Session&) = delete;
    Session& operator=(const Session&) = delete;

    static std::shared_ptr<Session> start(const EditorOptions& options, py::object listener, int threads) {
        auto session = std::make_shared<Session>(std::move(listener));
        session->editor_ = std::make_unique<LiveEditor>(
            options, [session](const EditorUpdate& update) { session->take(update); }, LiveEditor::BandListener{}, threads);
        return session;
    }

    std::uint64_t edit(const ContourSet& contours, std::shared_ptr<const Image> image) {
        const ReleasedLock released;
        const std::scoped_lock lock(mutex_);  // so that no answer comes before its edit is known
        if (!editor_) throw Error(ErrorKind::invalid_input, "the editor is closed");
        return newest_ = editor_->edit(contours, std::move(image));
    }

    /// Looks at signals every 20 ms; the editor works on when Ctrl-C ends the wait.
    void wait() {
        constexpr std::chrono::milliseconds kPollInterval{20};
        while (true) {
            if (PyErr_CheckSignals() != 0) throw py::error_already_set();
            const ReleasedLock released;
            std::unique_lock lock(mutex_);
            woken_.wait_for(lock, kPollInterval, [&] { return answered_ >= newest_ || !editor_; });
            if (answered_ >= newest_) return;
            if (!editor_)
                throw Error(ErrorKind::cancelled,
                            "the editor was closed before edit " + std::to_string(newest_) + " was finished");
        }
    }

    /// Ends the waits; the editor is the caller's to destroy.
    std::unique_ptr<LiveEditor> close() {
        std::unique_ptr<LiveEditor> ending;
        {
            const std::scoped_lock lock(mutex_);
            ending = std::move(editor_);
        }
        woken_.notify_all();
        return ending;
    }

    bool is_own_thread() const { return std::this_thread::get_id() == thread_; }

private:
    void take(const EditorUpdate& update) {
        thread_ = std::this_thread::get_id();
        {
            const py::gil_scoped_acquire acquire;
            try {
                listener_(update);
            } catch (py::error_already_set& error) {
                error.discard_as_unraisable("the listener of kontur.LiveEditor");
            }
        }
        if (!has_surface(update) && update.kind != EditorUpdate::Kind::problem) return;
        if (update.kind == EditorUpdate::Kind::preview || update.asks_image) return;  // more follows
        {
            const std::scoped_lock lock(mutex_);
            answered_ = std::max(answered_, update.edit);
        }
        woken_.notify_all();
    }

    py::object listener_;
    std::atomic<std::thread::id> thread_;  ///< the editor's, once it has spoken
    std::mutex mutex_;                     // guards all below
    std::condition_variable woken_;
    std::uint64_t newest_ = 0, answered_ = 0;
    std::unique_ptr<LiveEditor> editor_;  ///< none once closed
};

/// A LiveEditor whose listener is Python's. Its members and those of the class are guarded by the interpreter's lock.
class ListenedEditor {
public:
    ListenedEditor(const EditorOptions& options, py::object listener, int threads)
        : session_(Session::start(options, std::move(listener), threads)) {
        all().insert(this);
    }
    ~ListenedEditor() { end(); }
    ListenedEditor(const ListenedEditor&) = delete;
    ListenedEditor& operator=(const ListenedEditor&) = delete;

    std::uint64_t edit(const ContourSet& contours, const Image* image) const {
        return session()->edit(contours, kept(image));
    }

    void wait() const {
        refuse_listener("wait");
        session()->wait();
    }

    void close() {
        refuse_listener("close");
        end();
    }

    /// Before the interpreter ends, when its lock can no longer be taken.
    static void close_all() {
        while (!all().empty()) (*all().begin())->end();
        auto ending = std::exchange(ending_elsewhere(), {});
        const ReleasedLock released;
        ending.clear();
    }

    /// In a forked process, which has the editors but not their threads: nothing can be waited for, no mutex trusted.
    static void forget_all() {
        for (ListenedEditor* editor : std::exchange(all(), {})) new auto(std::move(editor->session_));
        new auto(std::exchange(ending_elsewhere(), {}));
    }

private:
    static std::set<ListenedEditor*>& all() {
        static std::set<ListenedEditor*> editors;
        return editors;
    }

    /// Editors whose listener dropped them: a thread cannot wait for itself.
    static std::vector<std::future<void>>& ending_elsewhere() {
        static std::vector<std::future<void>> editors;
        return editors;
    }

    /// A copy, as another thread may close this editor meanwhile.
    std::shared_ptr<Session> session() const {
        if (!session_) throw Error(ErrorKind::invalid_input, "the editor is closed");
        return session_;
    }

    void end() {
        all().erase(this);
        const std::shared_ptr<Session> session = std::move(session_);
        if (!session) return;
        std::unique_ptr<LiveEditor> ending = session->close();
        if (session->is_own_thread()) {
            std::erase_if(ending_elsewhere(), [](const auto& e) { return e.wait_for(0s) == std::future_status::ready; });
            ending_elsewhere().push_back(
                std::async(std::launch::async, [editor = std::move(ending)]() mutable { editor.reset(); }));
            return;
        }
        const ReleasedLock released;
        ending.reset();
    }

    void refuse_listener(const char* method) const {
        if (session_ && session_->is_own_thread())
            throw Error(ErrorKind::invalid_input, std::string("the listener of a LiveEditor must not call ") + method);
    }

    std::shared_ptr<Session> session_;  ///< none once closed
};

std::string word(EditorUpdate::Kind kind) {
    constexpr std::array<const char*, 5> kWords{"preview", "finished", "with_image", "problem", "progress"};
    return kWords[static_cast<std::size_t>(kind)];
}

void bind_update(py::module_& m) {
    py::class_<EditorUpdate> update(m, "EditorUpdate", "What a LiveEditor has to say about an edit.");
    update.def_property_readonly(
        "kind", [](const EditorUpdate& u) { return word(u.kind); },
        "str: 'preview', 'finished' (what the contours make: final for this edit, unless `asks_image`), 'with_image' (the "
        "image "
        "was asked, and this is final), 'problem' (the contours cannot be fitted) or 'progress'.");
    update.def_readonly("edit", &EditorUpdate::edit, "int: which edit this answers, from 1.");
    update.def_property_readonly(
        "surface",
        [](const EditorUpdate& u) -> std::optional<EditedSurface> {
            return has_surface(u) ? std::optional(u.surface) : std::nullopt;
        },
        "EditedSurface of an update that is neither a problem nor progress, else None.");
    update.def_readonly("asks_image", &EditorUpdate::asks_image, "bool: of a finished one: 'with_image' follows.");
    update.def_readonly("problem", &EditorUpdate::problem, "str: why the contours cannot be fitted.");
    update.def_property_readonly(
        "stage", [](const EditorUpdate& u) { return std::string(u.stage); }, "str: of a progress update.");
    update.def_readonly("done", &EditorUpdate::done, "float: fraction of the stage.");
}

}  // namespace

void bind_live_editor(py::module_& m, const Keywords<EditorOptions>& keywords) {
    bind_update(m);
    const std::string help =
        filled_in(R"(An Editor on a thread of its own: previews the newest contours, finishes, then asks the image.

An edit cancels a running finishing, and the question to the image, at once; a running preview is finished first. Close it, or use it in a `with` statement.
In a forked process it is closed.

Parameters
----------
listener : callable
    Called with each EditorUpdate, from the editor's thread, one at a time; it must not call `wait` or `close`.
@threads
@options

Examples
--------
>>> contours = kontur.phantom_case("kidney_radial6").contours
>>> kinds = []
>>> with kontur.LiveEditor(lambda update: kinds.append(update.kind)) as editor:
...     number = editor.edit(contours)
...     editor.wait()
>>> number, kinds[-1], "preview" in kinds
(1, 'finished', True)
)",
                  keywords.documentation());
    py::class_<ListenedEditor> editor(m, "LiveEditor", help.c_str());
    const std::string init_doc = docstring("__init__", "self, listener, *, threads=0", "", KeywordText(keywords));
    editor.def(py::init([keywords](py::object listener, int threads, const py::kwargs& given) {
                   const EditorOptions options = keywords.parse("LiveEditor", given);
                   if (PyCallable_Check(listener.ptr()) == 0)
                       throw py::type_error("listener: a callable is needed, not " + py::repr(listener).cast<std::string>());
                   return std::make_unique<ListenedEditor>(options, std::move(listener), threads);
               }),
               py::arg("listener"), py::kw_only(), kThreads, init_doc.c_str());
    method(editor, "edit",
           R"(The contours are now this ContourSet, drawn on this Image, if any is to be asked.

Returns the number of the edit, from 1. Does not wait. The image is not copied.)",
           &ListenedEditor::edit, py::arg("contours"), py::kw_only(), py::arg("image") = py::none());
    method(editor, "wait",
           R"(Waits until the newest edit has its final surface or has turned out to be a problem.

Ctrl-C ends the wait, not the work. Raises CancelledError when the editor is closed before.)",
           &ListenedEditor::wait);
    method(editor, "close", "Cancels what runs and ends the thread. Closing again does nothing.", &ListenedEditor::close);
    editor.def("__enter__", [](const py::object& self) { return self; });
    editor.def("__exit__", [](ListenedEditor& self, const py::args&) { self.close(); });
    py::module_::import("atexit").attr("register")(py::cpp_function(&ListenedEditor::close_all));
    py::module_::import("os").attr("register_at_fork")(py::arg("after_in_child") =
                                                           py::cpp_function(&ListenedEditor::forget_all));
}

}  // namespace kontur::python
