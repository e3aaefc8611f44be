// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace kontur::archive {

/// Who takes the parts of an answer, in their order.
struct PartSink {
    virtual ~PartSink() = default;
    virtual void begin_part() = 0;
    virtual void piece(std::string_view bytes) = 0;
    virtual void end_part() = 0;
};

/// The border between parts that a Content-Type names, such as `multipart/related; type="application/dicom"; boundary=b`.
/// Throws Error(corrupt_file) for another type, and for a border that is missing or none (RFC 2046, 5.1.1).
std::string border_of(std::string_view content_type);

/// Takes a multipart body (RFC 2046, 5.1) apart as it comes, in pieces of any size. Keeps no more of a part than a border is
/// long.
class MultipartReader {
public:
    MultipartReader(const std::string& border, PartSink& sink);

    /// Throws Error(corrupt_file) for a body without the border, or with a head of a part that does not end.
    void feed(std::string_view bytes);
    /// Throws Error(io) unless the last border has come.
    void finish() const;

private:
    enum class Place { before, at_border, head, part, behind };
    bool step();
    bool pass_to_border();
    bool pass_border();
    bool pass_head();

    std::string mark_;  ///< line end, two hyphens, border
    PartSink& sink_;
    std::string rest_ = "\r\n";  ///< not yet understood; the first border may stand without a line end before it
    Place place_ = Place::before;
};

}  // namespace kontur::archive
