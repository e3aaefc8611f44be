// SPDX-License-Identifier: Apache-2.0
#include "kontur/io/dicom/dicom_folder.h"

#include <fmt/format.h>

#include <algorithm>

#include "kontur/base/error.h"
#include "kontur/io/dicom/dicom_header.h"

namespace kontur {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostFiles = 200'000;
constexpr int kDeepest = 30;

/// One folder's content, in no order.
struct Listing {
    std::vector<fs::path> files, folders;
};

class Search {
public:
    explicit Search(fs::path folder) : folder_(std::move(folder)) {}

    Listing list(const fs::path& folder) {
        Listing found;
        std::error_code failure;
        for (fs::directory_iterator entry(folder, failure), end; !failure && entry != end; entry.increment(failure))
            take(*entry, found);
        if (failure) throw Error(ErrorKind::io, fmt::format("cannot read {}: {}", folder.string(), failure.message()));
        return found;
    }

    void add(Listing listing, int depth = 0) {
        if (depth > kDeepest)
            throw Error(ErrorKind::too_large,
                        fmt::format("{}: its folders lie in each other more than {} deep; name the folder of the images",
                                    folder_.string(), kDeepest));
        std::move(listing.files.begin(), listing.files.end(), std::back_inserter(result_.files));
        if (result_.files.size() > kMostFiles)
            throw Error(ErrorKind::too_large, fmt::format("{} holds more than {} files; name the folder of the images",
                                                          folder_.string(), kMostFiles));
        if (result_.nested)
            for (const fs::path& folder : listing.folders) add(list(folder), depth + 1);
    }

    void set_nested() { result_.nested = true; }
    void set_unsearched(const Listing& listing) {
        for (const fs::path& folder : listing.folders) result_.unsearched.push_back(name_of(folder));
    }

    DicomFolder result() && {
        std::sort(result_.files.begin(), result_.files.end());
        std::sort(result_.unsearched.begin(), result_.unsearched.end());
        for (auto& [reason, names] : result_.left_out) std::sort(names.begin(), names.end());
        return std::move(result_);
    }

private:
    std::string name_of(const fs::path& path) const { return path.lexically_relative(folder_).string(); }

    void take(const fs::directory_entry& entry, Listing& found) {
        std::error_code unreachable, ignored;
        const fs::file_status status = entry.status(unreachable);
        const std::string name = entry.path().filename().string();
        if (fs::is_regular_file(status)) found.files.push_back(entry.path());
        else if (fs::is_directory(status) && entry.is_symlink(ignored))
            result_.left_out["link to a folder, which is not followed"].push_back(name_of(entry.path()));
        else if (fs::is_directory(status) && !name.starts_with('.')) found.folders.push_back(entry.path());
        if (unreachable && unreachable != std::errc::no_such_file_or_directory)
            result_.left_out[unreachable.message()].push_back(name_of(entry.path()));
    }

    fs::path folder_;
    DicomFolder result_;
};

bool holds_image(std::vector<fs::path> files) {
    std::sort(files.begin(), files.end());  // slices come together, and the first of them ends the search
    return std::any_of(files.begin(), files.end(), [](const fs::path& file) {
        const auto content = read_dicom_headers(file);
        const auto* slices = std::get_if<std::vector<DicomHeader>>(&content);
        const auto* damaged = std::get_if<DamagedImage>(&content);
        // A dose lies beside its plan, and the images in a folder of their own.
        return (slices && slices->front().dose_unit.empty()) || (damaged && damaged->series_uid);
    });
}

}  // namespace

DicomFolder dicom_files_in(const fs::path& folder) {
    Search search(folder);
    search.add(search.list(folder));
    return std::move(search).result();
}

DicomFolder dicom_folder(const fs::path& folder) {
    Search search(folder);
    Listing own = search.list(folder);
    if (!own.folders.empty()) {
        if (holds_image(own.files)) search.set_unsearched(own);
        else search.set_nested();
    }
    search.add(std::move(own));
    return std::move(search).result();
}

}  // namespace kontur
