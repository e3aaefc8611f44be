// SPDX-License-Identifier: Apache-2.0
#include "kontur/live_editor.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <future>
#include <mutex>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "kontur/extract/surface_band.h"
#include "kontur/phantom/cases.h"
#include "support/contour_sets.h"

namespace kontur {
namespace {

using Kind = EditorUpdate::Kind;

/// Keeps the updates; can be read while the editor works.
class Log {
public:
    LiveEditor::Listener listener() {
        return [this](const EditorUpdate& update) {
            const std::lock_guard lock(mutex_);
            if (update.kind != Kind::progress) updates_.push_back(update);
        };
    }
    std::vector<EditorUpdate> updates() const {
        const std::lock_guard lock(mutex_);
        return updates_;
    }

private:
    mutable std::mutex mutex_;
    std::vector<EditorUpdate> updates_;
};

ContourSet moved_ball(double mm = 0.5) {
    ContourSet set = test::ball_contours();
    for (Vec3& p : set.contours[0].points) p += mm * set.contours[0].plane.u;
    return set;
}

TEST(LiveEditor, PreviewsAndThenFinishesAnEdit) {
    Log log;
    LiveEditor editor({}, log.listener());
    EXPECT_EQ(editor.edit(test::ball_contours()), 1u);
    editor.wait();
    const std::vector<EditorUpdate> updates = log.updates();
    ASSERT_EQ(updates.size(), 2u);
    EXPECT_EQ(updates[0].kind, Kind::preview);
    EXPECT_EQ(updates[1].kind, Kind::finished);
    EXPECT_EQ(updates[1].edit, 1u);
    EXPECT_TRUE(updates[1].surface.finished);
    EXPECT_TRUE(std::ranges::equal(updates[1].surface.function.weights(),
                                   Editor().finish(test::ball_contours()).function.weights()));
}

TEST(LiveEditor, WhatItsListenerThrowsIsAProblemAndEndsNothing) {
    std::vector<std::string> problems;
    LiveEditor editor({}, [&](const EditorUpdate& update) {
        if (update.kind == Kind::finished) throw std::runtime_error("deaf");
        if (update.kind != Kind::problem) return;
        problems.push_back(update.problem);
        throw std::runtime_error("deaf to this, too");
    });
    for (int edit = 0; edit < 2; ++edit) {
        editor.edit(test::ball_contours());
        editor.wait();
    }
    EXPECT_EQ(problems, (std::vector<std::string>{"deaf", "deaf"}));
}

TEST(LiveEditor, TellsOfAPreviewAheadOfItsMesh) {
    std::vector<std::string> told;
    const auto note = [&](const char* what, std::uint64_t edit) { told.push_back(what + std::to_string(edit)); };
    LiveEditor editor(
        {},
        [&](const EditorUpdate& update) {
            if (update.kind == Kind::preview) note("preview ", update.edit);
            if (update.kind == Kind::finished) note("finished ", update.edit);
        },
        [&](std::uint64_t edit, const SurfaceBand& band) {
            EXPECT_EQ(band.cut(test::ball_contours().contours[0].plane).size(), 1u);
            note("ahead ", edit);
        });
    for (const ContourSet& set : {test::ball_contours(), moved_ball(0.01)}) {
        editor.edit(set);
        editor.wait();
    }
    EXPECT_EQ(told, (std::vector<std::string>{"ahead 1", "preview 1", "finished 1", "ahead 2", "preview 2", "finished 2"}));
}

TEST(LiveEditor, AnswersTheNewestOfManyEdits) {
    Log log;
    LiveEditor editor({}, log.listener());
    ContourSet set = test::ball_contours();
    constexpr std::uint64_t kEdits = 40;
    for (std::uint64_t edit = 1; edit <= kEdits; ++edit) {
        for (Vec3& p : set.contours[0].points) p += 0.01 * set.contours[0].plane.u;
        EXPECT_EQ(editor.edit(set), edit);
    }
    editor.wait();
    const std::vector<EditorUpdate> updates = log.updates();
    ASSERT_FALSE(updates.empty());
    EXPECT_EQ(updates.back().kind, Kind::finished);
    EXPECT_EQ(updates.back().edit, kEdits);
    EXPECT_TRUE(std::ranges::equal(updates.back().surface.function.weights(), Editor().finish(set).function.weights()));
    EXPECT_TRUE(std::ranges::is_sorted(updates, {}, &EditorUpdate::edit)) << "no answer is overtaken by an older one";
}

/// `second` comes when the preview of the first edit is told; which updates follow from there on.
std::vector<std::pair<Kind, std::uint64_t>> told_with_edit_at_preview(const ContourSet& second) {
    std::vector<std::pair<Kind, std::uint64_t>> told;
    LiveEditor* editing = nullptr;
    LiveEditor editor({}, [&](const EditorUpdate& update) {
        if (update.kind == Kind::progress) return;
        told.emplace_back(update.kind, update.edit);
        if (told.size() == 1) editing->edit(second);
    });
    editing = &editor;
    editor.edit(test::ball_contours());
    editor.wait();
    return told;
}

TEST(LiveEditor, AnswersAnEditThatChangesNothingByWhatItComputes) {
    using Told = std::vector<std::pair<Kind, std::uint64_t>>;
    EXPECT_EQ(told_with_edit_at_preview(test::ball_contours()), (Told{{Kind::preview, 1}, {Kind::finished, 2}}));
    EXPECT_EQ(told_with_edit_at_preview(moved_ball()), (Told{{Kind::preview, 1}, {Kind::preview, 2}, {Kind::finished, 2}}));
}

TEST(LiveEditor, AnEditThatIsUndoneIsAnsweredByTheSurfaceThatWasThere) {
    std::vector<EditorUpdate> updates;
    LiveEditor editor({}, [&](const EditorUpdate& update) { updates.push_back(update); });
    const auto answers = [&](const ContourSet& set) {
        editor.wait();
        updates.clear();
        editor.edit(set);
        editor.wait();
        return updates;
    };
    const EditorUpdate first = answers(test::ball_contours()).back();
    answers(moved_ball());
    const std::vector<EditorUpdate> undone = answers(test::ball_contours());
    ASSERT_EQ(undone.size(), 1u) << "neither a preview nor progress";
    EXPECT_EQ(undone[0].kind, Kind::finished);
    EXPECT_EQ(undone[0].edit, 3u);
    EXPECT_EQ(undone[0].surface.function.weights().data(), first.surface.function.weights().data());
    EXPECT_EQ(undone[0].surface.mesh.points, first.surface.mesh.points);
    for (std::size_t n = 1; n < LiveEditor::kKeptAnswers; ++n) answers(moved_ball(double(n)));
    EXPECT_EQ(answers(test::ball_contours()).size(), 1u);
    for (std::size_t n = 1; n <= LiveEditor::kKeptAnswers; ++n) answers(moved_ball(double(n)));
    EXPECT_GT(answers(test::ball_contours()).size(), 2u) << "too long ago";
}

TEST(LiveEditor, FinishesNothingThatIsEditedWhileItRests) {
    Log log;
    std::promise<void> both_told;
    LiveEditor* editing = nullptr;
    {
        const LiveEditor::Listener keep = log.listener();
        LiveEditor editor(
            {},
            [&](const EditorUpdate& update) {
                keep(update);
                if (update.kind != Kind::preview) return;
                if (update.edit == 1) editing->edit(moved_ball());
                if (update.edit == 2) both_told.set_value();
            },
            {}, 0, std::chrono::hours(1));
        editing = &editor;
        editor.edit(test::ball_contours());
        both_told.get_future().wait();
    }
    const std::vector<EditorUpdate> updates = log.updates();
    EXPECT_TRUE(std::ranges::all_of(updates, [](const EditorUpdate& update) { return update.kind == Kind::preview; }));
    EXPECT_EQ(updates.size(), 2u);
}

TEST(LiveEditor, ReportsAProblemAndGoesOn) {
    Log log;
    LiveEditor editor({}, log.listener());
    ContourSet bad = test::ball_contours();
    bad.contours[1].points.resize(2);
    editor.edit(bad);
    editor.wait();
    ASSERT_EQ(log.updates().size(), 1u);
    EXPECT_EQ(log.updates()[0].kind, Kind::problem);
    EXPECT_NE(log.updates()[0].problem.find("contour 2 has 2 points"), std::string::npos) << log.updates()[0].problem;
    editor.edit(test::ball_contours());
    editor.wait();
    EXPECT_EQ(log.updates().back().kind, Kind::finished);
    editor.edit({});
    editor.wait();
    EXPECT_TRUE(log.updates().back().surface.mesh.points.empty());
}

TEST(LiveEditor, IsDestroyedWhileItWorks) {
    const PhantomCase c = phantom_case("liver_parallel14");
    for (int repeat = 0; repeat < 3; ++repeat) {
        Log log;
        LiveEditor editor({}, log.listener());
        editor.edit(c.contours);
        if (repeat > 0) std::this_thread::sleep_for(std::chrono::milliseconds(30 * repeat));
    }
}

TEST(LiveEditor, WaitingForNothingReturns) {
    LiveEditor editor({}, [](const EditorUpdate&) {});
    editor.wait();
}

}  // namespace
}  // namespace kontur
