// SPDX-License-Identifier: Apache-2.0
#include "archive/multipart.h"

#include <fmt/format.h>
#include <string.h>

#include <algorithm>

#include "kontur/base/error.h"
#include "kontur/base/printable.h"

namespace kontur::archive {
namespace {

constexpr std::size_t kMostBorder = 70;         // by RFC 2046
constexpr std::size_t kMostBytesBefore = 4096;  // of what stands before the first border, and of a part's head
constexpr std::string_view kName = "boundary=";

[[noreturn]] void refuse(const std::string& sentence) { throw Error(ErrorKind::corrupt_file, sentence); }

/// Many times as fast as std::search.
std::size_t place_of(std::string_view what, std::string_view text) {
    const void* found = ::memmem(text.data(), text.size(), what.data(), what.size());
    return found ? static_cast<std::size_t>(static_cast<const char*>(found) - text.data()) : std::string_view::npos;
}

}  // namespace

std::string border_of(std::string_view content_type) {
    const std::string small = lower_case(content_type);
    if (!small.starts_with("multipart/related"))
        refuse(fmt::format("the archive answers with '{}' in place of multipart/related", shortened(content_type, 100)));
    const std::size_t name = small.find(kName);
    std::string_view rest = name == std::string::npos ? "" : content_type.substr(name + kName.size());
    const bool is_quoted = rest.starts_with('"');
    if (is_quoted) rest.remove_prefix(1);
    const std::string_view border = rest.substr(0, rest.find_first_of(is_quoted ? "\"" : "; \t"));
    if (border.empty() || border.size() > kMostBorder)
        refuse(fmt::format("the archive's answer names no border of its parts: '{}'", shortened(content_type, 200)));
    return std::string(border);
}

MultipartReader::MultipartReader(const std::string& border, PartSink& sink) : mark_("\r\n--" + border), sink_(sink) {}

void MultipartReader::feed(std::string_view bytes) {
    if (place_ == Place::behind) return;
    rest_ += bytes;
    while (step()) {
    }
}

void MultipartReader::finish() const {
    if (place_ == Place::behind) return;
    if (place_ == Place::before) refuse("the border of the parts, which the archive's answer names, does not come in it");
    throw Error(ErrorKind::io, "the archive's answer ended early, before the last border of its parts");
}

/// Whether there may be more to understand.
bool MultipartReader::step() {
    switch (place_) {
        case Place::before:
        case Place::part:
            return pass_to_border();
        case Place::at_border:
            return pass_border();
        case Place::head:
            return pass_head();
        case Place::behind:
            break;
    }
    return false;
}

bool MultipartReader::pass_to_border() {
    const std::size_t mark = place_of(mark_, rest_);
    const bool is_there = mark != std::string_view::npos;
    // What may be the beginning of a border stays.
    const std::size_t passed = is_there ? mark : rest_.size() - std::min(rest_.size(), mark_.size() - 1);
    if (place_ == Place::part) {
        if (passed > 0) sink_.piece(std::string_view(rest_).substr(0, passed));
        if (is_there) sink_.end_part();
        rest_.erase(0, passed);
    } else if (passed > kMostBytesBefore) {
        refuse("the border of the parts, which the archive's answer names, does not come in it");
    }
    if (!is_there) return false;
    rest_.erase(0, (place_ == Place::part ? 0 : mark) + mark_.size());
    place_ = Place::at_border;
    return true;
}

/// The line goes on with "--" behind the last part.
bool MultipartReader::pass_border() {
    if (rest_.size() < 2) return false;
    if (rest_.starts_with("--")) {
        place_ = Place::behind;
        rest_.clear();
        return false;
    }
    const std::size_t end = rest_.find("\r\n"), other = rest_.find_first_not_of(" \t");
    if (end == std::string::npos && (other == std::string::npos || rest_[other] == '\r') && rest_.size() < kMostBytesBefore)
        return false;
    if (end != other) refuse("a border of the archive's parts does not end its line");
    rest_.erase(0, end);  // a head without lines ends with this line end and the next
    place_ = Place::head;
    return true;
}

bool MultipartReader::pass_head() {
    const std::size_t end = rest_.find("\r\n\r\n");
    if (std::min(end, rest_.size()) > kMostBytesBefore) refuse("the head of a part of the archive's answer does not end");
    if (end == std::string::npos) return false;
    rest_.erase(0, end + 4);
    // A part without content ends with the line end that its head ends with.
    place_ = Place::part;
    sink_.begin_part();
    return true;
}

}  // namespace kontur::archive
