// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <list>
#include <thread>

#include "cases.h"
#include "child_process.h"
#include "command_line.h"
#include "commands.h"
#include "facts.h"
#include "kontur/base/error.h"
#include "kontur/base/parallel.h"
#include "kontur/io/atomic_file.h"
#include "outputs.h"

namespace kontur::app {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr auto kPause = std::chrono::milliseconds(20);

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

std::string content_of(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

/// What became of each case, one file each, so that several machines can write them at the same time. A file appears
/// whole after the case's outputs did.
class Journal {
public:
    Journal(const Cohort& cohort, const fs::path& table, const fs::path& folder)
        : cohort_(cohort),
          base_(table.has_parent_path() ? table.parent_path() : fs::path(".")),
          folder_(folder.empty() ? base_ / (table.stem().string() + ".journal") : folder) {
        std::error_code failure;
        fs::create_directories(folder_, failure);
        if (failure) throw Error(ErrorKind::io, fmt::format("cannot make {}: {}", folder_.string(), failure.message()));
        folder_ = fs::absolute(folder_);
    }

    const fs::path& base() const { return base_; }
    fs::path file(const Case& one, const char* extension) const {
        return folder_ / fmt::format("{:05}{}", one.number, extension);
    }

    std::string made_from(const Case& one) const { return fingerprint(one, cohort_, base_); }

    /// null: nothing is known about the case as it is now.
    Facts entry(const Case& one) const {
        Facts found = Facts::parse(content_of(file(one, ".json")), nullptr, /*allow_exceptions=*/false);
        if (!found.is_object() || found.value("made_from", "") != made_from(one)) return nullptr;
        return found;
    }

    bool is_done(const Case& one) const {
        const Facts found = entry(one);
        const auto exists = [&](const fs::path& output) { return fs::exists(base_ / output); };
        return found.is_object() && found.value("exit_code", -1) == 0 &&
               std::all_of(one.outputs.begin(), one.outputs.end(), exists);
    }

    void write(const Case& one, const Facts& facts) const { write_file_atomically(file(one, ".json"), to_json_text(facts)); }

private:
    const Cohort& cohort_;
    fs::path base_, folder_;
};

/// A case in progress.
struct Running {
    const Case* one;
    std::string made_from;
    fs::path report;
    Clock::time_point start;
    ChildProcess process;
};

/// The sentence behind "kontur: error: " that a failed command ends with.
std::string error_in(const fs::path& log, int exit_code) {
    constexpr std::string_view kMark = "kontur: error: ";
    const std::string text = content_of(log);
    const std::size_t mark = text.rfind(kMark);
    if (mark == std::string::npos)
        return exit_code > 128 ? fmt::format("ended by signal {}", exit_code - 128) : "no reason given";
    const std::size_t start = mark + kMark.size();
    return text.substr(start, text.find('\n', start) - start);
}

class Batch {
public:
    Batch(const BatchCommand& command, Console& console)
        : command_(command),
          console_(console),
          cohort_(read_cases(command.table)),
          cases_(cohort_.cases),
          journal_(cohort_, command.table, command.journal) {
        if (!command.summary.empty()) check_apart(command.summary, cohort_);
        if (command.row > 0) keep_row();
        jobs_ = command.jobs > 0 ? command.jobs : 1;
        for (const Case& one : cases_)
            if (command.collect || journal_.is_done(one)) ++before_;
            else waiting_.push_back(&one);
    }

    void work() {
        try {
            make_all();
        } catch (const Error& error) {
            if (error.kind() != ErrorKind::cancelled) throw;
            throw EndedEarly(fmt::format("interrupted; {} of {} cases are done, and the same command goes on from there",
                                         before_ + finished_ - failed_, cases_.size()),
                             exit_code(ErrorKind::cancelled));
        }
    }

    /// One entry for each case, those of earlier runs included.
    Facts summary() const {
        Facts list = Facts::array();
        int done = 0, failed = 0;
        for (const Case& one : cases_) {
            Facts facts = {{"row", one.number}, {"case", one.name}};
            const Facts found = journal_.entry(one);
            if (!found.is_object()) facts["state"] = "open";
            else {
                const bool good = found.value("exit_code", -1) == 0;
                ++(good ? done : failed);
                facts["state"] = good ? "done" : "failed";
                facts.update(found);
                facts.erase("made_from");
            }
            list.push_back(std::move(facts));
        }
        return {{"version", KONTUR_VERSION},
                {"table", command_.table.string()},
                {"done", done},
                {"failed", failed},
                {"open", static_cast<int>(cases_.size()) - done - failed},
                {"cases", list}};
    }

private:
    void make_all() {
        const Progress progress = console_.progress();
        while (!waiting_.empty() || !running_.empty()) {
            while (!waiting_.empty() && running_.size() < static_cast<std::size_t>(jobs_)) start_next();
            std::this_thread::sleep_for(kPause);
            collect_finished();
            progress.report(status(), fraction());
        }
    }

    void keep_row() {
        if (static_cast<std::size_t>(command_.row) > cases_.size())
            throw Error(ErrorKind::invalid_input, fmt::format("{} has {} rows; there is no row {}", command_.table.string(),
                                                              cases_.size(), command_.row));
        cases_ = {cases_[static_cast<std::size_t>(command_.row) - 1]};
    }

    void start_next() {
        const Case& one = *waiting_.front();
        waiting_.erase(waiting_.begin());
        std::vector<std::string> more;
        fs::path report = one.report.empty() ? journal_.file(one, ".report.json") : journal_.base() / one.report;
        if (one.report.empty()) more.push_back("--report=" + report.string());
        if (!one.has_threads) more.push_back(fmt::format("--threads={}", threads()));
        running_.push_back({&one, journal_.made_from(one), report, Clock::now(),
                            ChildProcess(words_of(one, more), journal_.base(), journal_.file(one, ".log"))});
    }

    int threads() const { return command_.threads > 0 ? command_.threads : std::max(1, thread_count(0) / jobs_); }

    void collect_finished() {
        for (auto at = running_.begin(); at != running_.end();) {
            const std::optional<int> code = at->process.exit_code();
            if (!code) {
                ++at;
                continue;
            }
            finish(*at, *code);
            at = running_.erase(at);
        }
    }

    void finish(const Running& ended, int exit_code) {
        const double seconds = seconds_since(ended.start);
        Facts facts = {{"exit_code", exit_code}, {"seconds", seconds}};
        if (exit_code != 0) facts["error"] = error_in(journal_.file(*ended.one, ".log"), exit_code);
        else if (const Facts report = Facts::parse(content_of(ended.report), nullptr, false); report.is_object())
            for (const char* key : {"mask", "residual_mm", "warnings"})
                if (report.contains(key)) facts[key] = report[key];
        facts["made_from"] = ended.made_from;
        journal_.write(*ended.one, facts);
        if (ended.one->report.empty()) fs::remove(ended.report);
        ++finished_;
        failed_ += exit_code != 0;
        busy_seconds_ += seconds;
        console_.print(exit_code == 0
                           ? fmt::format("{}: {:.2f} ml, {:.1f} s\n", ended.one->name,
                                         facts.contains("mask") ? facts["mask"].value("volume_ml", 0.0) : 0.0, seconds)
                           : fmt::format("{}: FAILED, {}\n", ended.one->name, facts["error"].get<std::string>()));
        std::fflush(stdout);  // for who follows a log
    }

    double fraction() const {
        const auto to_do = static_cast<double>(cases_.size() - before_);
        return to_do > 0 ? static_cast<double>(finished_) / to_do : 1;
    }

    std::string status() const {
        std::string text = fmt::format("{} of {} cases", before_ + finished_, cases_.size());
        if (failed_ > 0) text += fmt::format(", {} failed", failed_);
        if (finished_ == 0) return text;
        const double mean = busy_seconds_ / static_cast<double>(finished_);
        const double left = mean * static_cast<double>(waiting_.size() + running_.size()) / jobs_;
        return text +
               (left < 90 ? fmt::format(", about {:.0f} s left", left) : fmt::format(", about {:.0f} min left", left / 60));
    }

    const BatchCommand& command_;
    Console& console_;
    const Cohort cohort_;
    std::vector<Case> cases_;  ///< those to be made
    Journal journal_;
    std::vector<const Case*> waiting_;
    std::list<Running> running_;
    int jobs_ = 1;
    std::size_t before_ = 0, finished_ = 0, failed_ = 0;
    double busy_seconds_ = 0;
};

std::string table_of(const Facts& summary) {
    std::size_t width = 4;
    for (const Facts& one : summary["cases"]) width = std::max(width, one["case"].get<std::string>().size());
    std::string text = fmt::format("{:<{}}  {:<6}  {:>10}  {:>10}  {:>8}\n", "case", width, "state", "ml", "max mm", "s");
    for (const Facts& one : summary["cases"]) {
        const auto cell = [&](const char* group, const char* key) {
            return one.contains(group) ? fmt::format("{:.3f}", one[group].value(key, 0.0)) : std::string("-");
        };
        text += fmt::format("{:<{}}  {:<6}  {:>10}  {:>10}  {:>8.1f}", one["case"].get<std::string>(), width,
                            one["state"].get<std::string>(), cell("mask", "volume_ml"), cell("residual_mm", "max"),
                            one.value("seconds", 0.0));
        if (one.contains("error")) text += fmt::format("  {}", one["error"].get<std::string>());
        text += '\n';
    }
    return text + fmt::format("{} done, {} failed, {} open\n", summary["done"].get<int>(), summary["failed"].get<int>(),
                              summary["open"].get<int>());
}

}  // namespace

void run(const BatchCommand& command, Console& console) {
    if (!command.summary.empty()) check_output(command.summary, std::array{command.table});
    if (command.count) return console.print(fmt::format("{}\n", read_cases(command.table).cases.size()));
    Batch batch(command, console);
    batch.work();
    const Facts summary = batch.summary();
    if (!command.summary.empty()) write_file_atomically(command.summary, to_json_text(summary));
    console.print(fmt::format("\n{}", table_of(summary)));
    const int failed = summary["failed"].get<int>(), open = summary["open"].get<int>();
    if (failed + open == 0) return;
    throw EndedEarly(fmt::format("{} of {} cases failed{}", failed, summary["cases"].size(),
                                 open > 0 ? fmt::format(", {} were not made", open) : ""),
                     kCasesFailedExitCode);
}

}  // namespace kontur::app
