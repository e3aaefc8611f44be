// SPDX-License-Identifier: Apache-2.0
#include "viewer/store/project.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <nlohmann/json.hpp>

#include "kontur/base/error.h"
#include "viewer/model/model_json.h"

namespace kontur::viewer {
namespace {

using nlohmann::json;

constexpr int kApplicationId = 0x6b6f6e74;  // "kont"
constexpr int kVersion = 1;                 // of a project without masks, which older versions of kontur can open
constexpr int kVersionWithMasks = 2;        // the table is made with the first one
constexpr int kVersionWithTimes = 3;        // since the first contour of another time; older ones would take it for any
constexpr int kVersionWithRules = 4;    // since the first structure that a rule makes; older ones would see nothing of it
constexpr int kVersionWithReviews = 5;  // since something was first said in review; older ones would change what is locked
constexpr int kNewestVersion = kVersionWithReviews;

constexpr const char* kSchema =
    "CREATE TABLE setting (key TEXT PRIMARY KEY, value TEXT NOT NULL) WITHOUT ROWID;"
    "CREATE TABLE structure (id INTEGER PRIMARY KEY, data TEXT NOT NULL);"
    "CREATE TABLE contour (id INTEGER PRIMARY KEY, data TEXT NOT NULL);"
    "CREATE TABLE history (number INTEGER PRIMARY KEY, label TEXT NOT NULL, time TEXT NOT NULL, changes TEXT NOT NULL);";

constexpr const char* kMaskTable =
    "CREATE TABLE IF NOT EXISTS mask (hash TEXT PRIMARY KEY, header TEXT NOT NULL, packed BLOB NOT NULL);";

Structure row_from(const json& value, const Structure*) { return structure_from_json(value); }
DrawnContour row_from(const json& value, const DrawnContour*) { return contour_from_json(value, kStoredLimits); }

/// Of projects of before the text is empty.
ImageChoice choice_from(const std::string& text) { return text.empty() ? ImageChoice{} : choice_from_json(parsed(text)); }

std::vector<ImageReference> references_from(const std::string& text) {
    std::vector<ImageReference> references;
    if (text.empty()) return references;
    for (const json& item : parsed(text)) references.push_back(reference_from_json(item));
    return references;
}

template <class Row>
json to_json(const std::vector<Change<Row>>& changes) {
    json array = json::array();
    for (const Change<Row>& change : changes) {
        json item{{"id", change.id}};
        if (change.before) item["before"] = viewer::to_json(*change.before);
        if (change.after) item["after"] = viewer::to_json(*change.after);
        array.push_back(std::move(item));
    }
    return array;
}

template <class Row>
std::vector<Change<Row>> changes_from(const json& array) {
    std::vector<Change<Row>> changes;
    for (const json& item : array) {
        Change<Row> change;
        change.id = Members(item).id("id");
        if (item.contains("before")) change.before = row_from(item["before"], static_cast<Row*>(nullptr));
        if (item.contains("after")) change.after = row_from(item["after"], static_cast<Row*>(nullptr));
        changes.push_back(std::move(change));
    }
    return changes;
}

template <class Row>
void turn_back(std::vector<Change<Row>>& changes) {
    for (Change<Row>& change : changes) std::swap(change.before, change.after);
}

/// Of steps and projects from before structures shared borders there is none.
std::optional<BordersChange> borders_change_from(const json& changes) {
    if (!changes.contains("borders")) return std::nullopt;
    const json& change = changes["borders"];
    return BordersChange{borders_from_json(change.at("before")), borders_from_json(change.at("after"))};
}

/// Of steps from before the image was asked there is none.
std::optional<UseImageChange> use_image_change_from(const json& changes) {
    if (!changes.contains("use_image")) return std::nullopt;
    const Members change(changes["use_image"]);
    return UseImageChange{change.flag("before"), change.flag("after")};
}

json to_json(const std::optional<double>& cycle) { return cycle ? json(*cycle) : json(nullptr); }

std::optional<double> cycle_from(const json& value) {
    if (value.is_null()) return std::nullopt;
    constexpr double kMost = 1e6;
    if (!value.is_number() || !(value.get<double>() >= 0 && value.get<double>() <= kMost))
        throw Error(ErrorKind::invalid_input, "the cycle is no number of frames");
    return value.get<double>();
}

/// Of steps from before contours had times there is none.
std::optional<CycleChange> cycle_change_from(const json& changes) {
    if (!changes.contains("cycle_frames")) return std::nullopt;
    return CycleChange{cycle_from(changes["cycle_frames"].at("before")), cycle_from(changes["cycle_frames"].at("after"))};
}

/// `body()`, with everything that JSON or our own checks find wrong told as damage of the file.
template <class Body>
auto reading(const Database& database, Body body) {
    const auto damaged = [&](const char* reason) {
        return Error(ErrorKind::corrupt_file, fmt::format("{} is damaged: {}", database.path().string(), reason));
    };
    try {
        return body();
    } catch (const json::exception& error) {
        throw damaged(error.what());
    } catch (const Error& error) {
        if (error.kind() == ErrorKind::invalid_input) throw damaged(error.what());
        throw;
    }
}

template <class Row>
void write_rows(Database& database, const std::vector<Change<Row>>& changes, const char* set, const char* remove) {
    for (const Change<Row>& change : changes) {
        if (change.after) Query(database, set).bind(change.id).bind(to_text(viewer::to_json(*change.after))).finish();
        else Query(database, remove).bind(change.id).finish();
    }
}

void check_format(const std::filesystem::path& path, std::int64_t application_id, std::int64_t version) {
    if (application_id != kApplicationId)
        throw Error(ErrorKind::corrupt_file, fmt::format("{} is no kontur project", path.string()));
    if (version < kVersion || version > kNewestVersion)
        throw Error(ErrorKind::unsupported,
                    fmt::format("{} was written by a newer kontur: its version is {}, {} is supported", path.string(),
                                version, kNewestVersion));
}

/// `path`, once its first bytes say that it is ours, or new: SQLite alters the files of others already by opening them our
/// way. (https://www.sqlite.org/fileformat2.html, "The Database Header")
const std::filesystem::path& checked(const std::filesystem::path& path) {
    constexpr std::string_view kMagic("SQLite format 3\0", 16);
    constexpr std::size_t kHeaderBytes = 100, kVersionAt = 60, kApplicationIdAt = 68;
    // With a journal beside it the header may be half-written, and SQLite has to repair it first.
    std::error_code error;
    if (std::filesystem::exists(path.string() + "-journal", error)) return path;
    const auto status = std::filesystem::status(path, error);
    if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status))
        throw Error(ErrorKind::io, fmt::format("cannot open {}: it is no regular file", path.string()));
    std::array<char, kHeaderBytes> header{};
    std::ifstream file(path, std::ios::binary);
    file.read(header.data(), kHeaderBytes);
    if (file.gcount() == 0) return path;
    const auto number = [&](std::size_t at) {
        std::uint32_t value = 0;
        for (std::size_t i = at; i < at + 4; ++i) value = value << 8 | static_cast<unsigned char>(header[i]);
        return static_cast<std::int64_t>(value);
    };
    const bool is_database = std::string_view(header.data(), kMagic.size()) == kMagic;
    check_format(path, is_database ? number(kApplicationIdAt) : 0, number(kVersionAt));
    return path;
}

const std::string& name_of(Id structure, const Commit& commit, const State& state) {
    for (const auto& change : commit.structures)
        if (change.id == structure && change.after) return change.after->name;
    return structure_of(state, structure).name;
}

bool is_empty(Database& database) { return database.number("SELECT count(*) FROM sqlite_schema") == 0; }

}  // namespace

Project::Project(const std::filesystem::path& path, const ImageReference& image) : database_(checked(path)) {
    if (is_empty(database_)) create(image);
    else check_format(path, database_.number("PRAGMA application_id"), database_.number("PRAGMA user_version"));
    load();
    is_read_only_ = database_.is_read_only();
}

void Project::create(const ImageReference& image) {
    Transaction transaction(database_);
    database_.run(
        fmt::format("PRAGMA application_id = {}; PRAGMA user_version = {}; {}", kApplicationId, kVersion, kSchema).c_str());
    save_setting("position", "0");
    save_setting("next_id", "1");
    save_setting("page", "null");
    save_setting("borders", to_text(viewer::to_json(Borders{.shared = true})));
    save_setting("use_image", "true");
    write_image(image);
    transaction.commit();
}

void Project::load() {
    reading(database_, [&] {
        image_ = {setting("image_path"), setting("image_fingerprint"), choice_from(setting("image_choice"))};
        further_images_ = references_from(setting("further_images"));
        const json numbers{{"position", parsed(setting("position"))}, {"next_id", parsed(setting("next_id"))}};
        if (const std::string borders = setting("borders"); !borders.empty())
            state_.borders = borders_from_json(parsed(borders));
        state_.use_image = setting("use_image") == "true";  // projects of before have none: they stay what they were
        if (const std::string cycle = setting("cycle_frames"); !cycle.empty())
            state_.cycle_frames = cycle_from(parsed(cycle));
        position_ = Members(numbers).integer("position", 0, kLargestId - 1);
        next_id_ = Members(numbers).id("next_id");
        load_masks();
        for (Query rows(database_, "SELECT data FROM structure"); rows.next();) {
            const Structure structure = structure_from_json(parsed(rows.text(0)));
            mask_of(state_, structure);
            state_.structures[structure.id] = structure;
        }
        for (Query rows(database_, "SELECT data FROM contour"); rows.next();) {
            auto contour = std::make_shared<const DrawnContour>(contour_from_json(parsed(rows.text(0)), kStoredLimits));
            structure_of(state_, contour->structure);
            state_.contours[contour->id] = std::move(contour);
        }
    });
    is_new_ = state_.structures.empty() && database_.number("SELECT count(*) FROM history") == 0;
}

void Project::load_masks() {
    if (database_.number("PRAGMA user_version") < kVersionWithMasks) return;
    for (Query rows(database_, "SELECT hash, header, packed FROM mask"); rows.next();) {
        auto mask = std::make_shared<const StoredMask>(rows.text(1), rows.bytes(2));
        if (mask->hash() != rows.text(0)) throw Error(ErrorKind::invalid_input, "a mask is not the one that it was");
        state_.masks[mask->hash()] = std::move(mask);
    }
}

std::string Project::setting(std::string_view key) {
    Query query(database_, "SELECT value FROM setting WHERE key = ?1");
    return query.bind(key).next() ? query.text(0) : std::string();
}

void Project::save_setting(std::string_view key, std::string_view value) {
    Query(database_, "INSERT OR REPLACE INTO setting VALUES (?1, ?2)").bind(key).bind(value).finish();
}

void Project::write_image(const ImageReference& image) {
    save_setting("image_path", image.path);
    save_setting("image_fingerprint", image.fingerprint);
    save_setting("image_choice", to_text(viewer::to_json(image.choice)));
}

void Project::save_image(const ImageReference& image) {
    Transaction transaction(database_);
    write_image(image);
    transaction.commit();
    image_ = image;
}

void Project::save_further_images(std::vector<ImageReference> images) {
    json array = json::array();
    for (const ImageReference& image : images) array.push_back(viewer::to_json(image));
    Transaction transaction(database_);
    save_setting("further_images", to_text(array));
    transaction.commit();
    further_images_ = std::move(images);
}

std::string Project::page_state() { return setting("page"); }

void Project::save_page_state(std::string_view text) {
    Transaction transaction(database_);
    save_setting("page", text);
    transaction.commit();
}

/// By the functions that will read it: whatever is acknowledged can be opened again.
void Project::check_storable(const Commit& commit) const {
    for (const auto& change : commit.structures)
        if (change.after) structure_from_json(viewer::to_json(*change.after));
    for (const auto& change : commit.contours) {
        if (!change.after) continue;
        try {
            contour_from_json(viewer::to_json(*change.after));
        } catch (const Error& error) {
            throw Error(error.kind(), fmt::format("a contour of {} cannot be kept: {}",
                                                  name_of(change.after->structure, commit, state_), error.what()));
        }
    }
}

void Project::begin_with(const Commit& commit) {
    check_storable(commit);
    Transaction transaction(database_);
    store(commit, position_);
    transaction.commit();
    apply(commit);
}

void Project::commit(const Commit& commit) {
    check_storable(commit);
    json changes{{"structures", to_json(commit.structures)}, {"contours", to_json(commit.contours)}};
    if (commit.borders)
        changes["borders"] = {{"before", viewer::to_json(commit.borders->before)},
                              {"after", viewer::to_json(commit.borders->after)}};
    if (commit.use_image) changes["use_image"] = {{"before", commit.use_image->before}, {"after", commit.use_image->after}};
    if (commit.cycle)
        changes["cycle_frames"] = {{"before", to_json(commit.cycle->before)}, {"after", to_json(commit.cycle->after)}};
    Transaction transaction(database_);
    Query(database_, "DELETE FROM history WHERE number > ?1").bind(position_).finish();
    Query(database_, "INSERT INTO history VALUES (?1, ?2, datetime('now'), ?3)")
        .bind(position_ + 1)
        .bind(commit.label)
        .bind(to_text(changes))
        .finish();
    store(commit, position_ + 1);
    transaction.commit();
    ++position_;
    apply(commit);
}

std::optional<Commit> Project::undo() {
    std::optional<Commit> commit = step(position_);
    if (!commit) return std::nullopt;
    turn_back(commit->structures);
    turn_back(commit->contours);
    if (commit->borders) std::swap(commit->borders->before, commit->borders->after);
    if (commit->use_image) std::swap(commit->use_image->before, commit->use_image->after);
    if (commit->cycle) std::swap(commit->cycle->before, commit->cycle->after);
    Transaction transaction(database_);
    store(*commit, position_ - 1);
    transaction.commit();
    --position_;
    apply(*commit);
    return commit;
}

std::optional<Commit> Project::redo() {
    std::optional<Commit> commit = step(position_ + 1);
    if (!commit) return std::nullopt;
    Transaction transaction(database_);
    store(*commit, position_ + 1);
    transaction.commit();
    ++position_;
    apply(*commit);
    return commit;
}

std::optional<std::string> Project::label(std::int64_t number) {
    Query query(database_, "SELECT label FROM history WHERE number = ?1");
    if (!query.bind(number).next()) return std::nullopt;
    return query.text(0);
}

std::optional<std::string> Project::undo_label() { return label(position_); }
std::optional<std::string> Project::redo_label() { return label(position_ + 1); }

std::optional<Commit> Project::step(std::int64_t number) {
    Query query(database_, "SELECT label, changes FROM history WHERE number = ?1");
    if (!query.bind(number).next()) return std::nullopt;
    return reading(database_, [&] {
        const json changes = parsed(query.text(1));
        Commit commit{query.text(0), changes_from<Structure>(changes.at("structures")),
                      changes_from<DrawnContour>(changes.at("contours")), borders_change_from(changes),
                      use_image_change_from(changes)};
        commit.cycle = cycle_change_from(changes);
        for (const auto& change : commit.structures)
            for (const auto& side : {change.before, change.after})
                if (side) mask_of(state_, *side);
        return commit;
    });
}

/// What an older kontur would take for something else.
void Project::store_version(const Commit& commit) {
    int needed = 0;
    for (const auto& change : commit.contours)
        if (change.after && change.after->time) needed = kVersionWithTimes;
    for (const auto& change : commit.structures)
        if (change.after && change.after->rule) needed = std::max(needed, kVersionWithRules);
    for (const auto& change : commit.structures)
        if (change.after && change.after->attributes.review != Review{}) needed = kVersionWithReviews;
    if (needed > database_.number("PRAGMA user_version"))
        database_.run(fmt::format("{} PRAGMA user_version = {};", kMaskTable, needed).c_str());
}

void Project::store_masks(const Commit& commit) {
    if (commit.masks.empty()) return;
    if (database_.number("PRAGMA user_version") < kVersionWithMasks)
        database_.run(fmt::format("{} PRAGMA user_version = {};", kMaskTable, kVersionWithMasks).c_str());
    for (const auto& mask : commit.masks)
        Query(database_, "INSERT OR REPLACE INTO mask VALUES (?1, ?2, ?3)")
            .bind(mask->hash())
            .bind(mask->header())
            .bind(std::as_bytes(std::span(mask->packed())))
            .finish();
}

void Project::store(const Commit& commit, std::int64_t new_position) {
    store_masks(commit);
    store_version(commit);
    write_rows(database_, commit.structures, "INSERT OR REPLACE INTO structure VALUES (?1, ?2)",
               "DELETE FROM structure WHERE id = ?1");
    write_rows(database_, commit.contours, "INSERT OR REPLACE INTO contour VALUES (?1, ?2)",
               "DELETE FROM contour WHERE id = ?1");
    if (commit.borders) save_setting("borders", to_text(viewer::to_json(commit.borders->after)));
    if (commit.use_image) save_setting("use_image", commit.use_image->after ? "true" : "false");
    if (commit.cycle) save_setting("cycle_frames", to_text(to_json(commit.cycle->after)));
    save_setting("position", std::to_string(new_position));
    save_setting("next_id", std::to_string(next_id_));
}

void Project::apply(const Commit& commit) {
    for (const auto& mask : commit.masks) state_.masks[mask->hash()] = mask;
    for (const auto& change : commit.structures) {
        if (change.after) state_.structures[change.id] = *change.after;
        else state_.structures.erase(change.id);
    }
    for (const auto& change : commit.contours) {
        if (change.after) state_.contours[change.id] = std::make_shared<const DrawnContour>(*change.after);
        else state_.contours.erase(change.id);
    }
    if (commit.borders) state_.borders = commit.borders->after;
    if (commit.use_image) state_.use_image = commit.use_image->after;
    if (commit.cycle) state_.cycle_frames = commit.cycle->after;
}

ImageReference image_of_project(const std::filesystem::path& path) {
    if (!std::filesystem::is_regular_file(path) || std::filesystem::file_size(path) == 0)
        throw Error(ErrorKind::corrupt_file, fmt::format("{} is no kontur project", path.string()));
    return Project(path, {}).image();
}

}  // namespace kontur::viewer
