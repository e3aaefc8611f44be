// SPDX-License-Identifier: Apache-2.0
#include "archive/credentials.h"

#include <fmt/format.h>
#include <sys/stat.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <system_error>

#include "kontur/base/error.h"

namespace kontur::archive {
namespace {

constexpr std::size_t kMostBytes = 65536;  // tokens have some thousands
constexpr std::string_view kBearer = "Bearer ";

std::string content_of(const std::filesystem::path& file) {
    struct stat status {};
    if (::stat(file.c_str(), &status) != 0)
        throw Error(ErrorKind::io, fmt::format("cannot read {}: {}", file.string(), std::generic_category().message(errno)));
    if (!S_ISREG(status.st_mode))
        throw Error(ErrorKind::invalid_input, fmt::format("--credentials {} is no regular file", file.string()));
    if ((status.st_mode & (S_IRWXG | S_IRWXO)) != 0)
        throw Error(ErrorKind::invalid_input,
                    fmt::format("others may read --credentials {0}; take that away first: chmod 600 {0}", file.string()));
    std::ifstream stream(file, std::ios::binary);
    if (!stream) throw Error(ErrorKind::io, fmt::format("cannot read {}", file.string()));
    std::string content(kMostBytes, '\0');
    stream.read(content.data(), static_cast<std::streamsize>(content.size()));
    content.resize(static_cast<std::size_t>(stream.gcount()));
    return content;
}

Credentials parsed(std::string line, const std::string& origin) {
    while (!line.empty() && (line.back() == '\n' || line.back() == '\r')) line.pop_back();
    const bool is_one_line = std::none_of(line.begin(), line.end(), [](unsigned char c) { return c < ' ' || c == 0x7f; });
    Credentials credentials;
    credentials.origin = origin;
    const std::size_t colon = line.find(':');
    if (line.starts_with(kBearer)) {
        credentials.token = line.substr(kBearer.size());
    } else if (colon != std::string::npos) {
        credentials.user = line.substr(0, colon);
        credentials.password = line.substr(colon + 1);
    }
    if (is_one_line && !credentials.is_empty()) return credentials;
    throw Error(ErrorKind::invalid_input,
                fmt::format("{} holds neither user:password nor Bearer TOKEN, in one line", origin));
}

}  // namespace

Credentials read_credentials(const std::filesystem::path& file) {
    if (!file.empty()) return parsed(content_of(file), "--credentials " + file.string());
    const char* line = std::getenv(kCredentialsVariable);
    return line && *line ? parsed(line, kCredentialsVariable) : Credentials();
}

}  // namespace kontur::archive
