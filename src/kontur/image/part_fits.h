// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <mutex>
#include <string>

#include "kontur/image/follow_image.h"

namespace kontur {

/// Fits to parts of drawings, kept from question to question, so that while a drawing is edited no part is fitted twice: not
/// the one without the plane that is edited, and none at all when an edit is undone. Safe to use from several threads.
class PartFits {
public:
    /// What `fit` makes of the part, or made of it before. What else `fit` depends on has to be told by `diameter_mm`, of
    /// the whole drawing. Throws as `fit` does; nothing is kept then.
    ImplicitFunction of(const ContourSet& part, double diameter_mm, const FitContours& fit);

    /// Call at the start of each: what none of the last `kQuestions` needed is forgotten.
    void begin_question();
    static constexpr std::int64_t kQuestions = 8;

    std::size_t size() const;

private:
    struct PartFit {
        ImplicitFunction function;
        std::int64_t question;  ///< the last that needed it
    };

    mutable std::mutex mutex_;  // guards all below
    std::map<std::string, PartFit> fits_;
    std::int64_t question_ = 0;
};

}  // namespace kontur
