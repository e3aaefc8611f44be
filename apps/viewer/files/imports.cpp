// SPDX-License-Identifier: Apache-2.0
#include "viewer/files/imports.h"

#include <fmt/format.h>

#include <new>
#include <nlohmann/json.hpp>
#include <optional>

#include "kontur/base/error.h"
#include "kontur/io/bytes/atomic_file.h"
#include "kontur/io/contours.h"
#include "viewer/files/import_process.h"
#include "viewer/files/import_reading.h"
#include "viewer/model/model_json.h"
#include "viewer/model/temporary_files.h"

namespace kontur::viewer {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr const char* kResult = "result.json";

// In the process that reads

json to_json(const std::vector<TracedMask>& all) {
    json list = json::array();
    for (const TracedMask& one : all)
        list.push_back({{"name", one.name}, {"volume_ml", one.volume_ml}, {"traced_ml", one.traced_ml}, {"dice", one.dice}});
    return list;
}

std::string mask_file(std::size_t place) { return fmt::format("{}.mask", place); }

/// Writes them, and returns their places and headers.
json written_masks(const ImportedMasks& masks) {
    json list = json::array();
    for (const auto& [place, one] : masks) {
        write_file_atomically(mask_file(place), one.mask->packed());
        list.push_back({{"place", place}, {"header", one.mask->header()}, {"source", one.source}});
    }
    return list;
}

json result_of(const Upload& upload) {
    const fs::path path = "upload" + upload.extension;
    const ImportContent imported = read_import(path, upload);
    for (std::size_t i = 0; i < imported.sets.size(); ++i) write_contours(fmt::format("{}.json", i), imported.sets[i]);
    return {{"sets", imported.sets.size()},
            {"notes", imported.notes},
            {"frame", imported.frame_of_reference_uid},
            {"patient", imported.patient},
            {"label_values", imported.label_values},
            {"traced", to_json(imported.traced)},
            {"masks", written_masks(imported.masks)}};
}

json error_json(ErrorKind kind, std::string_view sentence) {
    return {{"kind", std::string(name(kind))}, {"message", std::string(sentence)}};
}

/// The reader's sentence without the name that the file has here, which the user never gave.
json error_of(const Error& error, const Upload& upload) {
    std::string sentence = error.what();
    const std::string path = "upload" + upload.extension;
    for (std::size_t at; (at = sentence.find(path)) != std::string::npos;) sentence.replace(at, path.size(), "the file");
    return error_json(error.kind(), sentence);
}

// In the server

[[noreturn]] void fail(const json& error) {
    const std::string kind = error.at("kind"), sentence = error.at("message");
    for (const ErrorKind known : {ErrorKind::invalid_input, ErrorKind::unsupported, ErrorKind::corrupt_file, ErrorKind::io,
                                  ErrorKind::singular_system, ErrorKind::too_large})
        if (name(known) == kind) throw Error(known, sentence);
    throw Error(ErrorKind::corrupt_file, sentence);
}

ImportContent result_in(const fs::path& folder, int status, const Work& work) {
    std::error_code ignored;
    if (!fs::exists(folder / kResult, ignored)) {
        check_ended_in_time(status);
        throw Error(ErrorKind::corrupt_file,
                    "the file cannot be read: reading it failed in a way that kontur did not foresee. Nothing was changed");
    }
    const json result = json::parse(read_bytes(folder / kResult));
    if (result.contains("error")) fail(result["error"]);
    ImportContent imported;
    for (std::size_t i = 0; i < result.at("sets").get<std::size_t>(); ++i) {
        work.check();
        imported.sets.push_back(read_contours(folder / fmt::format("{}.json", i)).contours);
    }
    imported.notes = result.at("notes").get<std::vector<std::string>>();
    imported.frame_of_reference_uid = result.at("frame").get<std::string>();
    imported.patient = result.at("patient").get<std::string>();
    imported.label_values = result.at("label_values").get<LabelValues>();
    for (const json& one : result.at("traced"))
        imported.traced.push_back({one.at("name"), one.at("volume_ml"), one.at("traced_ml"), one.at("dice")});
    for (const json& one : result.at("masks")) {
        work.check();
        const auto place = one.at("place").get<std::size_t>();
        imported.masks[place] = {
            std::make_shared<const StoredMask>(one.at("header").get<std::string>(), read_bytes(folder / mask_file(place))),
            one.at("source").get<std::string>()};
    }
    return imported;
}

}  // namespace

ImportContent import_apart(const std::string& bytes, const Upload& upload, const Work& work) {
    const TemporaryFolder folder;
    write_file_atomically(folder.path() / ("upload" + upload.extension), bytes);
    const int status = run_import_process(upload, folder.path(), work);
    return result_in(folder.path(), status, work);
}

int import_worker(int argc, char** argv) {
    const std::optional<Upload> upload = begin_import_process(argc, argv);
    if (!upload) return exit_code(ErrorKind::invalid_input);
    json result;
    try {
        result = result_of(*upload);
    } catch (const Error& error) {
        result["error"] = error_of(error, *upload);
    } catch (const std::bad_alloc&) {
        result["error"] = error_json(ErrorKind::too_large, "the file needs more memory than an import may use");
    } catch (const std::exception& error) {
        result["error"] = error_json(ErrorKind::corrupt_file, fmt::format("the file cannot be read: {}", error.what()));
    }
    write_file_atomically(kResult, to_text(result));
    return 0;
}

}  // namespace kontur::viewer
