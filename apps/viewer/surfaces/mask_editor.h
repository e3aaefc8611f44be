// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "kontur/correct_mask.h"
#include "kontur/shape/mesh.h"
#include "viewer/model/stored_mask.h"
#include "viewer/surfaces/mask_neighbors.h"

namespace kontur::viewer {

/// What one step of the history changed.
struct MaskStep {
    std::int64_t voxels = 0;
    double more_ml = 0;  ///< less where negative
};

/// What becomes of a mask by its corrections.
struct MaskEdit {
    std::shared_ptr<const TriangleMesh> mesh;
    std::vector<std::uint8_t> origins;  ///< of the mesh's points, as origins_of
    CorrectReport report;
    std::shared_ptr<const MaskExchange> exchange;  ///< by its own corrections; null where borders are not shared
    std::int64_t followed = 0;                     ///< voxels in which it follows others, and not its own corrections
    std::optional<MaskStep> step;                  ///< the last one; nothing where it is not known what was there before
};

/// What is around a mask.
struct MaskSurroundings {
    std::optional<MaskExchanges> others{};     ///< that it follows; unset: borders are not shared
    std::shared_ptr<const StoredMask> kept{};  ///< what it stays, whatever is around; null: it is not locked
};

/// What a MaskEditor has to say about an edit.
struct MaskUpdate {
    enum class Kind {
        corrected,  ///< `result` is final, unless `asks_image`
        problem,    ///< the corrections cannot be understood; `result` is that of before
        progress,   ///< the fraction `done` is done
    };
    Kind kind = Kind::progress;
    std::uint64_t edit = 0;
    std::shared_ptr<const MaskEdit> result;
    bool asks_image = false;  ///< another one follows, in which the image takes part, unless there is another edit
    std::string problem;
    double done = 0;
};

/// What a LiveEditor is to contours, for corrections of a mask: on a thread of its own, the newest edit alone. An edit waits
/// until the surface of the one before is there, so that surfaces keep coming while a hand draws; asking the image is given
/// up for it at once.
class MaskEditor {
public:
    /// Called from the editor's thread; it must neither throw, nor call `wait`, nor destroy the editor.
    using Listener = std::function<void(const MaskUpdate&)>;

    MaskEditor(std::shared_ptr<const StoredMask> mask, Listener listener);
    /// Cancels what runs and waits for it.
    ~MaskEditor();
    MaskEditor(const MaskEditor&) = delete;
    MaskEditor& operator=(const MaskEditor&) = delete;

    /// The corrections are now these; the image takes part where there is one. `step` counts steps of the history, from 1:
    /// edits of one step, as drafts of it, are one change; 0 is what was there when the session began. Returns the number of
    /// the edit, counted from 1. Does not wait.
    std::uint64_t edit(Corrections corrections, const CorrectOptions& options, std::shared_ptr<const Image> image,
                       std::uint64_t step, MaskSurroundings around = {});
    /// Throws Error(invalid_input), naming a contour (counted from 1), for contours that can be no corrections of the mask.
    void check(const Corrections& corrections) const;
    /// Waits until the newest edit has its final result.
    void wait();

    const std::shared_ptr<const StoredMask>& mask() const { return mask_; }

private:
    struct Worker;
    std::shared_ptr<const StoredMask> mask_;
    std::unique_ptr<Worker> worker_;
};

}  // namespace kontur::viewer
