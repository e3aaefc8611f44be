// SPDX-License-Identifier: Apache-2.0
#include "viewer/server/workspace.h"

#include <fmt/format.h>

#include <new>
#include <nlohmann/json.hpp>
#include <utility>

#include "archive/cache.h"
#include "kontur/base/error.h"
#include "kontur/io/dicom/uneven_slices_error.h"
#include "kontur/io/images/frame_choice_error.h"
#include "kontur/io/images/transform_choice_error.h"
#include "viewer/model/model_json.h"
#include "viewer/model/status_line.h"

namespace kontur::viewer {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr std::chrono::seconds kPatience(10);  ///< for whoever still uses the session before

json error_json(std::string_view kind, std::string_view sentence) {
    return {{"kind", std::string(kind)}, {"message", std::string(sentence)}};
}

/// The reply to a call for which there is no session, as a session would give it.
std::string refusal_of(std::string_view message, const std::string& sentence) {
    json seq = nullptr, reply;
    bool is_ping = false;
    try {
        const json request = parsed(message);
        const Members m(request);
        if (m.has("seq") && m.at("seq").is_number_integer()) seq = m.at("seq");
        is_ping = m.has("call") && m.at("call") == "ping";
    } catch (const json::exception&) {
        seq = nullptr;
    } catch (const Error&) {
        seq = nullptr;
    }
    if (is_ping) return to_text({{"seq", seq}, {"result", json::object()}});
    return to_text({{"seq", seq}, {"error", error_json(name(ErrorKind::invalid_input), sentence)}});
}

constexpr const char* kNothingOpen = "no image is open";
constexpr const char* kAnotherOpen = "another image was opened since; load the page again";

}  // namespace

Workspace::Workspace(Services services)
    : services_(std::move(services)),
      recent_(services_.recent),
      arrangements_(services_.arrangements),
      outbox_(services_.outbox) {}

Workspace::Workspace(std::shared_ptr<Session> session) { adopt(std::move(session)); }

Workspace::~Workspace() {
    cancel();
    if (reader_.joinable()) reader_.join();
    if (session_) session_->on_event({});
}

void Workspace::on_event(std::function<void(const std::string&)> listener) {
    const std::scoped_lock lock(listener_mutex_);
    listener_ = std::move(listener);
}

void Workspace::tell(const std::string& message) {
    const std::scoped_lock lock(listener_mutex_);
    if (listener_) listener_(message);
}

void Workspace::tell_status(const std::string& text, std::optional<double> fraction) {
    tell(to_text({{"event", "status"}, {"text", text}, {"fraction", fraction ? json(*fraction) : json(nullptr)}}));
}

json Workspace::places_json() const {
    json places = json::array();
    for (const Place& place : services_.places.all())
        places.push_back({{"name", place.name}, {"path", place.path.string()}});
    return places;
}

std::string Workspace::start_event() const {
    json recent = json::array(), opening = nullptr;
    for (const RecentProject& one : recent_.all())
        recent.push_back({{"path", one.project.string()},
                          {"title", one.title},
                          {"image", one.image},
                          {"second", one.second},
                          {"time", one.time}});
    if (opening_) opening = {{"title", opening_->title}, {"stage", opening_->stage}, {"fraction", opening_->fraction}};
    return to_text({{"event", "start"},
                    {"version", KONTUR_VERSION},
                    {"example", kExample},
                    {"places", places_json()},
                    {"recent", recent},
                    {"folder", folder_},
                    {"archive", services_.archive ? services_.archive->service.host() : ""},
                    {"sentence", sentence_},
                    {"opening", opening}});
}

std::string Workspace::greeting(PageId page) {
    std::shared_ptr<Session> session;
    std::uint64_t opened = 0;
    {
        const std::scoped_lock lock(mutex_);
        greeted_by_[page] = session_ ? opened_ : 0;
        if (!session_) return start_event();
        session = session_;
        opened = opened_;
    }
    const std::string modality = session->modality();
    json more{{"opening", std::to_string(opened)},
              {"can_close", services_.open != nullptr},
              {"places", places_json()},
              {"folder", services_.places.folder_of(session->image_path())},
              {"arrangement", {{"modality", modality}, {"state", arrangements_.of(modality)}}}};
    if (takes_objects(*session)) more["archive"] = services_.archive->service.host();
    return session->greeting(more);
}

std::string Workspace::call(std::string_view message, PageId page) {
    std::shared_ptr<Session> session;
    {
        const std::scoped_lock lock(mutex_);
        const auto greeted = greeted_by_.find(page);
        if (!session_) return refusal_of(message, kNothingOpen);
        if (greeted == greeted_by_.end() || greeted->second != opened_) return refusal_of(message, kAnotherOpen);
        session = session_;
    }
    return session->call(message, page);
}

void Workspace::left(PageId page) {
    std::shared_ptr<Session> session;
    {
        const std::scoped_lock lock(mutex_);
        greeted_by_.erase(page);
        session = session_;
    }
    if (session) session->left(page);
}

std::shared_ptr<Session> Workspace::session(const std::optional<std::string>& opening) const {
    const std::scoped_lock lock(mutex_);
    return session_locked(opening);
}

std::shared_ptr<Session> Workspace::session_locked(const std::optional<std::string>& opening) const {
    if (!session_) throw Error(ErrorKind::invalid_input, kNothingOpen);
    if (opening && *opening != std::to_string(opened_)) throw Error(ErrorKind::invalid_input, kAnotherOpen);
    return session_;
}

std::shared_ptr<Session> Workspace::session_unless_closed(const std::optional<std::string>& opening) const {
    const std::scoped_lock lock(mutex_);
    const std::uint64_t closed = session_ ? opened_ - 1 : opened_;
    for (std::uint64_t number = 1; opening && number <= closed; ++number)
        if (*opening == std::to_string(number)) return nullptr;
    return session_locked(opening);
}

void Workspace::begin(const std::string& title, Open open, std::function<void(std::exception_ptr)> done) {
    StopToken stop;
    {
        const std::scoped_lock lock(mutex_);
        if (session_) throw Error(ErrorKind::invalid_input, "an image is open; close it first");
        if (opening_)
            throw Error(ErrorKind::invalid_input, fmt::format("{} is being opened; cancel that first", opening_->title));
        opening_ = Opening{.title = title, .stage = ""};
        sentence_.clear();
        reading_ = StopSource();
        stop = reading_.token();
    }
    tell_progress("", 0);
    if (reader_.joinable()) reader_.join();  // of what was read before: it has told its end
    reader_ = std::thread([this, open = std::move(open), done = std::move(done), stop] { read(open, done, stop); });
}

void Workspace::read(const Open& open, const std::function<void(std::exception_ptr)>& done, const StopToken& stop) {
    std::exception_ptr failure;
    try {
        const auto begun = std::chrono::steady_clock::now();
        while (!last_.expired() && std::chrono::steady_clock::now() - begun < kPatience)
            std::this_thread::sleep_for(std::chrono::milliseconds(5));
        const Work work{.callback = [this](std::string_view stage, double fraction) { tell_progress(stage, fraction); },
                        .stop = stop};
        adopt(open(work));  // a stop that comes later finds a project that is there: it counts as opened
    } catch (const FrameChoiceError& error) {
        failure = std::current_exception();
        fail(name(error.kind()), error.what(), {{"frames", error.frames()}});
    } catch (const TransformChoiceError& error) {
        failure = std::current_exception();
        fail(name(error.kind()), error.what(), {{"transforms", true}});
    } catch (const UnevenSlicesError& error) {
        failure = std::current_exception();
        fail(name(error.kind()), error.what(), {{"uneven", true}});
    } catch (const ImageNotFound& error) {
        failure = std::current_exception();
        fail(name(error.kind()), error.what(), {{"moved", error.image()}});
    } catch (const Error& error) {
        failure = std::current_exception();
        fail(name(error.kind()), error.what());
    } catch (const std::bad_alloc&) {
        failure = std::current_exception();
        fail(name(ErrorKind::too_large), "there is not enough memory for this");
    } catch (const std::exception& error) {
        failure = std::current_exception();
        fail("internal", error.what());
    }
    if (done) done(failure);
}

void Workspace::remember(const Session& session) {
    recent_.add({fs::absolute(session.project_path()), session.title(), session.image_path(), {}, session.second_title()});
}

void Workspace::adopt(std::shared_ptr<Session> session) {
    session->on_event([this](const std::string& message) { tell(message); });
    remember(*session);
    {
        const std::scoped_lock lock(mutex_);
        last_ = session;
        session_ = std::move(session);
        ++opened_;
        opening_.reset();
    }
    finished_.notify_all();
    tell(to_text({{"event", "opened"}}));
}

void Workspace::fail(std::string_view kind, const std::string& sentence, const json& to_choose) {
    {
        const std::scoped_lock lock(mutex_);
        opening_.reset();
        sentence_ = kind == name(ErrorKind::cancelled) ? "" : sentence;
    }
    finished_.notify_all();
    json error = error_json(kind, sentence);
    error.update(to_choose);
    tell(to_text({{"event", "failed"}, {"error", std::move(error)}}));
}

void Workspace::tell_progress(std::string_view stage, double fraction) {
    json event;
    {
        const std::scoped_lock lock(mutex_);
        if (!opening_) return;
        // News by the hundredth: more would only cost pages time.
        const bool is_news =
            opening_->stage != stage || static_cast<int>(100 * fraction) != static_cast<int>(100 * opening_->fraction);
        if (!is_news && fraction > 0) return;
        opening_->stage = stage;
        opening_->fraction = fraction;
        event = {{"event", "opening"}, {"title", opening_->title}, {"stage", opening_->stage}, {"fraction", fraction}};
    }
    tell(to_text(event));
}

bool Workspace::wait_for(std::chrono::milliseconds time) {
    std::unique_lock lock(mutex_);
    return finished_.wait_for(lock, time, [&] { return !opening_; });
}

void Workspace::open(const OpenRequest& request) {
    OpenRequest checked = request;
    const bool is_known = request.path == kExample || recent_.contains(request.path);
    if (!is_known) checked.path = services_.places.resolved(request.path.string());
    if (!request.image.empty()) checked.image = services_.places.resolved(request.image.string());
    begin(checked.path.filename().string(), [this, checked](const Work& work) { return services_.open(checked, work); });
}

const NamedArchive& Workspace::archive() const {
    if (!services_.archive) throw Error(ErrorKind::unsupported, "kontur was started without an archive (--archive)");
    return *services_.archive;
}

bool Workspace::takes_objects(const Session& session) const {
    return services_.archive && archive::came_from(services_.archive->service, session.image_path());
}

json Workspace::send_to_archive(const ArchiveOutbox::Item& item, const std::optional<std::string>& opening,
                                const StopToken& stop) {
    const std::shared_ptr<Session> open = session(opening);
    if (!takes_objects(*open))
        throw Error(ErrorKind::unsupported,
                    fmt::format("the image did not come from {}, and what is made on it does not go there",
                                archive().service.host()));
    const StatusLine line([this](const std::string& said, std::optional<double> done) { tell_status(said, done); },
                          fmt::format("Sending to {}", archive().service.host()));
    return outbox_.send(archive(), *open, item, stop);
}

std::vector<std::string> Workspace::waiting_for_archive(const std::optional<std::string>& opening) const {
    const std::shared_ptr<Session> open = session(opening);
    return takes_objects(*open) ? outbox_.waiting(archive(), *open) : std::vector<std::string>();
}

void Workspace::open_archived(const std::string& study_uid, const std::string& series_uid, const std::string& title) {
    const archive::Address series = [&] {
        archive::Address address = archive().service;
        address.study_uid = study_uid;
        address.series_uid = series_uid;
        return address;
    }();
    begin(title, [this, series](const Work& work) {
        archive::Http http(series, archive().access);
        const std::vector<archive::Series> all = archive::find_series(http, series.study_uid, work.untold());
        archive::fetch_drawings_to_cache(http, all, series, work.untold());
        show_arriving(archive::cache_places(series));
        return services_.open({archive::fetch_to_cache(http, series, work)}, work);
    });
}

void Workspace::show_arriving(std::vector<fs::path> folders) {
    const std::scoped_lock lock(mutex_);
    if (opening_) opening_->arriving = std::make_shared<ArrivingSlices>(std::move(folders));
}

std::string Workspace::arriving(std::optional<double> at_mm) {
    std::shared_ptr<ArrivingSlices> slices;
    {
        const std::scoped_lock lock(mutex_);
        if (opening_) slices = opening_->arriving;
    }
    return slices ? slices->picture(at_mm) : "";
}

void Workspace::put_second_image(const OpenRequest& request, const std::optional<std::string>& opening,
                                 const StopToken& stop) {
    session(opening);
    if (!services_.read) throw Error(ErrorKind::unsupported, "this kontur shows one image alone");
    const std::unique_lock alone(reading_second_, std::try_to_lock);
    if (!alone)
        throw Error(ErrorKind::invalid_input, "another image is being added; wait until it is there, or cancel it first");
    const OpenRequest checked{services_.places.resolved(request.path.string()), request.choice, {}};
    const std::string text = fmt::format("Reading {}", checked.path.filename().string());
    const StatusLine line([this](const std::string& said, std::optional<double> done) { tell_status(said, done); }, text);
    OpenedImage read = services_.read(checked, line.work(stop));
    // The session is not held while it reads: whoever opens another image does not wait for this one.
    const std::shared_ptr<Session> open = session(opening);
    open->put_second_image(std::move(read));
    remember(*open);
}

void Workspace::cancel() {
    const std::scoped_lock lock(mutex_);
    reading_.request_stop();
}

void Workspace::close() {
    std::shared_ptr<Session> session;
    {
        const std::scoped_lock lock(mutex_);
        if (!session_) throw Error(ErrorKind::invalid_input, kNothingOpen);
        if (!services_.open) throw Error(ErrorKind::unsupported, "this kontur shows one image alone");
        session = std::move(session_);
        session_ = nullptr;
        folder_ = services_.places.folder_of(session->image_path());
    }
    session->on_event({});
    session.reset();
    tell(to_text({{"event", "closed"}}));
}

void Workspace::suggest(const fs::path& folder, const std::string& sentence) {
    const std::scoped_lock lock(mutex_);
    folder_ = folder.string();
    sentence_ = sentence;
}

}  // namespace kontur::viewer
