// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>

struct sqlite3;
struct sqlite3_stmt;

// SQLite with kontur's errors.

namespace kontur::viewer {

/// A database file that this process alone has open. Every finished transaction is on the disk, in the one file.
class Database {
public:
    /// Opens or creates. Throws Error(io) when another process has it open or the system refuses, Error(corrupt_file) when
    /// it is no database.
    explicit Database(const std::filesystem::path& path);

    const std::filesystem::path& path() const { return path_; }

    /// Runs statements that give no rows.
    void run(const char* sql);
    /// The first column of the first row; 0 without one.
    std::int64_t number(const char* sql);

    /// Whether the file, or its folder, where a journal has to be, cannot be written.
    bool is_read_only() const;
    /// A copy of all of it as a new file.
    void copy_to(const std::filesystem::path& target);

private:
    friend class Query;
    friend class Transaction;
    [[noreturn]] void fail(int code) const;
    void check_place() const;

    struct Close {
        void operator()(sqlite3* handle) const;
    };
    std::filesystem::path path_;
    std::unique_ptr<sqlite3, Close> handle_;
};

/// One prepared statement: bind in order, then step through its rows.
class Query {
public:
    Query(Database& database, const char* sql);
    ~Query();
    Query(const Query&) = delete;
    Query& operator=(const Query&) = delete;

    Query& bind(std::int64_t value);
    Query& bind(std::string_view text);
    Query& bind(std::span<const std::byte> bytes);

    /// Whether there is a (further) row.
    bool next();
    /// `next` for statements without rows.
    void finish() { next(); }

    std::int64_t number(int column) const;
    std::string text(int column) const;
    std::string bytes(int column) const;

private:
    Database& database_;
    sqlite3_stmt* statement_ = nullptr;
    int bound_ = 0;
};

/// Rolls back unless committed.
class Transaction {
public:
    /// Throws Error(io) when the file is not where it was: what is written would be lost.
    explicit Transaction(Database& database);
    ~Transaction();
    Transaction(const Transaction&) = delete;
    Transaction& operator=(const Transaction&) = delete;
    void commit();

private:
    Database& database_;
    bool open_ = true;
};

}  // namespace kontur::viewer
