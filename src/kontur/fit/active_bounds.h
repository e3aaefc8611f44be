// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "kontur/base/work.h"
#include "kontur/drawing/bounds.h"
#include "kontur/fit/constraints.h"
#include "kontur/function/implicit_function.h"

namespace kontur {

/// The bounds, and at which limit of theirs f is held. Keeps a reference to them.
class ActiveBounds {
public:
    explicit ActiveBounds(const std::vector<Bound>& bounds);

    /// Holds f where it leaves its interval, and lets it go where it keeps it by itself; true if that changed anything.
    bool update(const ImplicitFunction& function, double tolerance_mm, const Work& work);

    bool holds_any() const;
    void append_to(std::vector<PointConstraint>& points) const;

private:
    enum class Held : std::uint8_t { no, at_least, at_most };

    const std::vector<Bound>& bounds_;
    std::vector<Vec3> positions_;
    std::vector<Held> held_;
};

}  // namespace kontur
