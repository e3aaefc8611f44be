// SPDX-License-Identifier: Apache-2.0
#include "viewer/server/access.h"

#include <fmt/format.h>
#include <sys/random.h>

#include <algorithm>
#include <array>

#include "kontur/base/error.h"

namespace kontur::viewer {
namespace {

bool is_ours(const std::string& host, std::uint16_t port) {
    return host == fmt::format("127.0.0.1:{}", port) || host == fmt::format("localhost:{}", port) ||
           host == fmt::format("[::1]:{}", port);
}

/// Takes the same time wherever the two differ, so that the time does not tell the token.
bool same_secret(std::string_view a, std::string_view b) {
    unsigned char difference = a.size() == b.size() ? 0 : 1;
    for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i)
        difference = static_cast<unsigned char>(difference | (a[i] ^ b[i]));
    return difference == 0;
}

bool has_token(const RequestHead& head, const std::string& token) {
    if (!head.is_upgrade) return head.authorization.size() == 1 && same_secret(head.authorization[0], "Bearer " + token);
    // Browsers let a page set no header of a WebSocket but the list of protocols: "kontur, TOKEN".
    return head.protocols.size() == 1 && same_secret(head.protocols[0], "kontur, " + token);
}

/// Fails closed: a target that cannot be read may be anything.
bool is_api(const std::optional<Target>& target) { return !target || target->path.starts_with("/api/"); }

std::optional<int> hex_digit(char c) {
    if (c >= '0' && c <= '9') return c - '0';
    if (c >= 'a' && c <= 'f') return c - 'a' + 10;
    if (c >= 'A' && c <= 'F') return c - 'A' + 10;
    return std::nullopt;
}

/// In a query a space is a "+", as forms write it.
enum class Part { path, query };

std::optional<std::string> decoded(std::string_view text, Part part) {
    std::string result;
    for (std::size_t i = 0; i < text.size(); ++i) {
        if (text[i] == '+' && part == Part::query) {
            result += ' ';
            continue;
        }
        if (text[i] != '%') {
            result += text[i];
            continue;
        }
        if (i + 2 >= text.size()) return std::nullopt;
        const auto high = hex_digit(text[i + 1]), low = hex_digit(text[i + 2]);
        if (!high || !low) return std::nullopt;
        result += static_cast<char>(*high * 16 + *low);
        i += 2;
    }
    return result;
}

}  // namespace

std::optional<Refusal> refusal(const RequestHead& head, const Access& access) {
    if (head.host.size() != 1 || !is_ours(head.host[0], access.port))
        return Refusal{421, "forbidden", "the request names another host; open the address that kontur printed"};
    const bool needs_origin = head.is_upgrade || head.method == "POST";
    if (head.origin.size() > 1 || (needs_origin && head.origin.empty()) ||
        (!head.origin.empty() && head.origin[0] != "http://" + head.host[0]))
        return Refusal{403, "forbidden", "the request comes from another page"};
    if (is_api(head.target) && !has_token(head, access.token))
        return Refusal{401, "forbidden", "the token is missing or wrong; open the address that kontur printed"};
    if (head.method != "GET" && head.method != "POST") return Refusal{405, "unsupported", "only GET and POST are supported"};
    return std::nullopt;
}

bool shows_token(const RequestHead& head, const Access& access) { return has_token(head, access.token); }

std::string random_token() {
    std::array<unsigned char, 16> bytes{};
    if (getrandom(bytes.data(), bytes.size(), 0) != static_cast<ssize_t>(bytes.size()))
        throw Error(ErrorKind::io, "the system gives no random numbers for the server's token");
    std::string token;
    for (const unsigned char byte : bytes) token += fmt::format("{:02x}", byte);
    return token;
}

std::optional<std::string> Target::parameter(std::string_view name) const {
    for (const auto& [key, value] : query)
        if (key == name) return value;
    return std::nullopt;
}

std::optional<Target> parse_target(std::string_view target) {
    if (!target.starts_with('/')) return std::nullopt;
    const std::size_t mark = target.find('?');
    const auto path = decoded(target.substr(0, mark), Part::path);
    if (!path) return std::nullopt;
    Target result{*path, {}};
    std::string_view rest = mark == std::string_view::npos ? std::string_view() : target.substr(mark + 1);
    while (!rest.empty()) {
        const std::size_t end = rest.find('&');
        const std::string_view item = rest.substr(0, end);
        const std::size_t equals = item.find('=');
        const auto key = decoded(item.substr(0, equals), Part::query);
        const auto value =
            decoded(equals == std::string_view::npos ? std::string_view() : item.substr(equals + 1), Part::query);
        if (!key || !value) return std::nullopt;
        result.query.emplace_back(*key, *value);
        rest = end == std::string_view::npos ? std::string_view() : rest.substr(end + 1);
    }
    return result;
}

}  // namespace kontur::viewer
