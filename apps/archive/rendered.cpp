// SPDX-License-Identifier: Apache-2.0
#include "archive/rendered.h"

#include <fmt/format.h>

#include <cstdint>
#include <vector>

#include "archive/query.h"
#include "archive/refusal.h"
#include "kontur/base/error.h"

namespace kontur::archive {
namespace {

constexpr std::uint64_t kMostPictureBytes = std::uint64_t{4} << 20;
constexpr int kMostPictureSeconds = 60, kPixels = 112;

/// By the number that it has in a series that begins with 1, else of the list.
std::string middle_of(Http& http, const Address& series, const Work& work) {
    if (const std::int64_t count = count_instances(http, series, work); count > 0)
        if (const auto found = find_numbered(http, series, (count + 1) / 2, work)) return found->uid;
    const std::vector<Instance> all = find_instances(http, series, work);
    return all[all.size() / 2].uid;
}

}  // namespace

std::string picture_of(Http& http, const Address& series, const Work& work) {
    const Address middle{series.service, series.study_uid, series.series_uid, middle_of(http, series, work)};
    Request request;
    request.path = fmt::format("{}/rendered?viewport={},{}", middle.text().substr(middle.service.size()), kPixels, kPixels);
    request.headers = {"Accept: image/jpeg"};
    request.most_bytes = kMostPictureBytes;
    request.most_seconds = kMostPictureSeconds;
    const Answer answer = http.ask(request, work);
    if (answer.status != 200) throw refusal(answer, http, "a picture of " + middle.text());
    if (!answer.body.starts_with("\xff\xd8\xff"))
        throw Error(ErrorKind::corrupt_file, fmt::format("{} sends no JPEG as a picture", http.service().host()));
    return answer.body;
}

}  // namespace kontur::archive
