// SPDX-License-Identifier: Apache-2.0
#include "viewer/surfaces/surfaces.h"

#include <gtest/gtest.h>
#include <pthread.h>

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <filesystem>
#include <iterator>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

#include "support/contour_sets.h"

namespace kontur::viewer {
namespace {

using namespace std::chrono_literals;

SurfaceTask ball(Id structure) {
    SurfaceTask task{structure, test::ball_contours(), {}};
    for (std::size_t i = 0; i < task.set.contours.size(); ++i) task.ids.push_back(static_cast<Id>(i + 1));
    return task;
}

SurfaceTask nothing(Id structure) { return {structure, {}, {}}; }

SurfaceListener deaf() {
    return {[](Id, std::int64_t, const PlaneCutters&) {}, [](const std::shared_ptr<const Surface>&) {},
            [](const std::string&, std::optional<double>) {}};
}

std::ptrdiff_t threads() { return std::distance(std::filesystem::directory_iterator("/proc/self/task"), {}); }

TEST(Surfaces, EndWhileOneIsBeingFinishedAndStartNoOther) {
    {
        Surfaces first(deaf());  // starts the threads that all share
        first.follow(ball(1));
        first.wait();
    }
    const std::ptrdiff_t before = threads();
    std::mutex mutex;
    std::condition_variable changed;
    bool is_finishing = false;
    std::vector<Id> told;
    SurfaceListener listener = deaf();
    listener.surface = [&](const std::shared_ptr<const Surface>& surface) { told.push_back(surface->structure); };
    listener.outlines = [&](Id structure, std::int64_t revision, const PlaneCutters&) {
        if (structure != 2 || revision < 4) return;  // of the finished one, which comes after two for each preview
        {
            const std::scoped_lock lock(mutex);
            is_finishing = true;
        }
        changed.notify_all();
        std::this_thread::sleep_for(200ms);  // the destructor runs now
    };
    {
        Surfaces surfaces(listener);
        surfaces.follow(ball(1));
        surfaces.wait();
        surfaces.follow(ball(2));
        surfaces.follow_later(ball(3));
        std::unique_lock lock(mutex);
        ASSERT_TRUE(changed.wait_for(lock, 60s, [&] { return is_finishing; }));
    }
    EXPECT_EQ(std::count(told.begin(), told.end(), 2), 2) << "the preview and the finished one";
    EXPECT_EQ(std::count(told.begin(), told.end(), 3), 0);
    // A thread that has ended is listed for a moment longer.
    for (int i = 0; i < 100 && threads() > before; ++i) std::this_thread::sleep_for(10ms);
    EXPECT_LE(threads(), before);
}

TEST(Surfaces, AThreadLivesNoLongerThanTheContoursItFollows) {
    Surfaces surfaces(deaf());
    surfaces.follow(ball(1));
    surfaces.wait();
    const std::ptrdiff_t before = threads();
    for (Id structure = 2; structure < 10; ++structure) {
        surfaces.follow(nothing(structure));
        surfaces.follow(ball(structure));
        surfaces.wait();
        surfaces.follow(nothing(structure));
        surfaces.wait();
    }
    for (Id structure = 10; structure < 40; ++structure) surfaces.follow(nothing(structure));
    EXPECT_LE(threads(), before + 2);
    EXPECT_EQ(surfaces.all().size(), 39u);
    surfaces.follow(ball(2));
    surfaces.wait();
    EXPECT_EQ(surfaces.all().at(2)->stage, SurfaceStage::finished) << "contours after none are followed again";
    EXPECT_EQ(surfaces.all().at(3)->stage, SurfaceStage::none);
}

SurfaceTask two_circles(double radius, double other) {
    SurfaceTask task{1, {}, {1, 2}};
    task.set.contours = {test::circle(make_plane({}, {0, 0, 1}), radius, 60),
                         test::circle(make_plane({}, {0, 1, 0}), other, 60)};
    return task;
}

TEST(Surfaces, ContoursThatContradictEachOtherHaveOneBetweenThemAndAreNamed) {
    Surfaces surfaces(deaf());
    surfaces.follow(two_circles(20, 2));
    surfaces.wait();
    EXPECT_EQ(surfaces.all().at(1)->stage, SurfaceStage::finished);
    EXPECT_GT(surfaces.all().at(1)->volume_ml, 1);
    EXPECT_FALSE(surfaces.all().at(1)->conflicts.empty());
}

TEST(Surfaces, FaultsNameTheContoursByTheirIds) {
    SectionCheck check;
    check.between = {{1, 0, 0.4, 20, {1, 2, 3}, true}, {0, 1, 0.5, 20, {1, 2, 4}, true}, {1, 2, 0.1, 20, {}, false}};
    check.beyond = {{2, 9, 3, false, {4, 5, 6}, true}};
    const std::vector<SurfaceFault> found = surface_faults(check, {100, 50, 7});
    ASSERT_EQ(found.size(), 2u);
    EXPECT_EQ(found[0].kind, SectionFaultKind::between);
    EXPECT_EQ(found[0].contours, (std::vector<Id>{50, 100}));
    EXPECT_EQ(found[0].at, (Vec3{1, 2, 3}));
    EXPECT_EQ(found[1].kind, SectionFaultKind::beyond);
    EXPECT_EQ(found[1].contours, std::vector<Id>{7});
    EXPECT_EQ(found[1].length_mm, 9);
    check.beyond.resize(30, check.beyond.front());
    EXPECT_LE(surface_faults(check, {100, 50, 7}).size(), 11u);
}

TEST(Surfaces, WhereThereIsNoneTheContradictionsAreNamedAllTheSame) {
    SurfaceTask task = two_circles(20, 2);
    task.smoothing = 1e4;
    Surfaces surfaces(deaf());
    surfaces.follow(task);
    surfaces.wait();
    EXPECT_EQ(surfaces.all().at(1)->stage, SurfaceStage::none);
    ASSERT_EQ(surfaces.all().at(1)->warnings.size(), 1u);
    EXPECT_TRUE(surfaces.all().at(1)->warnings[0].starts_with("These contours give no surface"));
    EXPECT_FALSE(surfaces.all().at(1)->conflicts.empty());
}

TEST(Surfaces, AnImageThatCannotBeAskedTakesNoSurfaceAway) {
    Surfaces surfaces(deaf());
    surfaces.use_image(std::make_shared<const Image>(Image{{{9, 9, 9}, {}}, std::vector<float>(7)}));
    for (int edit = 0; edit < 2; ++edit) {
        surfaces.follow(ball(1));
        surfaces.wait();
        const auto shown = surfaces.all().at(1);
        EXPECT_EQ(shown->stage, SurfaceStage::finished);
        EXPECT_GT(shown->volume_ml, 20);
        ASSERT_EQ(shown->warnings.size(), 1u);
        EXPECT_EQ(shown->warnings[0], "The image could not be asked: the image has 7 values for a grid of 729 voxels.");
    }
    SurfaceTask broken = ball(1);
    broken.set.contours[0].points.resize(2);
    surfaces.follow(broken);
    surfaces.wait();
    EXPECT_EQ(surfaces.all().at(1)->stage, SurfaceStage::none) << "of contours that cannot be fitted there is none";
}

/// Makes every new thread ask for more memory than there are addresses, so that none can be started.
class NoThreads {
public:
    NoThreads() {
        pthread_attr_t attributes;
        pthread_getattr_default_np(&attributes);
        pthread_attr_getstacksize(&attributes, &usual_);
        pthread_attr_destroy(&attributes);
        set(std::size_t{1} << 47);
    }
    ~NoThreads() { set(usual_); }
    NoThreads(const NoThreads&) = delete;
    NoThreads& operator=(const NoThreads&) = delete;

private:
    static void set(std::size_t size) {
        pthread_attr_t attributes;
        pthread_attr_init(&attributes);
        pthread_attr_setstacksize(&attributes, size);
        EXPECT_EQ(pthread_setattr_default_np(&attributes), 0);
        pthread_attr_destroy(&attributes);
    }
    std::size_t usual_ = 0;
};

TEST(Surfaces, WithoutAThreadThereIsAWarningUntilTheNextEdit) {
    Surfaces surfaces(deaf());
    {
        const NoThreads here;
        surfaces.follow(ball(1));
        surfaces.follow_later(ball(2));
        for (const Id structure : {1, 2}) {
            const auto shown = surfaces.all().at(structure);
            EXPECT_EQ(shown->stage, SurfaceStage::none);
            ASSERT_EQ(shown->warnings.size(), 1u);
            EXPECT_NE(shown->warnings[0].find("no thread"), std::string::npos) << shown->warnings[0];
        }
    }
    surfaces.follow(ball(1));
    surfaces.wait();
    EXPECT_EQ(surfaces.all().at(1)->stage, SurfaceStage::finished);
}

}  // namespace
}  // namespace kontur::viewer
