// SPDX-License-Identifier: Apache-2.0
#include "viewer/server/workspace.h"

#include <gtest/gtest.h>

#include <fstream>
#include <future>
#include <nlohmann/json.hpp>

#include "kontur/base/error.h"
#include "support/expect_error.h"
#include "support/temporary_folder.h"
#include "viewer/drawn_contours.h"

namespace kontur::viewer {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;
using kontur::test::TemporaryFolder;
using nlohmann::json;

constexpr PageId kPage = 1;

/// A workspace whose opener makes a flat image, or does what a test wants.
class Desk {
public:
    Desk() {
        std::ofstream(root_ / "image.nii") << "x";
        workspace.on_event([this](const std::string& message) {
            const std::scoped_lock lock(mutex_);
            events_.push_back(json::parse(message));
        });
    }
    ~Desk() { workspace.on_event({}); }

    OpenRequest image() const { return {root_ / "image.nii", {}}; }
    void open() {
        workspace.open(image());
        ASSERT_TRUE(workspace.wait_for(10s));
        // What became of it is told just after.
        for (int n = 0; n < 10'000 && told().back() == "opening"; ++n) std::this_thread::sleep_for(1ms);
    }
    json greeting(PageId page = kPage) { return json::parse(workspace.greeting(page)); }
    json call(const json& message, PageId page = kPage) { return json::parse(workspace.call(message.dump(), page)); }
    std::vector<std::string> told() {
        const std::scoped_lock lock(mutex_);
        std::vector<std::string> names;
        for (const json& event : events_)
            if (names.empty() || names.back() != event.at("event")) names.push_back(event.at("event"));
        return names;
    }

private:
    std::shared_ptr<Session> made(const Work& work) {
        if (opener) return opener(work);
        return std::make_shared<Session>(OpenedImage{test::flat_image(), "flat", {(root_ / "image.nii").string(), "a"}, {}},
                                         root_ / "a.kontur");
    }

    OpenedImage read(const Work& work) {
        if (reader) reader(work);
        return {test::flat_image(), "other", {(root_ / "image.nii").string(), "b"}, {}};
    }

    TemporaryFolder folder_;
    fs::path root_ = fs::canonical(folder_.path());
    std::mutex mutex_;
    std::vector<json> events_;

public:
    std::function<std::shared_ptr<Session>(const Work&)> opener;
    std::function<void(const Work&)> reader;
    Workspace workspace{{[this](const OpenRequest&, const Work& work) { return made(work); },
                         [this](const OpenRequest&, const Work& work) { return read(work); },
                         Places(std::vector<Place>{{"Here", root_}}), root_ / "recent.json", root_ / "arrangements.json"}};
};

TEST(Workspace, BeginsWithTheStartPageAndOpensWhatAPageAsksFor) {
    Desk desk;
    const json start = desk.greeting();
    EXPECT_EQ(start["event"], "start");
    EXPECT_EQ(start["places"].size(), 1u);
    EXPECT_EQ(start["opening"], nullptr);
    EXPECT_KONTUR_ERROR(desk.workspace.session(), ErrorKind::invalid_input, "no image is open");
    EXPECT_EQ(desk.call({{"seq", 3}, {"call", "undo"}})["error"]["message"], "no image is open");
    EXPECT_EQ(desk.call({{"seq", 4}, {"call", "ping"}}), (json{{"seq", 4}, {"result", json::object()}}));
    desk.open();
    EXPECT_EQ(desk.told(), (std::vector<std::string>{"opening", "opened"}));
    const json session = desk.greeting();
    EXPECT_EQ(session["event"], "session");
    EXPECT_EQ(session["opening"], "1");
    EXPECT_TRUE(session["can_close"]);
    EXPECT_EQ(desk.call({{"seq", 5}, {"call", "undo"}})["result"]["label"], nullptr);
    EXPECT_KONTUR_ERROR(desk.workspace.open(desk.image()), ErrorKind::invalid_input, "close it first");
}

TEST(Workspace, NothingOfAnEarlierSessionReachesALaterOne) {
    Desk desk;
    desk.open();
    desk.greeting();
    desk.workspace.close();
    EXPECT_EQ(desk.told().back(), "closed");
    desk.open();  // the same project: the session before has let go of it
    const json refused = desk.call({{"seq", 1}, {"call", "structure.add"}});
    EXPECT_EQ(refused["error"]["message"], "another image was opened since; load the page again");
    EXPECT_KONTUR_ERROR(desk.workspace.session("1"), ErrorKind::invalid_input, "another image was opened");
    EXPECT_NE(desk.workspace.session("2"), nullptr);
    EXPECT_EQ(desk.workspace.session_unless_closed("1"), nullptr);
    EXPECT_EQ(desk.workspace.session_unless_closed("2"), desk.workspace.session());
    EXPECT_KONTUR_ERROR(desk.workspace.session_unless_closed("3"), ErrorKind::invalid_input, "another image was opened");
    EXPECT_TRUE(desk.call({{"seq", 1}, {"call", "structure.add"}}, 7).contains("error")) << "a page that nobody greeted";
    desk.greeting(7);
    EXPECT_TRUE(desk.call({{"seq", 1}, {"call", "structure.add"}}, 7).contains("result"));
}

TEST(Workspace, TellsWhyAnImageCannotBeOpened) {
    Desk desk;
    desk.opener = [](const Work&) -> std::shared_ptr<Session> { throw Error(ErrorKind::corrupt_file, "it is damaged"); };
    desk.open();
    EXPECT_EQ(desk.told(), (std::vector<std::string>{"opening", "failed"}));
    EXPECT_EQ(desk.greeting()["sentence"], "it is damaged");
    desk.opener = {};
    desk.open();
    EXPECT_EQ(desk.greeting()["event"], "session");
}

TEST(Workspace, ReadingCanBeCancelledAndIsTheOnlyOneMeanwhile) {
    Desk desk;
    std::promise<void> begun;
    desk.opener = [&](const Work& work) -> std::shared_ptr<Session> {
        begun.set_value();
        for (;;) {
            work.report("read voxels", 0.25);
            std::this_thread::sleep_for(1ms);
        }
    };
    desk.workspace.open(desk.image());
    begun.get_future().wait();
    EXPECT_KONTUR_ERROR(desk.workspace.open(desk.image()), ErrorKind::invalid_input, "image.nii is being opened");
    while (desk.greeting()["opening"]["fraction"] != 0.25) std::this_thread::sleep_for(1ms);
    EXPECT_EQ(desk.greeting()["opening"]["title"], "image.nii");
    desk.workspace.cancel();
    ASSERT_TRUE(desk.workspace.wait_for(10s));
    EXPECT_EQ(desk.greeting()["opening"], nullptr);
    EXPECT_EQ(desk.greeting()["sentence"], "");
}

TEST(Workspace, ReadsOneSecondImageAtATimeAndItCanBeCancelled) {
    Desk desk;
    EXPECT_KONTUR_ERROR(desk.workspace.put_second_image(desk.image(), {}, {}), ErrorKind::invalid_input, "no image is open");
    desk.open();
    std::promise<void> begun;
    desk.reader = [&](const Work& work) {
        begun.set_value();
        for (;; std::this_thread::sleep_for(1ms)) work.report("read voxels", 0.25);
    };
    StopSource stop;
    auto ended = std::async(std::launch::async, [&] {
        EXPECT_KONTUR_ERROR(desk.workspace.put_second_image(desk.image(), {}, stop.token()), ErrorKind::cancelled, "");
    });
    begun.get_future().wait();
    EXPECT_KONTUR_ERROR(desk.workspace.put_second_image(desk.image(), {}, {}), ErrorKind::invalid_input,
                        "another image is being added");
    stop.request_stop();
    ended.wait();
    EXPECT_EQ(desk.greeting()["images"], json::array());
    desk.reader = {};
    desk.workspace.put_second_image(desk.image(), "1", {});
    EXPECT_EQ(desk.greeting()["images"][0]["title"], "other");
    desk.workspace.close();
    EXPECT_EQ(desk.greeting()["recent"][0]["second"], "other");
    desk.open();
    EXPECT_KONTUR_ERROR(desk.workspace.put_second_image({"/etc/passwd", {}}, {}, {}), ErrorKind::invalid_input,
                        "lies outside");
}

TEST(Workspace, ASecondImageDoesNotReachASessionThatWasOpenedMeanwhile) {
    Desk desk;
    desk.open();
    desk.reader = [&](const Work&) {
        desk.workspace.close();
        desk.open();
    };
    EXPECT_KONTUR_ERROR(desk.workspace.put_second_image(desk.image(), "1", {}), ErrorKind::invalid_input,
                        "another image was opened");
    EXPECT_EQ(desk.greeting()["images"], json::array());
}

TEST(Workspace, OpensRecentProjectsAndWhatLiesInItsPlacesOnly) {
    Desk desk;
    EXPECT_KONTUR_ERROR(desk.workspace.open({"/etc/passwd", {}}), ErrorKind::invalid_input, "lies outside");
    EXPECT_KONTUR_ERROR(desk.workspace.open({"image.nii", {}}), ErrorKind::invalid_input, "lies outside");
    desk.open();
    desk.workspace.close();
    const json recent = desk.greeting()["recent"];
    ASSERT_EQ(recent.size(), 1u);
    desk.workspace.open({recent[0]["path"].get<std::string>(), {}});
    EXPECT_TRUE(desk.workspace.wait_for(10s));
    desk.workspace.close();
    desk.workspace.open({kExample, {}});
    EXPECT_TRUE(desk.workspace.wait_for(10s));
}

TEST(Workspace, GreetsWithHowThePageWasArrangedLastForTheModality) {
    Desk desk;
    desk.open();
    EXPECT_EQ(desk.greeting()["arrangement"], json({{"modality", ""}, {"state", nullptr}}));
    desk.workspace.arrangements().keep("CT", {{"layout", "single"}});
    EXPECT_EQ(desk.greeting()["arrangement"]["state"], nullptr);
    desk.workspace.arrangements().keep("", {{"layout", "overview"}});
    desk.workspace.arrangements().keep("", {{"layout", "big-slice"}});
    EXPECT_EQ(desk.greeting()["arrangement"]["state"]["layout"], "big-slice");
}

TEST(Arrangements, StayInTheFileAndADamagedOneIsNone) {
    const TemporaryFolder folder;
    const fs::path file = folder.path() / "arrangements.json";
    Arrangements(file).keep("MR", {{"layout", "single"}});
    EXPECT_EQ(Arrangements(file).of("MR")["layout"], "single");
    EXPECT_EQ(Arrangements(file).of("US"), nullptr);
    for (const char* damaged : {"", "{", "[1]", "null", "{\"CT\": 1}"}) {
        std::ofstream(file) << damaged;
        EXPECT_EQ(Arrangements(file).of("MR"), nullptr) << damaged;
    }
    Arrangements(file).keep("MR", 3);
    EXPECT_EQ(Arrangements(file).of("MR"), 3);
}

TEST(Arrangements, RefusesWhatIsTooLargeOrNoModality) {
    const TemporaryFolder folder;
    Arrangements these(folder.path() / "arrangements.json");
    EXPECT_KONTUR_ERROR(these.keep("CT", std::string(5000, 'x')), ErrorKind::too_large, "the limit is 4096");
    for (const char* wrong : {"ct", "C/T", "SEVENTEEN_LETTERS"})
        EXPECT_KONTUR_ERROR(these.keep(wrong, 1), ErrorKind::invalid_input, "is no modality");
    EXPECT_EQ(these.of("CT"), nullptr);
}

TEST(Workspace, OfOneSessionAloneIsNotClosed) {
    const TemporaryFolder folder;
    Workspace workspace(
        std::make_shared<Session>(OpenedImage{test::flat_image(), "flat", {"/a.nii", "a"}, {}}, folder.path() / "a.kontur"));
    EXPECT_FALSE(json::parse(workspace.greeting(kPage))["can_close"]);
    EXPECT_KONTUR_ERROR(workspace.close(), ErrorKind::unsupported, "one image alone");
}

}  // namespace
}  // namespace kontur::viewer
