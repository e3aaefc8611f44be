// SPDX-License-Identifier: Apache-2.0
#include "archive/send.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <optional>
#include <random>
#include <system_error>

#include "archive/dicom_json.h"
#include "archive/query.h"
#include "archive/refusal.h"
#include "kontur/base/counted.h"
#include "kontur/base/error.h"

namespace kontur::archive {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr std::uint64_t kMostAnswerBytes = std::uint64_t{1} << 20;
constexpr const char* kFailedSops = "00081198";
constexpr const char* kReferencedSops = "00081199";
constexpr const char* kFailureReason = "00081197";
constexpr const char* kWarningReason = "00081196";

/// 128 random bits: no file has this line.
std::string random_border() {
    std::random_device source;
    std::string border = "kontur-";
    for (int n = 0; n < 4; ++n) border += fmt::format("{:08x}", source());
    return border;
}

/// A file between a head and a border, read as it is sent.
class Body {
public:
    Body(const fs::path& file, const std::string& border)
        : name_(file.string()),
          head_(fmt::format("--{}\r\nContent-Type: application/dicom\r\n\r\n", border)),
          tail_(fmt::format("\r\n--{}--\r\n", border)),
          stream_(file, std::ios::binary) {
        std::error_code failure;
        left_ = fs::file_size(file, failure);
        if (failure || !stream_) throw Error(ErrorKind::io, fmt::format("cannot read {}", name_));
        bytes_ = head_.size() + left_ + tail_.size();
    }

    std::uint64_t bytes() const { return bytes_; }

    std::size_t read(char* buffer, std::size_t size) {
        if (!head_.empty()) return take(head_, buffer, size);
        if (left_ == 0) return take(tail_, buffer, size);
        stream_.read(buffer, static_cast<std::streamsize>(std::min<std::uint64_t>(size, left_)));
        const auto count = static_cast<std::size_t>(stream_.gcount());
        if (count == 0) throw Error(ErrorKind::io, fmt::format("cannot read {} to its end", name_));
        left_ -= count;
        return count;
    }

private:
    static std::size_t take(std::string& text, char* buffer, std::size_t size) {
        const std::size_t count = text.copy(buffer, size);
        text.erase(0, count);
        return count;
    }

    std::string name_, head_, tail_;
    std::ifstream stream_;
    std::uint64_t left_ = 0, bytes_ = 0;
};

/// DICOM PS3.18, 10.5.3, and PS3.4, B.2.3.
std::string reason_of(std::int64_t code) {
    if (code == 0) return "no reason given";
    const char* words = (code & 0xff00) == 0xa700          ? "out of resources"
                        : (code & 0xff00) == 0xa900        ? "it does not match its class"
                        : (code & 0xf000) == 0xc000        ? "it cannot be understood"
                        : code == 0x0110                   ? "failure within the archive"
                        : code == 0x0111                   ? "the archive has an object of this UID"
                        : code == 0x0122 || code == 0x0112 ? "the archive takes no objects of this class"
                        : code == 0x0124                   ? "this user may not store it"
                        : code == 0x0131                   ? "the archive refuses what it holds"
                        : code == 0xb000                   ? "elements were changed"
                        : code == 0xb006                   ? "elements were left out"
                        : code == 0xb007                   ? "it does not match its class"
                                                           : "another reason";
    return fmt::format("{} ({:04X})", words, code);
}

/// The items of a sequence that speak of the object.
std::optional<json> item_on(const json& answer, const char* sequence, const std::string& uid) {
    for (const json& item : items_of(answer, sequence))
        if (value_of(item, "00081155") == uid) return item;
    return std::nullopt;
}

std::optional<Sent> said_of(const std::string& body, const std::string& uid) {
    for (const json& answer : json_objects(body)) {
        if (const auto failed = item_on(answer, kFailedSops, uid))
            return Sent{Outcome::refused, reason_of(count_of(*failed, kFailureReason))};
        if (const auto stored = item_on(answer, kReferencedSops, uid)) {
            const std::int64_t warning = count_of(*stored, kWarningReason);
            return warning == 0 ? Sent{} : Sent{Outcome::stored_with_doubt, reason_of(warning)};
        }
    }
    return std::nullopt;
}

Answer store(Http& http, const fs::path& file, const std::string& study_uid, const Work& work) {
    const std::string border = random_border();
    Body body(file, border);
    Request request;
    request.path = "/studies/" + study_uid;
    request.headers = {"Accept: application/dicom+json",
                       fmt::format("Content-Type: multipart/related; type=\"application/dicom\"; boundary={}", border)};
    request.body = [&](char* buffer, std::size_t size) { return body.read(buffer, size); };
    request.body_bytes = body.bytes();
    request.most_bytes = kMostAnswerBytes;
    return http.ask(request, work);
}

std::string in_words(const Sent& sent, const std::string& study) {
    switch (sent.outcome) {
        case Outcome::stored:
            return "stored in " + study;
        case Outcome::stored_with_doubt:
            return fmt::format("stored in {}, but {}", study, sent.reason);
        case Outcome::was_there:
            return fmt::format("was there already in {}; nothing was sent", study);
        case Outcome::refused:
            break;
    }
    return "refused: " + sent.reason;
}

bool is_json(const Answer& answer) { return answer.content_type.find("json") != std::string::npos; }

}  // namespace

Sent send_object(Http& http, const fs::path& file, const DicomObject& object, const Work& work) {
    if (!has_study(http, object.study_uid, work))
        throw Error(ErrorKind::invalid_input,
                    fmt::format("{} does not have the study {}, to which {} belongs; its images come first",
                                http.service().host(), object.study_uid, file.string()));
    if (has_instance(http, object.study_uid, object.instance_uid, work)) return {Outcome::was_there, ""};
    const Answer answer = store(http, file, object.study_uid, work);
    const bool may_speak = is_json(answer) && (answer.status == 200 || answer.status == 202 || answer.status == 409);
    const std::optional<Sent> said = may_speak ? said_of(answer.body, object.instance_uid) : std::nullopt;
    if (said) return *said;
    if (answer.status != 200) throw refusal(answer, http, file.string());
    return has_instance(http, object.study_uid, object.instance_uid, work)
               ? Sent{}
               : Sent{Outcome::refused, "the archive answers 200, but does not list it"};
}

std::string SentFile::text() const { return fmt::format("{}: {}", file.string(), in_words(sent, study)); }

std::vector<Error> send_files(Http& http, const std::vector<fs::path>& files,
                              const std::function<void(const SentFile&)>& on_sent, const Work& work) {
    std::vector<DicomObject> objects;
    for (const fs::path& file : files) objects.push_back(dicom_object(file));
    std::vector<Error> failures;
    for (std::size_t n = 0; n < files.size(); ++n) try {
            const std::string study = Address{http.service().service, objects[n].study_uid, "", ""}.text();
            const SentFile one{files[n], study, send_object(http, files[n], objects[n], work)};
            if (one.sent.outcome == Outcome::refused) failures.emplace_back(ErrorKind::io, one.text());
            else on_sent(one);
        } catch (const Error& error) {
            if (error.kind() == ErrorKind::cancelled) throw;
            failures.push_back(error);
        }
    return failures;
}

Error not_stored(const std::vector<Error>& failures, std::size_t files) {
    return {failures.front().kind(),
            fmt::format("{} of {} were not stored; the same again sends them, and leaves what is there", failures.size(),
                        counted(static_cast<std::int64_t>(files), "object"))};
}

}  // namespace kontur::archive
