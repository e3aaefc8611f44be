// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "kontur/editor.h"

namespace kontur {

/// What a LiveEditor has to say about an edit.
struct EditorUpdate {
    enum class Kind {
        preview,   ///< `surface` is a preview; the refined one follows unless there is another edit
        refined,   ///< `surface` is final for this edit
        problem,   ///< the contours cannot be fitted; `problem` says why
        progress,  ///< `stage` has done the fraction `done`
    };
    Kind kind = Kind::progress;
    std::uint64_t edit = 0;  ///< which edit this answers
    EditedSurface surface;
    std::string problem;
    std::string_view stage;
    double done = 0;
};

/// An Editor on a thread of its own: takes the newest contours, previews them and then refines. An edit cancels a running
/// refinement at once. A running preview is finished first, so that surfaces keep coming while a hand drags a contour;
/// edits that arrive meanwhile are answered by the newest of them alone.
class LiveEditor {
public:
    /// Called from the editor's thread, one update at a time; it must neither throw, nor call `wait`, nor destroy the
    /// editor.
    using Listener = std::function<void(const EditorUpdate&)>;

    /// Likewise, when a preview can be cut by planes but has no mesh yet.
    using BandListener = std::function<void(std::uint64_t edit, const SurfaceBand& band)>;

    /// Works on so many threads (0: the machine's). Throws as Editor does.
    LiveEditor(const EditorOptions& options, Listener listener, BandListener ahead = {}, int threads = 0);
    /// Cancels what runs and waits for it.
    ~LiveEditor();

    /// The contours are now these; returns the number of the edit, counted from 1. Does not wait.
    std::uint64_t edit(ContourSet contours);
    /// Waits until the newest edit is refined or has turned out to be a problem.
    void wait();

private:
    struct Worker;
    std::unique_ptr<Worker> worker_;
};

}  // namespace kontur
