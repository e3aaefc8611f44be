// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "archive/address.h"
#include "archive/credentials.h"
#include "kontur/base/error.h"
#include "kontur/base/work.h"

namespace kontur::archive {

/// How an archive may be reached.
struct Access {
    Credentials credentials;
    std::filesystem::path ca;  ///< certificates (PEM) of authorities that are trusted; empty: the system's
    int give_up_s = 60;        ///< after so long with less than 1 kB/s
};

/// Throws what `read_credentials` throws, Error(io) for a file of certificates that is not there, and Error(invalid_input)
/// for less than a second.
Access read_access(const std::filesystem::path& credentials, const std::filesystem::path& ca, int give_up_s);

struct Request {
    std::string path;                  ///< behind the service, with its query: "/studies?limit=10"
    std::vector<std::string> headers;  ///< "Name: value"
    /// What is sent, by POST: fills the buffer, 0 at the end. Empty: a GET.
    std::function<std::size_t(char* buffer, std::size_t size)> body;
    std::uint64_t body_bytes = 0;
    std::uint64_t most_bytes = 0;  ///< of the answer
    int most_seconds = 0;          ///< for all of it; 0: as long as it goes on
};

struct Answer {
    int status = 0;
    std::string content_type;
    std::string body;  ///< of answers without a sink, and of those that are no success
};

/// Called with a successful answer's type, then with its pieces, and once a second at least while none comes.
struct AnswerSink {
    virtual ~AnswerSink() = default;
    virtual void begin(const Answer& answer) = 0;
    virtual void piece(std::string_view bytes) = 0;
    virtual void wait() {}
};

/// HTTP with one archive, over one connection that is kept. Not for concurrent use.
///
/// Certificates are verified. A redirect is followed on the same scheme, host and port only, and only for GET. Compressed
/// answers are not asked for, so that no answer grows on the way.
class Http {
public:
    /// Throws Error(invalid_input) for credentials that would go over a network unencrypted.
    Http(const Address& service, const Access& access);
    ~Http();
    Http(const Http&) = delete;
    Http& operator=(const Http&) = delete;

    const Address& service() const { return service_; }
    const Access& access() const { return access_; }

    /// Whatever status the answer has. Throws Error(io) for an archive that cannot be reached, whose certificate is not
    /// trusted, which falls silent, ends early or leads elsewhere; Error(too_large) beyond `most_bytes`; Error(cancelled);
    /// what the sink throws.
    Answer ask(const Request& request, const Work& work, AnswerSink* sink = nullptr);

private:
    struct Transfer;
    struct Handle;
    void prepare(const Request& request, const std::string& url, Transfer& transfer);
    void choose_access();
    Error failure(int code, const Request& request, const Transfer& transfer) const;
    std::string redirected(const std::string& url) const;

    Address service_;
    Access access_;
    std::unique_ptr<Handle> handle_;
};

}  // namespace kontur::archive
