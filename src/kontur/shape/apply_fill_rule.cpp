// SPDX-License-Identifier: Apache-2.0
#include "kontur/shape/apply_fill_rule.h"

#include <algorithm>
#include <iterator>
#include <set>

#include "kontur/base/counted.h"
#include "kontur/shape/contour_nesting.h"
#include "kontur/shape/find_near_lines.h"
#include "kontur/shape/plane_evidence.h"
#include "kontur/shape/section.h"

namespace kontur {
namespace {

constexpr double kThin = 0.1;  // of what the outer line encloses: walls that make one look twice

constexpr auto kTakenOut = static_cast<std::size_t>(-1);

/// The set's lines as they lie in each other, those that are one counted once.
class Lines {
public:
    explicit Lines(ContourSet& set)
        : set_(set),
          tolerance_mm_(kSamePlane * diameter_mm(set)),
          nesting_(find_nesting(set.contours, tolerance_mm_)),
          pairs_(find_near_lines(set.contours, nesting_)),
          groups_(set.contours.size()) {
        for (const Contour& contour : set.contours) declared_.push_back(contour.hole);
    }

    FillChanges even_odd() {
        unite([&](const NearLines& pair) {
            return declared_[pair.contour] == declared_[pair.other] && (!pair.are_nested || declared_[pair.contour]);
        });
        do mark_holes();
        while (unite_those_that_others_see_through());
        FillChanges changes = what_remains();
        for (std::size_t c = 0; c < set_.contours.size(); ++c) {
            const bool is_inside = around(c).size() % 2 == 1;
            if (is_inside && !declared_[c]) ++changes.holes;
            if (!is_inside && declared_[c]) changes.stray_holes.push_back(c);
        }
        return changes;
    }

    FillChanges declared() {
        unite([&](const NearLines& pair) { return declared_[pair.contour] == declared_[pair.other]; });
        FillChanges changes = what_remains();
        std::vector<Contour> others;
        std::vector<std::size_t> number_of(set_.contours.size(), kTakenOut);
        for (std::size_t c = 0; c < set_.contours.size(); ++c) {
            int layers = 0;
            for (const std::size_t line : around(c)) layers += declared_[line] ? -1 : 1;
            if (layers <= 0 && declared_[c]) changes.stray_holes.push_back(c);
            if (layers > 0 && !declared_[c]) continue;
            number_of[c] = others.size();
            others.push_back(set_.contours[c]);
        }
        for (NearLines& pair : changes.near_lines) {
            pair.contour = number_of[pair.contour];
            pair.other = number_of[pair.other];
        }
        std::erase_if(changes.near_lines, [](const NearLines& pair) { return pair.contour == kTakenOut; });
        changes.removed = set_.contours.size() - others.size();
        set_.contours = std::move(others);
        return changes;
    }

private:
    /// The lines around a contour other than its own, each by the first contour of it.
    std::set<std::size_t> around(std::size_t contour) const {
        std::set<std::size_t> lines;
        for (const std::size_t c : nesting_.enclosing[contour])
            if (groups_.of(c) != groups_.of(contour)) lines.insert(groups_.of(c));
        return lines;
    }

    template <class Which>
    bool unite(const Which& which) {
        bool any = false;
        for (NearLines& pair : pairs_) {
            if (pair.is_one || !which(pair)) continue;
            pair.is_one = any = true;
        }
        groups_ = groups_of(pairs_, set_.contours.size());
        return any;
    }

    void mark_holes() {
        for (std::size_t c = 0; c < set_.contours.size(); ++c)
            set_.contours[c].hole = declared_[c] || around(c).size() % 2 == 1;
        // Both are what one of them is said to be.
        for (const NearLines& pair : pairs_)
            if (pair.is_one && (declared_[pair.contour] || declared_[pair.other]))
                set_.contours[pair.contour].hole = set_.contours[pair.other].hole = true;
    }

    /// Of lines in each other those inside of which other planes show what their own shows between them.
    bool unite_those_that_others_see_through() {
        if (std::ranges::all_of(pairs_, [](const NearLines& pair) { return pair.is_one; })) return false;
        const std::vector<Section> sections = sections_of(set_, tolerance_mm_);
        const auto section_with = [&](std::size_t contour) {
            const auto own = std::ranges::find_if(sections, [&](const Section& section) {
                return std::ranges::find(section.contours, contour) != section.contours.end();
            });
            return static_cast<std::size_t>(own - sections.begin());
        };
        const auto is_open = [&](const NearLines& pair) { return pair.are_nested && !declared_[pair.contour]; };
        const bool any = unite([&](const NearLines& pair) {
            const Contour& inner = set_.contours[pair.contour];
            return is_open(pair) && evidence_inside(inner, sections, section_with(pair.contour)) ==
                                        (inner.hole ? PlaneEvidence::object : PlaneEvidence::no_object);
        });
        if (any) return true;
        std::vector<bool> doubtful(sections.size(), false);
        for (const NearLines& pair : pairs_)
            if (is_open(pair) && !pair.is_one && pair.share < kThin) doubtful[section_with(pair.contour)] = true;
        return unite([&](const NearLines& pair) {
            const Contour& inner = set_.contours[pair.contour];
            return is_open(pair) && inner.hole && pair.share < kThin &&
                   evidence_beyond(inner, sections, section_with(pair.contour), doubtful, pair.apart_mm) ==
                       PlaneEvidence::object;
        });
    }

    /// What is left to tell of lines that are near to each other or cross.
    FillChanges what_remains() const {
        FillChanges changes;
        std::ranges::copy_if(pairs_, std::back_inserter(changes.near_lines), [&](const NearLines& pair) {
            const bool is_doubtful = pair.are_nested && pair.share < kThin && !declared_[pair.contour];
            return pair.is_one || (is_doubtful && set_.contours[pair.contour].hole);
        });
        for (const auto& [a, b] : nesting_.crossings)
            if (groups_.of(a) != groups_.of(b)) changes.crossings.emplace_back(a, b);
        return changes;
    }

    ContourSet& set_;
    double tolerance_mm_;
    Nesting nesting_;
    std::vector<NearLines> pairs_;
    Groups groups_;
    std::vector<bool> declared_;
};

}  // namespace

std::string_view name(FillRule rule) noexcept { return rule == FillRule::even_odd ? "even-odd" : "declared"; }

std::string overlap_sentence(const std::vector<std::pair<std::size_t, std::size_t>>& pairs) {
    const auto& [a, b] = pairs.front();
    const std::string others = pairs.size() == 1 ? "" : " (and " + counted(pairs.size() - 1, "more such pair") + ")";
    return "contours " + std::to_string(a + 1) + " and " + std::to_string(b + 1) + " overlap in part" + others +
           "; what any of them encloses is filled";
}

FillChanges apply_fill_rule(ContourSet& set, FillRule rule) {
    Lines lines(set);
    return rule == FillRule::even_odd ? lines.even_odd() : lines.declared();
}

}  // namespace kontur
