// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace kontur {

/// How a value that is known at some moments runs between them. The rate of change is piecewise linear: around each moment
/// it bends within a quarter to a half of the shorter interval beside it, elsewhere it is constant. The value never leaves
/// the interval of the two moments around it (as Fritsch & Carlson 1980 ask of a cubic), and its rate has no steps, over the
/// seam of a cycle neither. Before the first and after the last moment of what does not repeat, it stays. The unit of time
/// does not matter.
class TimeCourse {
public:
    /// `times` rise; of a cycle they span less than it. Throws Error(invalid_input) for none, times that are not finite or
    /// do not rise, and a cycle that is not longer than they span.
    explicit TimeCourse(std::vector<double> times, std::optional<double> cycle = {});

    const std::vector<double>& times() const { return times_; }
    const std::optional<double>& cycle() const { return cycle_; }

    /// A time among the moments, for any number of values.
    struct Place {
        std::size_t before = 0, after = 0;  ///< the moments around it; the same one where nothing moves
        double since = 0;                   ///< the moment before, in the times' unit
    };
    Place place_of(double time) const;
    /// How far it lies from the moment before to that after, 0 to 1.
    double part_of(const Place& place) const {
        return place.before == place.after ? 0 : place.since / lengths_[place.before];
    }

    /// How long the interval around it is, of the cycle, or of twice as long as the moments span.
    double share_of_cycle(const Place& place) const {
        if (place.before == place.after) return 0;
        return lengths_[place.before] / cycle_.value_or(2 * (times_.back() - times_.front()));
    }

    /// The value at a place; `values` are those at the moments.
    double value(const Place& place, std::span<const double> values) const;

private:
    struct Bend {
        double rate, width;  ///< at a moment, and how long before and after it the rate changes
    };
    Bend bend(std::size_t moment, std::span<const double> values) const;
    std::size_t next(std::size_t moment) const { return moment + 1 < times_.size() ? moment + 1 : 0; }
    std::size_t previous(std::size_t moment) const { return (moment > 0 ? moment : times_.size()) - 1; }

    std::vector<double> times_;
    std::optional<double> cycle_;
    std::vector<double> lengths_;  ///< of the interval behind each moment; the last one's is the cycle's seam
    std::vector<double> rates_;    ///< row by row: from values to the rates of the cubic spline through them
};

}  // namespace kontur
