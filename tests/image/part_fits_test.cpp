// SPDX-License-Identifier: Apache-2.0
#include "kontur/image/part_fits.h"

#include <gtest/gtest.h>

#include <atomic>

#include "kontur/base/error.h"
#include "support/lobed_body.h"

namespace kontur {
namespace {

using namespace test;

/// A question to the image with fits kept, and how many parts had to be fitted for it.
class Questions {
public:
    std::pair<ImageFit, int> ask(const ContourSet& contours, int threads = 2) {
        const Work work{.threads = threads};
        const Drawing drawing = read_drawing(contours, FillRule::even_odd);
        const StageOptions stages = stage_options({}, drawing.diameter_mm());
        const PreparedContours prepared = prepare(drawing, stages.prepare, work);
        const FittedFunction fitted = fit(prepared, stages.fit, work);
        std::atomic<int> fits = 0;
        const auto fit_part = [&](const ContourSet& part) {
            ++fits;
            return fit_coarsely(part, stages, {.threads = 1});
        };
        part_fits_.begin_question();
        ImageFit with_image = follow_image(
            {drawing, prepared, fitted}, image(),
            [&](const ContourSet& part) { return part_fits_.of(part, drawing.diameter_mm(), fit_part); },
            {.fit = stages.fit}, work);
        return {std::move(with_image), fits};
    }

    static const Image& image() {
        static const Image made = image_of(cube_grid(2), body_look, 8);
        return made;
    }

private:
    PartFits part_fits_;
};

/// Drawn a little smaller, so that the drawing's diameter stays.
ContourSet with_smaller(ContourSet contours, std::size_t which) {
    Contour& contour = contours.contours[which];
    for (Vec3& p : contour.points) p = contour.plane.origin + 0.97 * (p - contour.plane.origin);
    return contours;
}

bool same(const ImageFit& a, const ImageFit& b) {
    return std::ranges::equal(a.fitted.function.weights(), b.fitted.function.weights());
}

TEST(PartFits, NoPartOfADrawingIsFittedTwice) {
    const ContourSet drawn = drawn_on(orthogonal_planes()), edited = with_smaller(drawn, 1), again = with_smaller(edited, 1);
    Questions questions;
    const auto [first, fits] = questions.ask(drawn);
    EXPECT_EQ(fits, 4) << "once for each plane left out";
    EXPECT_EQ(questions.ask(drawn).second, 0) << "nothing has changed";
    EXPECT_EQ(questions.ask(edited).second, 3) << "all but the part without the edited plane";
    const auto [twice_edited, more] = questions.ask(again);
    EXPECT_EQ(more, 3);
    const auto [undone, none] = questions.ask(edited);
    EXPECT_EQ(none, 0) << "undone";
    EXPECT_TRUE(same(twice_edited, Questions().ask(again, 1).first)) << "the same bytes as without anything kept";
    EXPECT_TRUE(same(undone, Questions().ask(edited, 1).first));
    EXPECT_TRUE(same(first, questions.ask(drawn).first));
}

TEST(PartFits, TellsPartsApartByAllThatAFitMayDependOn) {
    ContourSet part = drawn_on(stacked_planes());
    PartFits part_fits;
    int fits = 0;
    const auto fit = [&](const ContourSet&) {
        ++fits;
        return ImplicitFunction();
    };
    const auto is_new = [&](const ContourSet& other, double diameter_mm = 60) {
        const int before = fits;
        part_fits.of(other, diameter_mm, fit);
        return fits > before;
    };
    EXPECT_TRUE(is_new(part));
    EXPECT_FALSE(is_new(part));
    EXPECT_TRUE(is_new(part, 60.001));
    const auto changed = [&](const auto& change) {
        ContourSet other = part;
        change(other);
        return other;
    };
    EXPECT_TRUE(is_new(changed([](ContourSet& s) { s.contours[3].points[7].x += 1e-9; })));
    EXPECT_TRUE(is_new(changed([](ContourSet& s) { s.contours[3].weight = 2; })));
    EXPECT_TRUE(is_new(changed([](ContourSet& s) { s.contours[3].hole = true; })));
    EXPECT_TRUE(is_new(changed([](ContourSet& s) { s.contours[3].end = ContourEnd::flat; })));
    EXPECT_TRUE(is_new(changed([](ContourSet& s) { s.contours[3].closed = false; })));
    EXPECT_TRUE(is_new(changed([](ContourSet& s) { s.contours[3].inside = Hand::left; })));
    EXPECT_TRUE(is_new(changed([](ContourSet& s) { s.contours[3].inside = Hand::right; })));
    EXPECT_TRUE(is_new(changed([](ContourSet& s) { s.contours[3].plane.origin.z += 1e-9; })));
    EXPECT_TRUE(is_new(changed([](ContourSet& s) { s.contours.pop_back(); })));
    EXPECT_TRUE(is_new(changed([](ContourSet& s) { s.interior.push_back({1, 2, 3}); })));
    EXPECT_TRUE(is_new(changed([](ContourSet& s) { s.exterior.push_back({1, 2, 3}); })));
    EXPECT_TRUE(is_new(changed([](ContourSet& s) { s.surface.push_back({{1, 2, 3}}); })));
    EXPECT_TRUE(is_new(changed([](ContourSet& s) { s.surface.push_back({{1, 2, 3}, Vec3{0, 0, 1}}); })));
    EXPECT_TRUE(is_new(changed([](ContourSet& s) { s.empty_planes.push_back(make_plane({0, 0, 40}, {0, 0, 1})); })));
    EXPECT_FALSE(is_new(changed([](ContourSet& s) { s.name = "liver"; })));
    EXPECT_FALSE(is_new(part));
}

TEST(PartFits, ForgetsWhatIsNoLongerAskedFor) {
    PartFits fits;
    const auto fit = [](const ContourSet&) { return ImplicitFunction(); };
    const ContourSet often = drawn_on(stacked_planes()), once = drawn_on(orthogonal_planes());
    fits.of(once, 60, fit);
    for (int question = 0; question < 3 * PartFits::kQuestions; ++question) {
        fits.begin_question();
        fits.of(often, 60, fit);
    }
    EXPECT_EQ(fits.size(), 1u);
}

TEST(PartFits, KeepsNothingOfAFitThatFailed) {
    PartFits fits;
    const auto fails = [](const ContourSet&) -> ImplicitFunction { throw Error(ErrorKind::cancelled, "stopped"); };
    EXPECT_THROW(fits.of({}, 60, fails), Error);
    EXPECT_EQ(fits.size(), 0u);
}

}  // namespace
}  // namespace kontur
