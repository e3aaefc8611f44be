// SPDX-License-Identifier: Apache-2.0
#include "archive/http.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <exception>
#include <new>
#include <system_error>
#include <utility>

#include "archive/libcurl.h"
#include "kontur/base/error.h"
#include "kontur/base/printable.h"

namespace kontur::archive {
namespace {

constexpr long kConnectSeconds = 15;
constexpr long kLeastBytesPerSecond = 1000;
constexpr long kBufferBytes = 512 * 1024;
constexpr int kMostRedirects = 5;
constexpr std::size_t kMostRefusalBytes = 65536;  // of an answer that is no success

struct List {
    curl_slist* first = nullptr;
    ~List() { libcurl().slist_free_all(first); }
    void add(const std::string& line) {
        curl_slist* longer = libcurl().slist_append(first, line.c_str());
        if (!longer) throw std::bad_alloc();
        first = longer;
    }
};

std::string origin_of(const char* address) {
    CURLU* parts = libcurl().url();
    std::string origin;
    if (parts && libcurl().url_set(parts, CURLUPART_URL, address, 0) == CURLUE_OK)
        for (const CURLUPart part : {CURLUPART_SCHEME, CURLUPART_HOST, CURLUPART_PORT}) {
            char* text = nullptr;
            if (libcurl().url_get(parts, part, &text, CURLU_DEFAULT_PORT) == CURLUE_OK && text)
                origin += (origin.empty() ? "" : part == CURLUPART_HOST ? "://" : ":") + lower_case(text);
            libcurl().free(text);
        }
    libcurl().url_cleanup(parts);
    return origin;
}

}  // namespace

struct Http::Handle {
    CURL* curl = libcurl().easy_init();
    std::array<char, CURL_ERROR_SIZE> reason{};
    ~Handle() { libcurl().easy_cleanup(curl); }

    template <class Value>
    void set(CURLoption option, Value value) {
        if (libcurl().easy_setopt(curl, option, value) != CURLE_OK) throw std::bad_alloc();
    }
};

/// One request on its way. An exception may not pass through libcurl: it waits here.
struct Http::Transfer {
    const Request& request;
    const Work& work;
    AnswerSink* sink;
    CURL* curl;
    Answer answer{};
    std::uint64_t received = 0;
    bool has_begun = false, is_too_large = false;
    std::exception_ptr failure{};
    List headers{};

    template <class Body>
    bool guarded(Body body) noexcept {
        try {
            body();
            return true;
        } catch (...) {
            failure = std::current_exception();
            return false;
        }
    }

    bool took_all_its_time() const {
        double seconds = 0;
        libcurl().easy_getinfo(curl, CURLINFO_TOTAL_TIME, &seconds);
        return seconds >= request.most_seconds;
    }
    bool is_success() const { return answer.status >= 200 && answer.status < 300; }

    void begin() {
        long status = 0;
        libcurl().easy_getinfo(curl, CURLINFO_RESPONSE_CODE, &status);
        answer.status = static_cast<int>(status);
        const char* type = nullptr;
        libcurl().easy_getinfo(curl, CURLINFO_CONTENT_TYPE, &type);
        answer.content_type = type ? type : "";
        has_begun = true;
        if (sink && is_success()) sink->begin(answer);
    }

    void take(std::string_view bytes) {
        if (!has_begun) begin();
        received += bytes.size();
        is_too_large = received > request.most_bytes;
        if (!is_success())
            answer.body += bytes.substr(0, kMostRefusalBytes - std::min(kMostRefusalBytes, answer.body.size()));
        else if (!is_too_large && sink) sink->piece(bytes);
        else if (!is_too_large) answer.body += bytes;
    }

    static std::size_t on_bytes(char* bytes, std::size_t, std::size_t count, void* self) {
        Transfer& transfer = *static_cast<Transfer*>(self);
        return transfer.guarded([&] {
            transfer.take({bytes, count});
        }) && !transfer.is_too_large
                   ? count
                   : CURL_WRITEFUNC_ERROR;
    }
    static std::size_t on_room(char* buffer, std::size_t, std::size_t size, void* self) {
        Transfer& transfer = *static_cast<Transfer*>(self);
        std::size_t count = 0;
        return transfer.guarded([&] { count = transfer.request.body(buffer, size); }) ? count : CURL_READFUNC_ABORT;
    }
    static int on_progress(void* self, curl_off_t, curl_off_t, curl_off_t, curl_off_t) {
        Transfer& transfer = *static_cast<Transfer*>(self);
        const bool may_go_on = transfer.guarded([&] {
            if (transfer.sink && transfer.has_begun) transfer.sink->wait();
        });
        return may_go_on && !transfer.work.stop.stop_requested() ? 0 : 1;
    }
};

Access read_access(const std::filesystem::path& credentials, const std::filesystem::path& ca, int give_up_s) {
    std::error_code ignored;
    if (!ca.empty() && !std::filesystem::is_regular_file(ca, ignored))
        throw Error(ErrorKind::io, fmt::format("cannot read --ca {}: it is no file", ca.string()));
    if (give_up_s < 1)
        throw Error(ErrorKind::invalid_input, fmt::format("--give-up-s is {} s, but must be at least 1", give_up_s));
    return {read_credentials(credentials), ca, give_up_s};
}

Http::Http(const Address& service, const Access& access) : service_{service.service, "", "", ""}, access_(access) {
    if (!access.credentials.is_empty() && !service.is_encrypted() && !service.is_this_machine())
        throw Error(ErrorKind::invalid_input,
                    fmt::format("{} is not encrypted, and the user or token of {} would be readable on the way; name the "
                                "archive by https://",
                                service.service, access.credentials.origin));
    handle_ = std::make_unique<Handle>();
    if (!handle_->curl) throw std::bad_alloc();
}

Http::~Http() = default;

void Http::choose_access() {
    Handle& handle = *handle_;
    if (!access_.ca.empty()) {
        handle.set(CURLOPT_CAINFO, access_.ca.c_str());
        handle.set(CURLOPT_CAPATH, nullptr);
    }
    const Credentials& who = access_.credentials;
    if (!who.token.empty()) {
        handle.set(CURLOPT_HTTPAUTH, long{CURLAUTH_BEARER});
        handle.set(CURLOPT_XOAUTH2_BEARER, who.token.c_str());
    } else if (!who.user.empty()) {
        handle.set(CURLOPT_HTTPAUTH, long{CURLAUTH_BASIC});
        handle.set(CURLOPT_USERNAME, who.user.c_str());
        handle.set(CURLOPT_PASSWORD, who.password.c_str());
    }
}

void Http::prepare(const Request& request, const std::string& url, Transfer& transfer) {
    Handle& handle = *handle_;
    libcurl().easy_reset(handle.curl);  // the connection stays
    handle.reason[0] = '\0';
    handle.set(CURLOPT_ERRORBUFFER, handle.reason.data());
    handle.set(CURLOPT_URL, url.c_str());
    handle.set(CURLOPT_PROTOCOLS_STR, "http,https");
    handle.set(CURLOPT_FOLLOWLOCATION, 0L);
    handle.set(CURLOPT_NOSIGNAL, 1L);
    handle.set(CURLOPT_USERAGENT, "kontur/" KONTUR_VERSION);
    handle.set(CURLOPT_CONNECTTIMEOUT, kConnectSeconds);
    handle.set(CURLOPT_LOW_SPEED_LIMIT, kLeastBytesPerSecond);
    handle.set(CURLOPT_LOW_SPEED_TIME, static_cast<long>(access_.give_up_s));
    handle.set(CURLOPT_TIMEOUT, static_cast<long>(request.most_seconds));
    handle.set(CURLOPT_BUFFERSIZE, kBufferBytes);
    handle.set(CURLOPT_WRITEFUNCTION, &Transfer::on_bytes);
    handle.set(CURLOPT_WRITEDATA, &transfer);
    handle.set(CURLOPT_XFERINFOFUNCTION, &Transfer::on_progress);
    handle.set(CURLOPT_XFERINFODATA, &transfer);
    handle.set(CURLOPT_NOPROGRESS, 0L);
    for (const std::string& header : request.headers) transfer.headers.add(header);
    if (request.body) {
        transfer.headers.add("Expect:");  // no wait for a "100 Continue" that few archives send
        handle.set(CURLOPT_POST, 1L);
        handle.set(CURLOPT_POSTFIELDSIZE_LARGE, static_cast<curl_off_t>(request.body_bytes));
        handle.set(CURLOPT_READFUNCTION, &Transfer::on_room);
        handle.set(CURLOPT_READDATA, &transfer);
    }
    handle.set(CURLOPT_HTTPHEADER, transfer.headers.first);
    choose_access();
}

Error Http::failure(int code, const Request& request, const Transfer& transfer) const {
    const std::string host = service_.host();
    const std::string reason =
        printable_utf8(handle_->reason[0] ? handle_->reason.data() : libcurl().easy_strerror(static_cast<CURLcode>(code)));
    double seconds = 0;
    libcurl().easy_getinfo(handle_->curl, CURLINFO_PRETRANSFER_TIME, &seconds);
    const bool was_reached = seconds > 0;
    if (transfer.is_too_large)
        return {ErrorKind::too_large,
                fmt::format("the answer of {} has more than {} bytes, the limit", host, request.most_bytes)};
    if (code == CURLE_PEER_FAILED_VERIFICATION)
        return {ErrorKind::io, fmt::format("the certificate of {} is not trusted ({}); --ca FILE names the certificate of a "
                                           "private authority",
                                           host, reason)};
    if (code == CURLE_SSL_CACERT_BADFILE)
        return {ErrorKind::io, fmt::format("--ca {} holds no certificate that can be read", access_.ca.string())};
    if (code == CURLE_OPERATION_TIMEDOUT && was_reached && request.most_seconds > 0 && transfer.took_all_its_time())
        return {ErrorKind::io, fmt::format("{} was not done with its answer after {} s", host, request.most_seconds)};
    if (code == CURLE_OPERATION_TIMEDOUT && was_reached)
        return {ErrorKind::io, fmt::format("{} sent less than {} bytes a second for {} s; --give-up-s waits longer", host,
                                           kLeastBytesPerSecond, access_.give_up_s)};
    if (was_reached) return {ErrorKind::io, fmt::format("the answer of {} ended early ({})", host, reason)};
    return {ErrorKind::io, fmt::format("cannot reach {} ({})", host, reason)};
}

std::string Http::redirected(const std::string& url) const {
    const char* next = nullptr;
    libcurl().easy_getinfo(handle_->curl, CURLINFO_REDIRECT_URL, &next);
    if (!next) return "";
    const std::string here = origin_of(url.c_str()), there = origin_of(next);
    if (here == there) return next;
    throw Error(ErrorKind::io,
                fmt::format("{} leads on to {}, where nothing is asked or sent; name that address if it is the archive",
                            here, printable_utf8(there)));
}

Answer Http::ask(const Request& request, const Work& work, AnswerSink* sink) {
    std::string url = service_.service + request.path;
    for (int redirects = 0;; ++redirects) {
        Transfer transfer{.request = request, .work = work, .sink = sink, .curl = handle_->curl};
        prepare(request, url, transfer);
        const CURLcode code = libcurl().easy_perform(handle_->curl);
        if (transfer.failure) std::rethrow_exception(transfer.failure);
        if (code != CURLE_OK) {
            work.check();
            throw failure(code, request, transfer);
        }
        if (!transfer.has_begun && !transfer.guarded([&] { transfer.begin(); })) std::rethrow_exception(transfer.failure);
        const bool leads_on = transfer.answer.status >= 300 && transfer.answer.status < 400;
        const std::string next = leads_on ? redirected(url) : "";
        if (next.empty() || request.body) return std::move(transfer.answer);
        if (redirects == kMostRedirects)
            throw Error(ErrorKind::io, fmt::format("{} leads on more than {} times", service_.host(), kMostRedirects));
        url = next;
    }
}

}  // namespace kontur::archive
