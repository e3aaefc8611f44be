// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <deque>
#include <fstream>
#include <iterator>
#include <list>
#include <map>
#include <optional>
#include <span>
#include <thread>
#include <utility>

#include "cases.h"
#include "child_process.h"
#include "claim.h"
#include "command_line.h"
#include "commands.h"
#include "facts.h"
#include "kontur/base/counted.h"
#include "kontur/base/error.h"
#include "kontur/base/parallel.h"
#include "kontur/io/bytes/atomic_file.h"
#include "kontur/io/bytes/check_json.h"
#include "kontur/io/bytes/folders.h"
#include "kontur/view/picture.h"
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

bool is_sound_json(std::string_view text) {
    try {
        check_json(text);
        return true;
    } catch (const Error&) {
        return false;
    }
}

bool succeeded(const Facts& entry) { return entry.is_object() && entry.value("exit_code", -1) == 0; }

/// What became of each case, one file each, so that several machines can write them at the same time. A file appears
/// whole after the case's outputs did.
class Journal {
public:
    Journal(const fs::path& table, const fs::path& folder)
        : base_(table.has_parent_path() ? table.parent_path() : fs::path(".")),
          folder_(folder.empty() ? base_ / (table.stem().string() + ".journal") : folder) {
        make_folder(folder_);
        folder_ = fs::absolute(folder_);
    }

    const fs::path& base() const { return base_; }
    const fs::path& folder() const { return folder_; }
    fs::path file(const Case& one, const char* extension) const { return folder_ / (file_stem(one) + extension); }

    std::string made_from(const Case& one) const { return fingerprint(one, base_); }

    /// null: nothing is known about the case as it is now, or outputs of it are gone.
    Facts entry(const Case& one, const std::string& made_from) const {
        const std::string text = content_of(file(one, ".json"));
        Facts found = is_sound_json(text) ? Facts::parse(text) : Facts();
        if (!found.is_object() || found.value("made_from", "") != made_from) return nullptr;
        const auto exists = [&](const fs::path& output) { return fs::exists(base_ / output); };
        if (succeeded(found) && !std::all_of(one.outputs.begin(), one.outputs.end(), exists)) return nullptr;
        return found;
    }

    void write(const Case& one, const Facts& facts) const { write_file_atomically(file(one, ".json"), to_json_text(facts)); }

private:
    fs::path base_, folder_;
};

/// A row and what became of it.
struct Entry {
    const Case* one;
    Facts found;             ///< as in the journal; null: nothing that holds for the case as it is now
    bool elsewhere = false;  ///< another process makes it

    bool is_done() const { return succeeded(found); }
    const char* state() const {
        if (elsewhere) return "running";
        if (!found.is_object()) return "open";
        return is_done() ? "done" : "failed";
    }
};

/// A case in progress.
struct Running {
    Entry* entry;
    Claim claim;
    std::string made_from;
    fs::path report;
    Clock::time_point start;
    ChildProcess process;
};

std::size_t warning_count(const Facts& facts) { return facts.contains("warnings") ? facts["warnings"].size() : 0; }

/// The Dice to be expected; 0 where nothing is known.
double dice_of(const Facts& figures) {
    const Facts& sureness = figures.at("uncertainty");
    return sureness.value("known", false) ? sureness.at("expected_dice").value("value", 0.0) : 0;
}

/// The largest share of a drawn section that is not as drawn.
double wrong_share_of(const Facts& figures) { return figures.at("section_check").value("largest_wrong_share", 0.0); }

/// What the summary says of a case, from the report that `segment` wrote: of each structure, where it made several.
Facts figures_of(const Facts& report) {
    Facts facts;
    for (const char* key : {"mask", "residual_mm", "section_check", "uncertainty", "derived", "warnings", "volumes_ml",
                            "stroke_ml", "ejection_fraction"})
        if (report.contains(key)) facts[key] = report[key];
    if (!report.contains("structures")) return facts;
    Facts structures = Facts::array(), warnings = Facts::array();
    double residual_max_mm = 0;
    for (const Facts& structure : report["structures"]) {
        Facts& row = structures.emplace_back();
        for (const char* key : {"label", "name", "mask", "residual_mm", "section_check", "uncertainty"})
            row[key] = structure.at(key);
        if (!facts.contains("uncertainty") || dice_of(row) < dice_of(facts)) facts["uncertainty"] = row["uncertainty"];
        if (!facts.contains("section_check") || wrong_share_of(row) > wrong_share_of(facts))
            facts["section_check"] = row["section_check"];
        residual_max_mm = std::max(residual_max_mm, structure.at("residual_mm").value("max", 0.0));
        for (const Facts& warning : structure.at("warnings"))
            warnings.push_back(fmt::format("{}: {}", structure.at("name").get<std::string>(), warning.get<std::string>()));
    }
    for (const Facts& warning : report.at("warnings")) warnings.push_back(warning);
    facts["structures"] = std::move(structures);
    facts["residual_mm"] = {{"max", residual_max_mm}};
    facts["warnings"] = std::move(warnings);
    return facts;
}

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
          cohort_(read_cases(command.table, command.rules)),
          journal_(command.table, command.journal),
          jobs_(command.jobs > 0 ? command.jobs : 1) {
        if (!command.summary.empty()) check_apart(command.summary, cohort_);
        for (const Case& one : chosen()) entries_.push_back({&one, journal_.entry(one, journal_.made_from(one))});
        if (command.collect) return;
        for (Entry& entry : entries_)
            if (!entry.is_done()) waiting_.push_back(&entry);
        for (const Entry* entry : waiting_) check_outputs(*entry->one, command.table);
        to_do_ = waiting_.size();
    }

    void work() {
        try {
            make_all();
            // What another process was making is done by now, perhaps, or that process has ended before it was.
            waiting_ = std::exchange(elsewhere_, {});
            make_all();
        } catch (const Error& error) {
            if (error.kind() != ErrorKind::cancelled) throw;
            const auto done = std::count_if(entries_.begin(), entries_.end(), [](const Entry& e) { return e.is_done(); });
            throw EndedEarly(fmt::format("interrupted; {} of {} cases are done, and the same command goes on from there",
                                         done, entries_.size()),
                             exit_code(ErrorKind::cancelled));
        }
    }

    /// One entry for each case, those of earlier runs included.
    Facts summary() const {
        std::map<std::string, int> count;
        Facts list = Facts::array();
        for (const Entry& entry : entries_) {
            ++count[entry.state()];
            Facts facts = {{"row", entry.one->number}, {"case", entry.one->name}, {"state", entry.state()}};
            if (entry.found.is_object()) {
                facts.update(entry.found);
                facts.erase("made_from");
                facts["log"] = journal_.file(*entry.one, ".log").string();
            }
            list.push_back(std::move(facts));
        }
        Facts all = {{"version", KONTUR_VERSION}, {"table", command_.table.string()}};
        for (const char* state : {"done", "failed", "open", "running"}) all[state] = count[state];
        all["cases"] = list;
        return all;
    }

    const fs::path& journal() const { return journal_.folder(); }

private:
    void make_all() {
        const Work terminal = console_.work();
        while (!waiting_.empty() || !running_.empty()) {
            while (!waiting_.empty() && running_.size() < static_cast<std::size_t>(jobs_)) start_next();
            std::this_thread::sleep_for(kPause);
            collect_finished();
            terminal.report(status(), fraction());
        }
    }

    /// All cases or the row that was asked for.
    std::span<const Case> chosen() const {
        const std::span<const Case> all(cohort_.cases);
        if (command_.row == 0) return all;
        const auto row = static_cast<std::size_t>(command_.row);
        if (row > all.size())
            throw Error(ErrorKind::invalid_input,
                        fmt::format("{} has {} rows; there is no row {}", command_.table.string(), all.size(), row));
        return all.subspan(row - 1, 1);
    }

    void start_next() {
        Entry& entry = *waiting_.front();
        waiting_.pop_front();
        const Case& one = *entry.one;
        std::optional<Claim> claim = Claim::on(journal_.file(one, ".log"));
        entry.elsewhere = !claim;
        if (!claim) {
            entry.found = nullptr;
            return elsewhere_.push_back(&entry);
        }
        if (!claim->excludes_others()) warn_of_missing_locks();
        const std::string made_from = journal_.made_from(one);
        entry.found = journal_.entry(one, made_from);
        if (entry.is_done()) return;  // by another process, after this one had looked

        std::vector<std::string> more;
        fs::path report = one.report.empty() ? journal_.file(one, ".report.json") : journal_.base() / one.report;
        if (one.report.empty()) more.push_back("--report=" + report.string());
        if (!one.has_threads) more.push_back(fmt::format("--threads={}", threads()));
        running_.push_back({&entry, std::move(*claim), made_from, report, Clock::now(),
                            ChildProcess(words_of(one, more), journal_.base(), journal_.file(one, ".log"))});
    }

    void warn_of_missing_locks() {
        if (!std::exchange(has_warned_, true))
            console_.warn(fmt::format("files in {} cannot be locked: another batch on this table would make the same cases",
                                      journal_.folder().string()));
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
        const Case& one = *ended.entry->one;
        const double seconds = seconds_since(ended.start);
        Facts facts = {{"exit_code", exit_code}, {"seconds", seconds}};
        if (exit_code != 0) facts["error"] = error_in(journal_.file(one, ".log"), exit_code);
        else if (const Facts report = Facts::parse(content_of(ended.report), nullptr, false); report.is_object())
            facts.update(figures_of(report));
        facts["made_from"] = ended.made_from;
        journal_.write(one, facts);
        if (one.report.empty()) fs::remove(ended.report);
        ++finished_;
        failed_ += exit_code != 0;
        busy_seconds_ += seconds;
        console_.print(line_about(one, facts));
        std::fflush(stdout);  // for who follows a log
        ended.entry->found = std::move(facts);
    }

    static std::string line_about(const Case& one, const Facts& facts) {
        if (!succeeded(facts)) return fmt::format("{}: FAILED, {}\n", one.name, facts["error"].get<std::string>());
        const double volume_ml = facts.contains("mask") ? facts["mask"].value("volume_ml", 0.0) : 0.0;
        const std::string amount =
            facts.contains("structures") ? counted(facts["structures"].size(), "structure") : in_ml(volume_ml);
        const std::size_t warnings = warning_count(facts);
        return fmt::format("{}: {}, {:.1f} s{}\n", one.name, amount, facts["seconds"].get<double>(),
                           warnings > 0 ? ", " + counted(warnings, "warning") : "");
    }

    std::size_t unfinished() const { return waiting_.size() + elsewhere_.size() + running_.size(); }

    double fraction() const { return to_do_ > 0 ? 1 - static_cast<double>(unfinished()) / static_cast<double>(to_do_) : 1; }

    std::string status() const {
        std::string text = fmt::format("{} of {} cases", entries_.size() - unfinished(), entries_.size());
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
    Journal journal_;
    int jobs_;
    std::vector<Entry> entries_;
    std::deque<Entry*> waiting_, elsewhere_;
    std::list<Running> running_;
    std::size_t to_do_ = 0, finished_ = 0, failed_ = 0;
    double busy_seconds_ = 0;
    bool has_warned_ = false;
};

std::string totals_of(const Facts& summary) {
    std::string text = fmt::format("{} done, {} failed, {} open", summary["done"].get<int>(), summary["failed"].get<int>(),
                                   summary["open"].get<int>());
    if (const int running = summary["running"].get<int>(); running > 0)
        text += fmt::format(", {} being made by another process", running);
    return text + "\n";
}

std::string table_of(const Facts& summary) {
    std::size_t width = 4;
    for (const Facts& one : summary["cases"]) width = std::max(width, one["case"].get<std::string>().size());
    std::string text = fmt::format("{:<{}}  {:<7}  {:>10}  {:>10}  {:>7}  {:>7}  {:>8}  {:>8}\n", "case", width, "state",
                                   "ml", "max mm", "wrong %", "Dice?", "s", "warnings");
    for (const Facts& one : summary["cases"]) {
        const auto cell = [&](const char* group, const char* key) {
            return one.contains(group) ? fmt::format("{:.3f}", one[group].value(key, 0.0)) : std::string("-");
        };
        const double dice = one.contains("uncertainty") ? dice_of(one) : 0;
        text += fmt::format("{:<{}}  {:<7}  {:>10}  {:>10}  {:>7}  {:>7}  {:>8.1f}  {:>8}", one["case"].get<std::string>(),
                            width, one["state"].get<std::string>(), cell("mask", "volume_ml"), cell("residual_mm", "max"),
                            one.contains("section_check") ? fmt::format("{:.1f}", 100 * wrong_share_of(one)) : "-",
                            dice > 0 ? fmt::format("{:.2f}", dice) : "-", one.value("seconds", 0.0),
                            one.contains("warnings") ? fmt::to_string(warning_count(one)) : "-");
        if (one.contains("error")) text += fmt::format("  {}", one["error"].get<std::string>());
        text += '\n';
    }
    return text + totals_of(summary);
}

/// Where the cases' warnings can be read; "" where there are none.
std::string warnings_line(const Facts& summary, const BatchCommand& command, const fs::path& journal) {
    std::size_t count = 0;
    for (const Facts& one : summary["cases"]) count += warning_count(one);
    if (count == 0) return "";
    return fmt::format(
        "read the {} in {}\n", count == 1 ? "warning" : fmt::format("{} warnings", count),
        command.summary.empty() ? fmt::format("the .log files of {}", journal.string()) : command.summary.string());
}

}  // namespace

void run(const BatchCommand& command, Console& console) {
    if (!command.summary.empty()) check_output(command.summary, std::array{command.table});
    if (command.count) return console.print(fmt::format("{}\n", read_cases(command.table, command.rules).cases.size()));
    Batch batch(command, console);
    batch.work();
    const Facts summary = batch.summary();
    if (!command.summary.empty()) write_file_atomically(command.summary, to_json_text(summary));
    console.print(fmt::format("\n{}{}", table_of(summary), warnings_line(summary, command, batch.journal())));
    const int failed = summary["failed"].get<int>(), open = summary["open"].get<int>(),
              running = summary["running"].get<int>();
    if (failed + open + running == 0) return;
    throw EndedEarly(fmt::format("{} of {} cases failed{}{}", failed, summary["cases"].size(),
                                 open > 0 ? fmt::format(", {} were not made", open) : "",
                                 running > 0 ? fmt::format(", {} being made by another process", running) : ""),
                     kCasesFailedExitCode);
}

}  // namespace kontur::app
