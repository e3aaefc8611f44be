// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <mutex>
#include <thread>

#include "kontur/base/error.h"
#include "kontur/live_editor.h"
#include "kontur/segment.h"
#include "segment/same_function.h"
#include "support/expect_error.h"
#include "support/lobed_body.h"
#include "support/random.h"

// Editors that ask the image.

namespace kontur {
namespace {

using test::expect_same_function;

using namespace test;
using Kind = EditorUpdate::Kind;

std::shared_ptr<const Image> helpful_image() {
    static const auto image = std::make_shared<const Image>(image_of(cube_grid(2), body_look, 8));
    return image;
}

std::shared_ptr<const Image> noise_alone() {
    static const auto image = std::make_shared<const Image>(image_of(
        cube_grid(3), [](const Vec3&) { return 50.0; }, 20));
    return image;
}

/// All that a live editor says but how far it is.
class Listened {
public:
    explicit Listened(const EditorOptions& options = {})
        : editor(options, [this](const EditorUpdate& update) { hear(update); }) {}

    std::vector<EditorUpdate> updates() {
        const std::lock_guard lock(mutex_);
        return updates_;
    }
    std::vector<Kind> kinds() {
        std::vector<Kind> kinds;
        for (const EditorUpdate& update : updates()) kinds.push_back(update.kind);
        return kinds;
    }

    /// Called on the editor's thread at each update, also of how far it is.
    std::function<void(const EditorUpdate&)> at_update;

private:
    void hear(const EditorUpdate& update) {
        if (at_update) at_update(update);
        const std::lock_guard lock(mutex_);
        if (update.kind != Kind::progress) updates_.push_back(update);
    }

    std::mutex mutex_;
    std::vector<EditorUpdate> updates_;

public:
    LiveEditor editor;  ///< last: its thread uses all above
};

TEST(Editor, FinishesWithAnImageToTheFunctionOfSegment) {
    const ContourSet contours = drawn_on(orthogonal_planes());
    const Image& image = *helpful_image();
    EditedSurface alone;
    const EditedSurface finished = Editor().finish(contours, &image, {}, [&](const EditedSurface& told) { alone = told; });
    EXPECT_EQ(finished.image.verdict, ImageVerdict::used);
    EXPECT_TRUE(finished.finished);
    expect_same_function(finished.function, segment(contours, image.grid, &image).function);
    expect_same_function(alone.function, segment(contours, image.grid).function);
    EXPECT_NE(alone.mesh.points, finished.mesh.points);
    EXPECT_EQ(alone.image.verdict, ImageVerdict::none);
    EXPECT_LT(finished.residual.rms_mm, 0.3);
}

TEST(Editor, DoesNotAskTheImageWhereItIsToldNotTo) {
    const ContourSet contours = drawn_on(orthogonal_planes());
    bool is_told = false;
    const auto tell = [&](const EditedSurface&) { is_told = true; };
    Editor off({.segment = {.use_image = UseImage::off}});
    const EditedSurface plain = off.finish(contours, helpful_image().get(), {}, tell);
    EXPECT_EQ(plain.image.verdict, ImageVerdict::none);
    expect_same_function(plain.function, Editor().finish(contours).function);
    EXPECT_TRUE(Editor().finish({}, helpful_image().get(), {}, tell).mesh.points.empty());
    EXPECT_FALSE(is_told) << "there is nothing to wait for";
}

/// One contour drawn smaller, the others as they were.
ContourSet edited(ContourSet contours) {
    Contour& contour = contours.contours[1];
    for (Vec3& p : contour.points) p = contour.plane.origin + 0.97 * (p - contour.plane.origin);
    return contours;
}

TEST(Editor, PreviewsFollowWhatTheImageSaidUntilItIsAskedAgain) {
    const ContourSet contours = drawn_on(orthogonal_planes());
    Editor editor, fresh;
    editor.preview(contours);
    fresh.preview(contours);
    editor.finish(contours, helpful_image().get());
    const EditedSurface with = editor.preview(edited(contours)), without = fresh.preview(edited(contours));
    EXPECT_EQ(without.earlier_places, 0u);
    EXPECT_GT(with.earlier_places, 50u);
    EXPECT_EQ(with.solves, 1);
    EXPECT_LT(surface_error(with.function, contours), 0.6 * surface_error(without.function, contours));
    for (const Contour& contour : edited(contours).contours)
        for (const Vec3& p : contour.points) EXPECT_NEAR(with.function.value(p), without.function.value(p), 0.5);
    const Image& image = *helpful_image();
    expect_same_function(editor.finish(edited(contours), &image).function,
                         segment(edited(contours), image.grid, &image).function);
    editor.forget_image();
    const EditedSurface after = editor.preview(edited(contours)), alone = fresh.preview(edited(contours));
    EXPECT_EQ(after.earlier_places, 0u);
    for (const Vec3& p : alone.mesh.points) EXPECT_NEAR(after.function.value(p), alone.function.value(p), 0.05);
}

TEST(Editor, PreviewsDoNotFollowAnImageThatIsNoLongerAsked) {
    const ContourSet contours = drawn_on(orthogonal_planes());
    Editor editor;
    editor.preview(contours);
    editor.finish(contours, helpful_image().get());
    EXPECT_GT(editor.preview(contours).earlier_places, 50u);
    editor.finish(contours, noise_alone().get());
    EXPECT_EQ(editor.preview(contours).earlier_places, 0u);
    editor.finish(contours, helpful_image().get());
    editor.finish(contours, nullptr);
    EXPECT_EQ(editor.preview(contours).earlier_places, 0u);
}

TEST(LiveEditor, PreviewsWithAnotherImageDoNotFollowTheOneBefore) {
    const ContourSet contours = drawn_on(orthogonal_planes());
    Listened live;
    const auto answer = [&](const ContourSet& set, const std::shared_ptr<const Image>& image) {
        live.editor.edit(set, image);
        live.editor.wait();
    };
    answer(contours, helpful_image());
    answer(edited(contours), helpful_image());
    answer(contours, noise_alone());
    std::vector<bool> follows;
    for (const EditorUpdate& update : live.updates())
        if (update.kind == Kind::preview) follows.push_back(update.surface.earlier_places > 0);
    EXPECT_EQ(follows, (std::vector{false, true, false}));
}

TEST(LiveEditor, AsksTheImageWhenTheSurfaceIsFinished) {
    const ContourSet contours = drawn_on(orthogonal_planes());
    Listened live;
    live.editor.edit(contours, helpful_image());
    live.editor.wait();
    const std::vector<EditorUpdate> updates = live.updates();
    ASSERT_EQ(live.kinds(), (std::vector{Kind::preview, Kind::finished, Kind::with_image}));
    EXPECT_FALSE(updates[0].asks_image);
    EXPECT_TRUE(updates[1].asks_image);
    EXPECT_FALSE(updates[2].asks_image);
    EXPECT_EQ(updates[2].surface.image.verdict, ImageVerdict::used);
    const Image& image = *helpful_image();
    const Segmentation made = segment(contours, image.grid, &image);
    expect_same_function(updates[1].surface.function, segment(contours, image.grid).function);
    expect_same_function(updates[2].surface.function, made.function);
    EXPECT_EQ(sentence(updates[2].surface.image), sentence(made.report.image));
}

TEST(LiveEditor, FollowsWhatTheImageSaidWhileItIsAskedAgain) {
    const ContourSet contours = drawn_on(orthogonal_planes());
    Listened live;
    for (const ContourSet& set : {contours, edited(contours)}) {
        live.editor.edit(set, helpful_image());
        live.editor.wait();
    }
    std::vector<EditorUpdate> updates = live.updates();
    ASSERT_EQ(live.kinds(), (std::vector{Kind::preview, Kind::finished, Kind::with_image, Kind::preview, Kind::finished,
                                         Kind::finished, Kind::with_image}));
    const EditorUpdate &followed = updates[4], &alone = updates[5], &made = updates[6];
    EXPECT_TRUE(followed.asks_image);
    EXPECT_GT(followed.surface.earlier_places, 50u);
    EXPECT_TRUE(alone.asks_image);
    EXPECT_EQ(alone.surface.earlier_places, 0u);
    EXPECT_LT(surface_error(followed.surface.function, contours), 0.6 * surface_error(alone.surface.function, contours));
    EXPECT_LT(followed.surface.residual.max_mm, 0.5);
    const Image& image = *helpful_image();
    expect_same_function(alone.surface.function, segment(edited(contours), image.grid).function);
    expect_same_function(made.surface.function, segment(edited(contours), image.grid, &image).function);
}

/// The same lines with so many points for each one, on flat arcs: those of a straight edge would say nothing.
ContourSet finer(ContourSet contours, int times) {
    for (Contour& contour : contours.contours) {
        std::vector<Vec3> points;
        for (std::size_t n = 0; n < contour.points.size(); ++n) {
            const Vec3 from = contour.points[n], to = contour.points[(n + 1) % contour.points.size()];
            for (int part = 0; part < times; ++part) {
                const double along = double(part) / times;
                points.push_back(from + along * (to - from) +
                                 (0.02 * along * (1 - along) + (part % 2 == 0 ? 0.0 : 0.01)) *
                                     cross(contour.plane.normal, to - from));
            }
        }
        contour.points = std::move(points);
    }
    return contours;
}

TEST(Editor, FollowsWhatTheImageSaidByThreeThousandOfManyPoints) {
    const ContourSet contours = finer(drawn_on(orthogonal_planes()), 11);
    ASSERT_EQ(point_count(contours), 3960u);
    Editor editor;
    const auto image = helpful_image();
    editor.finish(contours, image.get());
    std::vector<std::size_t> centres;
    editor.finish(edited(contours), image.get(), {}, [&](const EditedSurface& told) {
        EXPECT_LT(told.residual.rms_mm, 0.3);
        centres.push_back(told.function.centers().size() - told.earlier_places);
    });
    ASSERT_EQ(centres.size(), 2u);
    EXPECT_LT(centres[0] + 960, centres[1]) << "960 points fewer, and what stands beside them";
}

TEST(LiveEditor, AnUndoneEditNeedsNeitherTheImageNorASolve) {
    const ContourSet contours = drawn_on(orthogonal_planes());
    Listened live;
    const auto answers = [&](const ContourSet& set, const std::shared_ptr<const Image>& image) {
        const std::size_t before = live.updates().size();
        live.editor.edit(set, image);
        live.editor.wait();
        const std::vector<EditorUpdate> all = live.updates();
        return std::vector(all.begin() + static_cast<std::ptrdiff_t>(before), all.end());
    };
    const std::vector<EditorUpdate> first = answers(contours, helpful_image());
    ASSERT_EQ(first.size(), 3u);
    answers(edited(contours), helpful_image());
    const std::vector<EditorUpdate> undone = answers(contours, helpful_image());
    ASSERT_EQ(undone.size(), 2u);
    for (std::size_t n = 0; n < 2; ++n) {
        EXPECT_EQ(undone[n].kind, first[n + 1].kind);
        EXPECT_EQ(undone[n].asks_image, first[n + 1].asks_image);
        EXPECT_EQ(undone[n].surface.function.weights().data(), first[n + 1].surface.function.weights().data());
        EXPECT_EQ(undone[n].surface.mesh.points, first[n + 1].surface.mesh.points);
    }
    EXPECT_EQ(sentence(undone[1].surface.image), sentence(first[2].surface.image));
    EXPECT_GT(answers(edited(edited(contours)), helpful_image()).front().surface.earlier_places, 50u);
    EXPECT_EQ(answers(contours, nullptr).front().kind, Kind::preview) << "no image is another question";
}

TEST(LiveEditor, KeepsTheFinishedSurfaceWhereTheImageDoesNotHelp) {
    const ContourSet contours = drawn_on(orthogonal_planes());
    Listened live;
    live.editor.edit(contours, noise_alone());
    live.editor.wait();
    const std::vector<EditorUpdate> updates = live.updates();
    ASSERT_EQ(live.kinds(), (std::vector{Kind::preview, Kind::finished, Kind::with_image}));
    EXPECT_EQ(updates[2].surface.image.verdict, ImageVerdict::no_help);
    expect_same_function(updates[2].surface.function, updates[1].surface.function);
    EXPECT_EQ(updates[2].surface.mesh.points, updates[1].surface.mesh.points);
    live.editor.edit(contours);
    live.editor.wait();
    ASSERT_EQ(live.updates().size(), 5u) << "without an image nothing follows the finished surface";
    EXPECT_EQ(live.updates().back().kind, Kind::finished);
    EXPECT_FALSE(live.updates().back().asks_image);
}

TEST(LiveEditor, AnEditEndsTheQuestionToTheImage) {
    const ContourSet contours = drawn_on(orthogonal_planes());
    Listened live;
    live.at_update = [&](const EditorUpdate& update) {
        const bool is_asking = update.kind == Kind::progress && update.stage == "ask the image";
        if (update.edit == 1 && is_asking) live.editor.edit(edited(contours), helpful_image());
    };
    live.editor.edit(contours, helpful_image());
    while (live.updates().empty() || live.updates().back().edit < 2) live.editor.wait();
    EXPECT_EQ(live.kinds(), (std::vector{Kind::preview, Kind::finished, Kind::preview, Kind::finished, Kind::with_image}));
}

TEST(LiveEditor, TellsWhatIsWrongWithTheImage) {
    auto broken = std::make_shared<Image>(*noise_alone());
    broken->grid.size.i += 1;
    Listened live;
    live.editor.edit(drawn_on(orthogonal_planes()), broken);
    live.editor.wait();
    EXPECT_EQ(live.kinds(), (std::vector{Kind::preview, Kind::finished, Kind::problem}));
    EXPECT_NE(live.updates().back().problem.find("the image has "), std::string::npos) << live.updates().back().problem;
}

/// Time counts only with KONTUR_TIMED=1, as in cancel_test.cpp.
TEST(Cancellation, EndsTheQuestionToTheImageAtRandomMoments) {
    using Clock = std::chrono::steady_clock;
    using Seconds = std::chrono::duration<double>;
    std::vector<Plane> planes = stacked_planes();
    for (const Plane& plane : orthogonal_planes()) planes.push_back(plane);
    const ContourSet contours = drawn_on(planes);
    Editor editor;
    double all = 0, longest = 0, longest_processor = 0;
    {
        Clock::time_point asked{};
        editor.finish(contours, helpful_image().get(), {}, [&](const EditedSurface&) { asked = Clock::now(); });
        all = Seconds(Clock::now() - asked).count();
    }
    std::mt19937 random = test::random_of_this_test();
    for (int round = 0; round < 5; ++round) {
        StopSource source;
        Clock::time_point stopped{};
        std::clock_t processor_stopped{};
        const Seconds delay{std::uniform_real_distribution(0.0, 0.9 * all)(random)};
        std::jthread stopper;
        const auto asking = [&](const EditedSurface&) {
            stopper = std::jthread([&] {
                std::this_thread::sleep_for(delay);
                stopped = Clock::now();
                processor_stopped = std::clock();
                source.request_stop();
            });
        };
        try {
            editor.finish(contours, helpful_image().get(), {.stop = source.token()}, asking);
        } catch (const Error& error) {
            const Clock::time_point ended = Clock::now();
            const std::clock_t processor_ended = std::clock();
            EXPECT_EQ(name(error.kind()), name(ErrorKind::cancelled)) << error.what();
            stopper.join();
            longest = std::max(longest, Seconds(ended - stopped).count());
            longest_processor = std::max(longest_processor, double(processor_ended - processor_stopped) / CLOCKS_PER_SEC);
        }
    }
    std::printf("a question of %.2f s ended at most %.3f s, %.3f s of the processors, after it was asked to\n", all, longest,
                longest_processor);
    if (std::getenv("KONTUR_TIMED")) {
        EXPECT_LT(longest_processor, 0.1);
    }
}

}  // namespace
}  // namespace kontur
