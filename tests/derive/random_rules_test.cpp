// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <fmt/format.h>

#include <map>

#include "kontur/derive/derive.h"
#include "kontur/derive/rule.h"
#include "solid_levels.h"
#include "support/random.h"

// Rules against a plain program on voxels: a margin tries each pair of voxels. It knows surfaces to a voxel only, so that a
// margin's border is in doubt by that much; where a rule decides nothing beside a border in doubt, both agree.

namespace kontur {
namespace {

/// What is surely inside, and what may be.
struct Bounds {
    std::vector<std::uint8_t> surely, maybe;
};

class VoxelProgram {
public:
    VoxelProgram(const Grid& grid, std::map<std::string, Bounds> known) : grid_(grid), known_(std::move(known)) {}

    Bounds run(const Expression& e) const {
        if (e.operation == Operation::name) return known_.at(e.name);
        const Bounds a = run(e.operands[0]);
        if (e.operation == Operation::margin) {
            // Between the centres of voxels at the border there is up to their diagonal.
            const double by = e.lengths.left, doubt = norm(grid_.spacing_mm());
            if (e.side == MarginSide::outwards) return {grown(a.surely, by - doubt), grown(a.maybe, by + doubt)};
            return {turned(grown(turned(a.surely), by + doubt)), turned(grown(turned(a.maybe), by - doubt))};
        }
        const Bounds b = run(e.operands[1]);
        Bounds made = a;
        for (std::size_t n = 0; n < made.surely.size(); ++n) switch (e.operation) {
                case Operation::join:
                    made.surely[n] = a.surely[n] | b.surely[n], made.maybe[n] = a.maybe[n] | b.maybe[n];
                    break;
                case Operation::meet:
                    made.surely[n] = a.surely[n] & b.surely[n], made.maybe[n] = a.maybe[n] & b.maybe[n];
                    break;
                default:
                    made.surely[n] = a.surely[n] & !b.maybe[n], made.maybe[n] = a.maybe[n] & !b.surely[n];
            }
        return made;
    }

private:
    static std::vector<std::uint8_t> turned(std::vector<std::uint8_t> values) {
        for (std::uint8_t& v : values) v = !v;
        return values;
    }
    /// Below 0 nothing is surely inside but what was deeper than that.
    std::vector<std::uint8_t> grown(const std::vector<std::uint8_t>& values, double by) const {
        if (by < 0) return turned(grown(turned(values), -by));
        std::vector<std::uint8_t> made(values.size());
        const Vec3 spacing = grid_.spacing_mm();
        const auto reach = [&](int axis) { return static_cast<std::int64_t>(by / spacing[axis]); };
        for (std::int64_t k = 0; k < grid_.size.k; ++k)
            for (std::int64_t j = 0; j < grid_.size.j; ++j)
                for (std::int64_t i = 0; i < grid_.size.i; ++i) {
                    if (!values[grid_.offset(i, j, k)]) continue;
                    for (std::int64_t c = std::max<std::int64_t>(0, k - reach(2));
                         c <= std::min(grid_.size.k - 1, k + reach(2)); ++c)
                        for (std::int64_t b = std::max<std::int64_t>(0, j - reach(1));
                             b <= std::min(grid_.size.j - 1, j + reach(1)); ++b)
                            for (std::int64_t a = std::max<std::int64_t>(0, i - reach(0));
                                 a <= std::min(grid_.size.i - 1, i + reach(0)); ++a)
                                if (distance(grid_.center_mm(i, j, k), grid_.center_mm(a, b, c)) <= by)
                                    made[grid_.offset(a, b, c)] = 1;
                }
        return made;
    }

    const Grid& grid_;
    std::map<std::string, Bounds> known_;
};

std::string random_expression(std::mt19937& random, int depth) {
    const auto pick = [&](int count) { return std::uniform_int_distribution<int>(0, count - 1)(random); };
    const auto deeper = [&] { return "(" + random_expression(random, depth - 1) + ")"; };
    if (depth == 0) return std::string(1, static_cast<char>('A' + pick(3)));
    const int length = 2 + pick(4);
    switch (pick(5)) {
        case 0:
            return deeper() + " | " + deeper();
        case 1:
            return deeper() + " & " + deeper();
        case 2:
            return deeper() + " - " + deeper();
        case 3:
            return fmt::format("{} + {} mm", deeper(), length);
        default:
            return fmt::format("{} - {} mm", deeper(), length);
    }
}

TEST(RandomRules, AgreeWithAPlainProgramOnVoxels) {
    std::mt19937 random = test::random_of_this_test();
    Grid grid{{36, 34, 24}, {}};
    grid.index_to_mm.set_column(2, {0, 0, 1.5});
    std::uniform_real_distribution<double> place(11, 23), radius(3, 8);
    std::int64_t decided = 0, all = 0;
    for (int round = 0; round < 300; ++round) {
        std::vector<NamedStructure> structures;
        std::map<std::string, Bounds> known;
        for (const char* name : {"A", "B", "C"}) {
            const Vec3 center{place(random), place(random), place(random)};
            const double size = radius(random);
            const test::Solid solid{name, [=](const Vec3& p) { return size - distance(p, center); }, {}};
            structures.push_back({name, test::mask_of(solid, grid), {}});
            known[name] = {structures.back().mask.values, structures.back().mask.values};
        }
        const std::string rule = "X = " + random_expression(random, 1 + round % 3);
        const Mask found = derive(std::vector{rule}, structures, {}, {.threads = 2}).front().mask;
        const Bounds bounds = VoxelProgram(grid, known).run(read_rule(rule).expression);
        for (std::size_t n = 0; n < found.values.size(); ++n) {
            ASSERT_GE(found.values[n], bounds.surely[n]) << rule << " at " << n;
            ASSERT_LE(found.values[n], bounds.maybe[n]) << rule << " at " << n;
            if (bounds.maybe[n]) ++all, decided += bounds.surely[n];
        }
    }
    // The program is no net of holes: a good part of what may be inside surely is.
    EXPECT_GT(static_cast<double>(decided), 0.2 * static_cast<double>(all));
}

}  // namespace
}  // namespace kontur
