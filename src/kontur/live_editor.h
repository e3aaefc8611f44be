// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "kontur/editor.h"

namespace kontur {

class SurfaceBand;

/// What a LiveEditor has to say about an edit.
struct EditorUpdate {
    enum class Kind {
        preview,     ///< `surface` is a preview; the finished one follows unless there is another edit
        finished,    ///< `surface` is what the contours make: final for this edit, unless `asks_image`
        with_image,  ///< the image was asked, and `surface` is final: the finished one, where `surface.image` was not used
        problem,     ///< the contours cannot be fitted; `problem` says why
        progress,    ///< `stage` has done the fraction `done`
    };
    Kind kind = Kind::progress;
    std::uint64_t edit = 0;  ///< which edit this answers
    EditedSurface surface;
    /// Of a finished one: `with_image` follows, unless there is another edit. Where the image has been asked before, the
    /// first such one follows what it said then (`surface.earlier_places`), and the second is what the contours make alone.
    bool asks_image = false;
    std::string problem;
    std::string_view stage;
    double done = 0;
};

/// An Editor on a thread of its own: takes the newest contours, previews them, finishes, and asks the image, if there is
/// one. An edit cancels a running finishing, and the question to the image, at once. A running preview is finished first, so
/// that surfaces keep coming while a hand drags a contour; edits that arrive meanwhile are answered by the newest of them
/// alone. An edit that changes nothing, as when a hand lets go, does not begin anything anew: what is being computed answers
/// it, too. One that makes the drawing what it was for one of the last `kKeptAnswers` edits that have their final surface,
/// as when it is undone, is answered by that surface at once, without a preview.
class LiveEditor {
public:
    static constexpr std::size_t kKeptAnswers = 3;  ///< each some 7 MB of an organ

    /// Called from the editor's thread, one update at a time; it must neither throw, nor call `wait`, nor destroy the
    /// editor.
    using Listener = std::function<void(const EditorUpdate&)>;

    /// Likewise, when a preview can be cut by planes but has no mesh yet.
    using BandListener = std::function<void(std::uint64_t edit, const SurfaceBand& band)>;

    /// Works on so many threads (0: the machine's). `rest`: so long after a preview finishing begins, so that whoever shows
    /// the preview has the processors to himself. Throws as Editor does.
    LiveEditor(const EditorOptions& options, Listener listener, BandListener ahead = {}, int threads = 0,
               std::chrono::milliseconds rest = {});
    /// Cancels what runs and waits for it.
    ~LiveEditor();

    /// The contours are now these, drawn on this image, if any is to be asked; it is not copied. Returns the number of the
    /// edit, counted from 1. Does not wait.
    std::uint64_t edit(ContourSet contours, std::shared_ptr<const Image> image = nullptr);
    /// Waits until the newest edit has its final surface or has turned out to be a problem.
    void wait();

private:
    struct Worker;
    std::unique_ptr<Worker> worker_;
};

}  // namespace kontur
