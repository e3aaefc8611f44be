// SPDX-License-Identifier: Apache-2.0
#include "viewer/store/database.h"

#include <fmt/format.h>
#include <sqlite3.h>
#include <unistd.h>

#include <cstring>

#include "kontur/base/error.h"

namespace kontur::viewer {
namespace {

/// No text or row of a project comes near this; a damaged file may claim anything.
constexpr int kLargestValueBytes = 256 << 20;

}  // namespace

void Database::Close::operator()(sqlite3* handle) const { sqlite3_close(handle); }

void Database::fail(int code) const {
    const std::string name = path_.string();
    switch (code & 0xff) {
        case SQLITE_BUSY:
        case SQLITE_LOCKED:
            throw Error(ErrorKind::io, fmt::format("{} is open in another kontur; close it there first", name));
        case SQLITE_NOTADB:
        case SQLITE_CORRUPT:
        case SQLITE_TOOBIG:
        case SQLITE_SCHEMA:
            throw Error(ErrorKind::corrupt_file, fmt::format("{} is no kontur project, or damaged", name));
        case SQLITE_FULL:
            throw Error(ErrorKind::io, fmt::format("cannot write {}: the disk is full", name));
        case SQLITE_IOERR:
            throw Error(ErrorKind::io, fmt::format("cannot write {}: the disk refused it ({})", name,
                                                   handle_ ? std::strerror(sqlite3_system_errno(handle_.get())) : "?"));
        case SQLITE_READONLY:
            throw Error(ErrorKind::io, fmt::format("cannot write {}: it is read-only", name));
        default:
            throw Error(ErrorKind::io, fmt::format("cannot use {}: {}", name,
                                                   handle_ ? sqlite3_errmsg(handle_.get()) : sqlite3_errstr(code)));
    }
}

Database::Database(const std::filesystem::path& path) : path_(path) {
    sqlite3* handle = nullptr;
    const int code =
        sqlite3_open_v2(path.c_str(), &handle,
                        SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE | SQLITE_OPEN_FULLMUTEX | SQLITE_OPEN_EXRESCODE, nullptr);
    handle_.reset(handle);
    if (code != SQLITE_OK) fail(code);
    sqlite3_limit(handle, SQLITE_LIMIT_LENGTH, kLargestValueBytes);
    // A project may come from anywhere: nothing in it may run or write beside what we ask for.
    sqlite3_db_config(handle, SQLITE_DBCONFIG_DEFENSIVE, 1, nullptr);
    sqlite3_db_config(handle, SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0, nullptr);
    sqlite3_db_config(handle, SQLITE_DBCONFIG_ENABLE_TRIGGER, 0, nullptr);
    sqlite3_db_config(handle, SQLITE_DBCONFIG_ENABLE_VIEW, 0, nullptr);
    // A rollback journal, because with a write-ahead log a killed process leaves the last edits in a second file, and
    // whoever then moves the project leaves them behind. The exclusive lock is kept until the file is closed.
    run("PRAGMA locking_mode = EXCLUSIVE; PRAGMA journal_mode = DELETE; PRAGMA synchronous = EXTRA;"
        "PRAGMA cell_size_check = ON; BEGIN EXCLUSIVE; COMMIT;");
}

void Database::run(const char* sql) {
    if (const int code = sqlite3_exec(handle_.get(), sql, nullptr, nullptr, nullptr); code != SQLITE_OK) fail(code);
}

std::int64_t Database::number(const char* sql) {
    Query query(*this, sql);
    return query.next() ? query.number(0) : 0;
}

void Database::check_place() const {
    int has_moved = 0;
    sqlite3_file_control(handle_.get(), "main", SQLITE_FCNTL_HAS_MOVED, &has_moved);
    if (has_moved != 0)
        throw Error(ErrorKind::io, fmt::format("{} was moved, replaced or deleted while kontur has it open, and can take no "
                                               "edits; export the project, then open it again",
                                               path_.string()));
}

bool Database::is_read_only() const {
    const std::filesystem::path folder = std::filesystem::absolute(path_).parent_path();
    return sqlite3_db_readonly(handle_.get(), "main") == 1 || access(folder.c_str(), W_OK) != 0;
}

void Database::copy_to(const std::filesystem::path& target) {
    Query(*this, "VACUUM INTO ?1").bind(target.string()).finish();
}

Query::Query(Database& database, const char* sql) : database_(database) {
    const int code = sqlite3_prepare_v2(database.handle_.get(), sql, -1, &statement_, nullptr);
    if (code != SQLITE_OK) database_.fail(code);
}

Query::~Query() { sqlite3_finalize(statement_); }

Query& Query::bind(std::int64_t value) {
    if (const int code = sqlite3_bind_int64(statement_, ++bound_, value); code != SQLITE_OK) database_.fail(code);
    return *this;
}

Query& Query::bind(std::string_view text) {
    const int code = sqlite3_bind_text64(statement_, ++bound_, text.data(), text.size(), SQLITE_TRANSIENT, SQLITE_UTF8);
    if (code != SQLITE_OK) database_.fail(code);
    return *this;
}

Query& Query::bind(std::span<const std::byte> bytes) {
    const int code = sqlite3_bind_blob64(statement_, ++bound_, bytes.data(), bytes.size(), SQLITE_TRANSIENT);
    if (code != SQLITE_OK) database_.fail(code);
    return *this;
}

bool Query::next() {
    const int code = sqlite3_step(statement_);
    if (code != SQLITE_ROW && code != SQLITE_DONE) database_.fail(code);
    return code == SQLITE_ROW;
}

std::int64_t Query::number(int column) const { return sqlite3_column_int64(statement_, column); }

std::string Query::text(int column) const {
    const auto* text = reinterpret_cast<const char*>(sqlite3_column_text(statement_, column));
    return text ? std::string(text, static_cast<std::size_t>(sqlite3_column_bytes(statement_, column))) : std::string();
}

std::string Query::bytes(int column) const {
    const auto* bytes = static_cast<const char*>(sqlite3_column_blob(statement_, column));
    return bytes ? std::string(bytes, static_cast<std::size_t>(sqlite3_column_bytes(statement_, column))) : std::string();
}

Transaction::Transaction(Database& database) : database_(database) {
    database_.check_place();
    database_.run("BEGIN IMMEDIATE");
}

Transaction::~Transaction() {
    // SQLite rolls back by itself after some errors (a full disk); a second rollback is refused and means nothing.
    if (open_) sqlite3_exec(database_.handle_.get(), "ROLLBACK", nullptr, nullptr, nullptr);
}

void Transaction::commit() {
    database_.run("COMMIT");
    open_ = false;
}

}  // namespace kontur::viewer
