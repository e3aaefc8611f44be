// SPDX-License-Identifier: Apache-2.0
#include "archive/rendered.h"

#include <fmt/format.h>

#include <vector>

#include "archive/query.h"
#include "archive/refusal.h"
#include "kontur/base/error.h"

namespace kontur::archive {
namespace {

constexpr std::uint64_t kMostPictureBytes = std::uint64_t{4} << 20;
constexpr int kMostPictureSeconds = 60, kPixels = 112;

}  // namespace

std::string picture_of(Http& http, const Address& series, const Work& work) {
    const std::vector<Instance> all = find_instances(http, series, work);
    const Address middle{series.service, series.study_uid, series.series_uid, all[all.size() / 2].uid};
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
