// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <exception>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "kontur/base/stop.h"
#include "kontur/base/work.h"
#include "viewer/images/arriving_slices.h"
#include "viewer/server/archive_outbox.h"
#include "viewer/session/session.h"
#include "viewer/store/arrangements.h"
#include "viewer/store/places.h"
#include "viewer/store/recent.h"

namespace kontur::viewer {

/// What a page asks to open: an image, a DICOM folder, a project, or the example.
struct OpenRequest {
    std::filesystem::path path;
    ImageChoice choice{};
    std::filesystem::path image{};  ///< where the image of a project lies now; empty: where it was
};

/// The path that stands for the built-in example image.
inline constexpr const char* kExample = "phantom";

/// What the server serves: a start page until something is open, then its session, then the start page again. One at a time,
/// for all pages; reading runs in the background. Safe for concurrent use.
class Workspace {
public:
    using Open = std::function<std::shared_ptr<Session>(const Work&)>;

    struct Services {
        /// Makes the session for what a page asks for. Errors are exceptions.
        std::function<std::shared_ptr<Session>(const OpenRequest&, const Work&)> open{};
        /// Reads an image that is to be shown beside the one that is open.
        std::function<OpenedImage(const OpenRequest&, const Work&)> read{};
        Places places{};
        std::filesystem::path recent{};        ///< the file that lists projects; empty: none is kept
        std::filesystem::path arrangements{};  ///< the file of how the page was arranged; empty: that is not kept
        std::filesystem::path outbox{};        ///< the folder of what did not arrive in the archive; empty: it is not kept
        std::optional<NamedArchive> archive{};
    };

    explicit Workspace(Services services);
    /// With a session from the beginning, and no other.
    explicit Workspace(std::shared_ptr<Session> session);
    ~Workspace();
    Workspace(const Workspace&) = delete;
    Workspace& operator=(const Workspace&) = delete;

    /// Whom to tell events, from any thread. An empty function: nobody.
    void on_event(std::function<void(const std::string& message)> listener);

    /// The first event for a page that has just come: `start` or `session`.
    std::string greeting(PageId page);
    /// Carries out one message of a page and returns the reply. A page that was greeted by another session than the present
    /// one is refused. Never throws.
    std::string call(std::string_view message, PageId page);
    /// The page is closed. Never throws.
    void left(PageId page);

    /// The session that is open; `opening`, if given, must be the one that it was greeted by. Throws Error(invalid_input)
    /// where there is none, or another.
    std::shared_ptr<Session> session(const std::optional<std::string>& opening = {}) const;

    /// The same, and null where that one was open and has been closed: a page that has not heard of it yet will.
    std::shared_ptr<Session> session_unless_closed(const std::optional<std::string>& opening) const;

    /// Begins to read in the background; pages are told how far it is, and what came of it. `done`, if given, is called
    /// with the failure, or none, when pages have been told. Throws Error(invalid_input) while something is open or read.
    void begin(const std::string& title, Open open, std::function<void(std::exception_ptr)> done = {});
    /// Waits until nothing is read any more; false: it is still going on after this time.
    bool wait_for(std::chrono::milliseconds time);

    /// For pages: as `begin`, of what is a recent project, the example, or lies in one of the places.
    void open(const OpenRequest& request);
    /// For pages: as `begin`, of a series of the archive, with what was drawn in its study. Throws Error(unsupported)
    /// without an archive.
    void open_archived(const std::string& study_uid, const std::string& series_uid, const std::string& title);
    /// For pages: of the series that is being fetched what has come (ArrivingSlices::picture). "" where there is nothing.
    std::string arriving(std::optional<double> at_mm);
    /// For pages: reads what lies in one of the places, and shows it beside the open session's image. Returns when it is
    /// there; status lines say how far it is. Throws as `session` and `Session::put_second_image`, what the reader throws,
    /// and Error(invalid_input) while another one is read.
    void put_second_image(const OpenRequest& request, const std::optional<std::string>& opening, const StopToken& stop);
    /// What is being read is given up.
    void cancel();
    /// Everything is saved; the start page comes back.
    void close();
    /// The folder and the sentence that the start page begins with.
    void suggest(const std::filesystem::path& folder, const std::string& sentence);

    const Places& places() const { return services_.places; }
    /// Throws Error(unsupported) where the command named none.
    const NamedArchive& archive() const;
    /// Whether the image came from the archive that the command named, which then takes what is made on it.
    bool takes_objects(const Session& session) const;
    /// For pages: sends an export to the archive that the image came from (ArchiveOutbox). Throws Error(unsupported) where
    /// it came from elsewhere.
    nlohmann::json send_to_archive(const ArchiveOutbox::Item& item, const std::optional<std::string>& opening,
                                   const StopToken& stop);
    /// For pages: the names of exports that did not arrive in the archive that the image came from.
    std::vector<std::string> waiting_for_archive(const std::optional<std::string>& opening) const;
    /// How the page is arranged for images of each modality.
    Arrangements& arrangements() { return arrangements_; }
    /// Tells pages' status lines what is being done; "": nothing.
    void tell_status(const std::string& text, std::optional<double> fraction);

private:
    /// What is being read.
    struct Opening {
        std::string title;
        std::string stage;
        double fraction = 0;
        std::shared_ptr<ArrivingSlices> arriving{};  ///< from an archive
    };

    std::shared_ptr<Session> session_locked(const std::optional<std::string>& opening) const;
    std::string start_event() const;
    nlohmann::json places_json() const;
    void read(const Open& open, const std::function<void(std::exception_ptr)>& done, const StopToken& stop);
    void adopt(std::shared_ptr<Session> session);
    void remember(const Session& session);
    /// `to_choose`: further members of the error, where the file can be read once something is chosen.
    void fail(std::string_view kind, const std::string& sentence,
              const nlohmann::json& to_choose = nlohmann::json::object());
    void show_arriving(std::vector<std::filesystem::path> folders);
    void tell_progress(std::string_view stage, double fraction);
    void tell(const std::string& message);

    const Services services_;
    RecentProjects recent_;
    Arrangements arrangements_;
    std::mutex reading_second_;
    ArchiveOutbox outbox_;

    std::mutex listener_mutex_;
    std::function<void(const std::string&)> listener_;

    mutable std::mutex mutex_;  ///< of what follows
    std::condition_variable finished_;
    std::shared_ptr<Session> session_;
    std::weak_ptr<Session> last_;  ///< its project stays locked until whoever uses it has let go
    std::uint64_t opened_ = 0;     ///< so many sessions until now
    std::map<PageId, std::uint64_t> greeted_by_;
    std::optional<Opening> opening_;
    std::string folder_, sentence_;

    StopSource reading_;
    std::thread reader_;  ///< last: it uses all of it
};

}  // namespace kontur::viewer
