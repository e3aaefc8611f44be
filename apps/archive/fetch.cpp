// SPDX-License-Identifier: Apache-2.0
#include "archive/fetch.h"

#include <fmt/format.h>

#include <cstdint>
#include <functional>
#include <optional>
#include <set>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "archive/batched_files.h"
#include "archive/multipart.h"
#include "archive/part10.h"
#include "archive/query.h"
#include "archive/refusal.h"
#include "kontur/base/error.h"
#include "kontur/io/bytes/folders.h"

namespace kontur::archive {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kMostObjectBytes = std::uint64_t{4} << 30;
constexpr const char* kExtension = ".dcm";
constexpr const char* kAccept = "Accept: multipart/related; type=\"application/dicom\"; transfer-syntax=*";

fs::path file_of(const fs::path& folder, const std::string& uid) { return folder / (uid + kExtension); }

/// Puts each part into a file named by its UID.
class PartFiles : public PartSink {
public:
    /// `expected`: UIDs, of which each comes once; without them `count` different ones. `on_file` is called after each.
    PartFiles(BatchedFiles& files, std::set<std::string> expected, std::function<void()> on_file)
        : files_(files), left_(expected.size()), expected_(std::move(expected)), on_file_(std::move(on_file)) {}
    PartFiles(BatchedFiles& files, std::size_t count, std::function<void()> on_file)
        : files_(files), left_(count), on_file_(std::move(on_file)) {}

    void begin_part() override {
        beginning_.clear();
        bytes_ = 0;
        is_named_ = false;
    }

    void piece(std::string_view bytes) override {
        bytes_ += bytes.size();
        if (bytes_ > kMostObjectBytes)
            throw Error(ErrorKind::too_large,
                        fmt::format("the archive sends an object of more than {} bytes, the limit", kMostObjectBytes));
        if (is_named_) return files_.write(bytes);
        beginning_ += bytes;
        if (beginning_.size() >= kMetaBytes) open();
    }

    void end_part() override {
        if (!is_named_) open();
        files_.end();
        on_file_();
    }

    void wait() { files_.wait(); }

private:
    void open() {
        const std::string uid = media_storage_uid(beginning_);
        if (uid.empty())
            throw Error(ErrorKind::corrupt_file,
                        "the archive sends a part that is no DICOM file, or does not say which object");
        const bool is_new = expected_ ? expected_->erase(uid) == 1 : left_ > 0 && arrived_.insert(uid).second;
        if (!is_new)
            throw Error(ErrorKind::corrupt_file,
                        fmt::format("the archive sends the object {}, which it has sent before or does not list", uid));
        --left_;
        files_.begin(uid + kExtension);
        files_.write(beginning_);
        is_named_ = true;
    }

    BatchedFiles& files_;
    std::size_t left_;  ///< objects to come
    std::optional<std::set<std::string>> expected_;
    std::set<std::string> arrived_;  ///< where it is not known which are expected
    std::function<void()> on_file_;
    std::string beginning_;  ///< of a part, until its UID is known
    bool is_named_ = false;
    std::uint64_t bytes_ = 0;
};

/// An answer in parts, of which what comes before an error is kept.
class PartsAnswer : public AnswerSink {
public:
    explicit PartsAnswer(PartFiles& files) : files_(files) {}
    void begin(const Answer& answer) override { reader_.emplace(border_of(answer.content_type), files_); }
    void piece(std::string_view bytes) override { reader_->feed(bytes); }
    void wait() override { files_.wait(); }
    void finish() const {
        if (reader_) reader_->finish();
    }

private:
    PartFiles& files_;
    std::optional<MultipartReader> reader_;
};

void fetch_parts(Http& http, const Address& address, std::size_t objects, PartFiles& files, const Work& work) {
    Request request;
    request.path = address.text().substr(address.service.size());
    request.headers = {kAccept};
    request.most_bytes = objects * (kMostObjectBytes + kMetaBytes);
    PartsAnswer parts(files);
    const Answer answer = http.ask(request, work, &parts);
    if (answer.status != 200) throw refusal(answer, http, address.text());
    parts.finish();
}

std::set<std::string> missing_in(const fs::path& folder, const std::vector<Instance>& listed) {
    std::set<std::string> missing;
    std::error_code ignored;
    for (const Instance& one : listed)
        if (!fs::is_regular_file(file_of(folder, one.uid), ignored)) missing.insert(one.uid);
    return missing;
}

/// Whether the folder, which a user may have named, is there and whole.
bool is_whole(const fs::path& folder, const std::vector<Instance>& listed) {
    std::error_code ignored;
    if (!fs::exists(folder, ignored) || fs::is_empty(folder, ignored)) return false;
    const std::size_t missing = missing_in(folder, listed).size();
    if (missing == 0) return true;
    throw Error(ErrorKind::invalid_input,
                fmt::format("{} is there already and lacks {} of the {} objects that the archive lists; name a new folder",
                            folder.string(), missing, listed.size()));
}

void put_in_place(const fs::path& part, const fs::path& folder) {
    std::error_code failure;
    fs::rename(part, folder, failure);
    if (failure) throw Error(ErrorKind::io, fmt::format("cannot write {}: {}", folder.string(), failure.message()));
}

bool is_empty_or_missing(const fs::path& folder) {
    std::error_code ignored;
    return !fs::exists(folder, ignored) || fs::is_empty(folder, ignored);
}

/// A series on its way into its part folder.
class SeriesFetch {
public:
    SeriesFetch(Http& http, const Address& series, const fs::path& part, FetchedSeries& progress, const Work& work)
        : http_(http), series_(series), part_(part), progress_(progress), work_(work) {
        make_folder(part);
    }

    /// All at once, without asking first which objects these are: archives take as long for that as for the objects.
    void whole() {
        keeping([&](BatchedFiles& files) {
            PartFiles parts(files, progress_.objects, [&] { count(); });
            fetch_parts(http_, series_, progress_.objects, parts, work_);
        });
    }

    /// What is there of the list counts; the others come one by one.
    void listed(const std::vector<Instance>& all) {
        const std::set<std::string> missing = missing_in(part_, all);
        progress_.arrived = all.size() - missing.size();
        if (progress_.arrived == 0) whole();
        else keeping([&](BatchedFiles& files) { one_by_one(missing, files); });
        progress_.arrived = all.size() - missing_in(part_, all).size();
    }

private:
    void one_by_one(const std::set<std::string>& missing, BatchedFiles& files) {
        for (const std::string& uid : missing) {
            PartFiles parts(files, std::set{uid}, [&] { count(); });
            fetch_parts(http_, {series_.service, series_.study_uid, series_.series_uid, uid}, 1, parts, work_);
        }
    }

    void count() {
        ++progress_.arrived;
        work_.report("fetch", static_cast<double>(progress_.arrived) / static_cast<double>(progress_.objects));
    }

    /// What came before an error stays, on the disk.
    template <class Fetch>
    void keeping(Fetch fetch) {
        BatchedFiles files(part_);
        try {
            fetch(files);
        } catch (const Error&) {
            files.flush();
            throw;
        }
        files.flush();
    }

    Http& http_;
    const Address& series_;
    const fs::path& part_;
    FetchedSeries& progress_;
    const Work& work_;
};

}  // namespace

fs::path part_folder(const fs::path& folder) { return fs::path(folder.string() + ".part"); }

void fetch_series(Http& http, const Address& series, const fs::path& folder, FetchedSeries& progress, const Work& work) {
    const fs::path part = part_folder(folder);
    const bool is_new = is_empty_or_missing(folder) && is_empty_or_missing(part);
    progress = {is_new ? static_cast<std::size_t>(count_instances(http, series, work)) : 0, 0};
    if (progress.objects > 0) {
        SeriesFetch(http, series, part, progress, work).whole();
    } else {
        const std::vector<Instance> listed = find_instances(http, series, work);
        progress.objects = listed.size();
        if (is_whole(folder, listed)) {
            progress.arrived = listed.size();
            return;
        }
        SeriesFetch(http, series, part, progress, work).listed(listed);
    }
    if (progress.arrived != progress.objects)
        throw Error(ErrorKind::io, fmt::format("{} sends {} of the {} objects that it has", http.service().host(),
                                               progress.arrived, progress.objects));
    put_in_place(part, folder);
}

std::size_t fetch_into_folder(Http& http, const Address& series, const fs::path& folder, const Work& work,
                              const std::function<void(const std::string&)>& on_interruption) {
    FetchedSeries progress;
    try {
        fetch_series(http, series, folder, progress, work);
    } catch (const Error& error) {
        if (progress.arrived == 0) throw;
        const std::string how_far = fmt::format("{} of {} objects are in {}, and the same again goes on from there",
                                                progress.arrived, progress.objects, part_folder(folder).string());
        if (error.kind() == ErrorKind::cancelled && on_interruption) on_interruption(how_far);
        throw Error(error.kind(), fmt::format("{}; {}", error.what(), how_far));
    }
    return progress.objects;
}

void fetch_instance(Http& http, const Address& instance, const fs::path& file, const Work& work) {
    std::error_code ignored;
    if (fs::exists(file, ignored)) return;
    const fs::path part = part_folder(file);
    make_folder(part);
    std::size_t arrived = 0;
    BatchedFiles files(part);
    PartFiles parts(files, std::set{instance.instance_uid}, [&] { ++arrived; });
    fetch_parts(http, instance, 1, parts, work);
    files.flush();
    if (arrived == 0)
        throw Error(ErrorKind::io, fmt::format("{} sends nothing for {}", http.service().host(), instance.text()));
    put_in_place(file_of(part, instance.instance_uid), file);
    fs::remove(part, ignored);
}

}  // namespace kontur::archive
