// SPDX-License-Identifier: Apache-2.0
#include "viewer/imports.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <spawn.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstring>
#include <limits>
#include <new>
#include <nlohmann/json.hpp>
#include <thread>

#include "kontur/base/error.h"
#include "kontur/extract/trace.h"
#include "kontur/io/atomic_file.h"
#include "kontur/io/contours.h"
#include "kontur/io/dicom_seg.h"
#include "kontur/io/image.h"
#include "kontur/io/rtstruct.h"
#include "kontur/shape/repeated_contours.h"
#include "viewer/model_json.h"
#include "viewer/temporary_files.h"
#include "viewer/unkept.h"
#include "viewer/views.h"

namespace kontur::viewer {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using Clock = std::chrono::steady_clock;

constexpr rlim_t kMostMemory = rlim_t{8} << 30;
constexpr rlim_t kLargestResult = rlim_t{256} << 20;
constexpr rlim_t kMostProcessorSeconds = 600;
constexpr std::chrono::seconds kPatience{300};
constexpr std::size_t kMostImportedLabels = 64;
constexpr const char* kResult = "result.json";

/// Traced contours keep what matters of a mask at a tenth of a millimetre; smaller sections are specks.
constexpr TraceOptions kTraceOptions{.step_mm = 0, .tolerance_mm = 0.1, .min_area_mm2 = 4};

// In the process that reads

/// Address sanitizers reserve terabytes, and would die of a limit that a plain build never meets.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kLimitsMemory = false;
#elif defined(__has_feature)  // clang's way to say so
constexpr bool kLimitsMemory = !__has_feature(address_sanitizer) && !__has_feature(thread_sanitizer);
#else
constexpr bool kLimitsMemory = true;
#endif

void limit(int what, rlim_t most) {
    rlimit now{};
    getrlimit(what, &now);
    const rlimit lower{std::min(most, now.rlim_max), std::min(most, now.rlim_max)};
    setrlimit(what, &lower);
}

/// Nothing of the server's may be in reach of what reads a foreign file, nor may it outlive the server, not even one that
/// ended while this process began.
void limit_this_process(pid_t server) {
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (getppid() != server) _exit(exit_code(ErrorKind::io));
    prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0);
    close_range(STDERR_FILENO + 1, ~0U, 0);
    if (kLimitsMemory) limit(RLIMIT_AS, kMostMemory);
    limit(RLIMIT_CPU, kMostProcessorSeconds);
    limit(RLIMIT_FSIZE, kLargestResult);
    limit(RLIMIT_CORE, 0);
    signal(SIGXFSZ, SIG_IGN);  // a write beyond the limit then fails, and is told as such
}

/// Planes across `kind`, spread evenly over the mask's extent; a mask has half a step of room beyond the outermost ones.
std::vector<Plane> planes_across(const Mask& mask, SliceKind kind, int count) {
    View view = view_of(mask.grid, kind);
    double from = std::numeric_limits<double>::infinity(), to = -from;
    const Index3& n = mask.grid.size;
    for (std::int64_t k = 0; k < n.k; ++k)
        for (std::int64_t j = 0; j < n.j; ++j)
            for (std::int64_t i = 0; i < n.i; ++i)
                if (mask.values[mask.grid.offset(i, j, k)]) {
                    const double at = view.plane.distance_to(mask.grid.center_mm(i, j, k));
                    from = std::min(from, at), to = std::max(to, at);
                }
    std::vector<Plane> planes;
    for (int i = 0; i < count; ++i) {
        // On the mask's own slices, where its border is not interpolated, and each of them once.
        const double at = from + (to - from) * (i + 0.5) / count;
        Plane plane = view.plane;
        plane.origin += std::round(at / view.step_mm) * view.step_mm * plane.normal;
        if (planes.empty() || distance(planes.back().origin, plane.origin) > 0.5 * view.step_mm) planes.push_back(plane);
    }
    return planes;
}

ContourSet traced(const Mask& mask, const TraceRequest& request) {
    std::vector<Plane> planes;
    const auto add = [&](bool wanted, SliceKind kind) {
        if (!wanted) return;
        const std::vector<Plane> more = planes_across(mask, kind, request.planes);
        planes.insert(planes.end(), more.begin(), more.end());
    };
    add(request.axial, SliceKind::axial);
    add(request.sagittal, SliceKind::sagittal);
    add(request.coronal, SliceKind::coronal);
    return trace(mask, planes, kTraceOptions);
}

/// Every region that has contours.
Imported read_rtstruct_of(const fs::path& path) {
    Imported imported;
    StructureSet set = read_rtstruct(path);
    imported.notes = std::move(set.notes);
    for (Roi& roi : set.rois) {
        if (!roi.damage.empty()) imported.notes.push_back("left out: " + roi.damage);
        for (const std::string& note : roi.notes) imported.notes.push_back(roi.name + ": " + note);
        for (const std::string& note : leave_out_unkept(roi.contours)) imported.notes.push_back(roi.name + ": " + note);
        if (roi.contours.contours.empty()) {
            if (!roi.contours.surface.empty()) imported.notes.push_back(roi.name + ": left out: points without a contour");
            continue;
        }
        if (imported.frame_of_reference_uid.empty()) imported.frame_of_reference_uid = roi.frame_of_reference_uid;
        check_contours(roi.contours);
        imported.sets.push_back(std::move(roi.contours));
    }
    if (imported.sets.empty()) throw Error(ErrorKind::invalid_input, "no region of this structure set has contours");
    return imported;
}

/// Adds what a mask becomes, or why it becomes nothing.
void add_traced(Imported& imported, const Mask& mask, const std::string& name, const TraceRequest& request) {
    ContourSet set = traced(mask, request);
    set.name = name;
    if (set.contours.empty()) imported.notes.push_back(fmt::format("{} is too small to be traced", name));
    else imported.sets.push_back(std::move(set));
}

/// Every segment of a DICOM segmentation, they may overlap.
Imported read_segments_of(const fs::path& path, const TraceRequest& request) {
    const DicomSegmentation about = read_dicom_segmentation(path);
    if (about.segments.size() > kMostImportedLabels)
        throw Error(ErrorKind::too_large, fmt::format("the segmentation has {} segments; the limit is {}",
                                                      about.segments.size(), kMostImportedLabels));
    Imported imported{{}, about.notes, about.frame_of_reference_uid};
    const std::vector<Mask> masks = read_dicom_seg_masks(path);
    for (std::size_t n = 0; n < masks.size(); ++n) {
        const DicomSegment& segment = about.segments[n];
        add_traced(imported, masks[n], segment.label.empty() ? fmt::format("Segment {}", segment.number) : segment.label,
                   request);
    }
    if (imported.sets.empty())
        throw Error(ErrorKind::invalid_input, "the segmentation has nothing that is large enough to trace");
    imported.notes.push_back(
        fmt::format("segments were traced into contours on up to {} planes along each axis", request.planes));
    return imported;
}

Imported read_contours_of(const fs::path& path, const TraceRequest& request) {
    if (path.extension() == ".dcm" && is_rtstruct(path)) return read_rtstruct_of(path);
    if (path.extension() == ".dcm" && is_dicom_seg(path)) return read_segments_of(path, request);
    ReadContours read = read_contours(path);
    for (std::string& note : check_and_tidy(read.contours)) read.notes.push_back(std::move(note));
    for (std::string& note : leave_out_unkept(read.contours)) read.notes.push_back(std::move(note));
    return {{std::move(read.contours)}, std::move(read.notes), std::move(read.frame_of_reference_uid)};
}

Imported read_mask_of(const fs::path& path, const TraceRequest& request) {
    const Image labels = read_image(path);
    const auto counts = count_labels(labels, kMostImportedLabels);
    if (counts.empty()) throw Error(ErrorKind::invalid_input, "the mask is empty");
    Imported imported;
    for (const auto& [label, voxels] : counts)
        add_traced(imported, select_label(labels, static_cast<double>(label)),
                   counts.size() == 1 ? "Imported mask" : fmt::format("Label {}", label), request);
    if (imported.sets.empty()) throw Error(ErrorKind::invalid_input, "the mask has nothing that is large enough to trace");
    return imported;
}

json result_of(const Upload& upload) {
    const fs::path path = "upload" + upload.extension;
    const Imported imported =
        upload.content == Upload::Content::mask ? read_mask_of(path, upload.trace) : read_contours_of(path, upload.trace);
    for (std::size_t i = 0; i < imported.sets.size(); ++i) write_contours(fmt::format("{}.json", i), imported.sets[i]);
    return {{"sets", imported.sets.size()}, {"notes", imported.notes}, {"frame", imported.frame_of_reference_uid}};
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

// Between both: the words of its command line

std::vector<std::string> words_of(const Upload& upload) {
    std::string axes;
    if (upload.trace.axial) axes += 'a';
    if (upload.trace.sagittal) axes += 's';
    if (upload.trace.coronal) axes += 'c';
    return {"kontur",
            kImportWorker,
            upload.content == Upload::Content::mask ? "mask" : "contours",
            upload.extension,
            std::to_string(upload.trace.planes),
            axes,
            std::to_string(getpid())};
}

Upload upload_from(char** words) {
    const std::string_view content = words[2], axes = words[5];
    const auto has = [&](char axis) { return axes.find(axis) != std::string_view::npos; };
    return {content == "mask" ? Upload::Content::mask : Upload::Content::contours,
            words[3],
            {std::atoi(words[4]), has('a'), has('s'), has('c')},
            false};
}

// In the server

/// The process that reads; killed where it is no longer wanted.
class Worker {
public:
    Worker(const Upload& upload, const fs::path& folder) {
        std::vector<std::string> words = words_of(upload);
        std::vector<char*> argv(words.size() + 1, nullptr);
        std::transform(words.begin(), words.end(), argv.begin(), [](std::string& word) { return word.data(); });
        posix_spawn_file_actions_t actions;
        posix_spawn_file_actions_init(&actions);
        for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
            posix_spawn_file_actions_addopen(&actions, stream, "/dev/null", O_RDWR, 0);
        posix_spawn_file_actions_addchdir_np(&actions, folder.c_str());
        const int failure = posix_spawn(&id_, "/proc/self/exe", &actions, nullptr, argv.data(), environ);
        posix_spawn_file_actions_destroy(&actions);
        if (failure != 0) {
            id_ = 0;
            throw Error(ErrorKind::io, fmt::format("cannot start a process to read the file: {}", std::strerror(failure)));
        }
    }
    ~Worker() {
        if (id_ == 0) return;
        kill(id_, SIGKILL);
        waitpid(id_, nullptr, 0);
    }
    Worker(const Worker&) = delete;
    Worker& operator=(const Worker&) = delete;

    /// Its status as `waitpid` tells it.
    int wait(const Work& work) {
        const Clock::time_point start = Clock::now();
        int status = 0;
        for (std::chrono::milliseconds pause(1);; pause = std::min(2 * pause, std::chrono::milliseconds(20))) {
            if (waitpid(id_, &status, WNOHANG) == id_) break;
            work.check();
            if (Clock::now() - start > kPatience) {
                throw Error(ErrorKind::too_large,
                            fmt::format("reading the file took longer than {} s, and was given up", kPatience.count()));
            }
            std::this_thread::sleep_for(pause);
        }
        id_ = 0;
        return status;
    }

private:
    pid_t id_ = 0;
};

[[noreturn]] void fail(const json& error) {
    const std::string kind = error.at("kind"), sentence = error.at("message");
    for (const ErrorKind known : {ErrorKind::invalid_input, ErrorKind::unsupported, ErrorKind::corrupt_file, ErrorKind::io,
                                  ErrorKind::singular_system, ErrorKind::too_large})
        if (name(known) == kind) throw Error(known, sentence);
    throw Error(ErrorKind::corrupt_file, sentence);
}

Imported result_in(const fs::path& folder, int status, const Work& work) {
    std::error_code ignored;
    if (!fs::exists(folder / kResult, ignored)) {
        if (WIFSIGNALED(status) && WTERMSIG(status) == SIGXCPU)
            throw Error(ErrorKind::too_large,
                        fmt::format("reading the file took more than {} s of computing, and was given up",
                                    static_cast<std::uint64_t>(kMostProcessorSeconds)));
        throw Error(ErrorKind::corrupt_file,
                    "the file cannot be read: reading it failed in a way that kontur did not foresee. Nothing was changed");
    }
    const json result = json::parse(read_bytes(folder / kResult));
    if (result.contains("error")) fail(result["error"]);
    Imported imported;
    for (std::size_t i = 0; i < result.at("sets").get<std::size_t>(); ++i) {
        work.check();
        imported.sets.push_back(read_contours(folder / fmt::format("{}.json", i)).contours);
    }
    imported.notes = result.at("notes").get<std::vector<std::string>>();
    imported.frame_of_reference_uid = result.at("frame").get<std::string>();
    return imported;
}

}  // namespace

Imported import_apart(const std::string& bytes, const Upload& upload, const Work& work) {
    const TemporaryFolder folder;
    write_file_atomically(folder.path() / ("upload" + upload.extension), bytes);
    const int status = Worker(upload, folder.path()).wait(work);
    return result_in(folder.path(), status, work);
}

int import_worker(int argc, char** argv) {
    constexpr int kWords = 7;
    if (argc != kWords) return exit_code(ErrorKind::invalid_input);
    limit_this_process(std::atoi(argv[6]));
    const Upload upload = upload_from(argv);
    json result;
    try {
        result = result_of(upload);
    } catch (const Error& error) {
        result["error"] = error_of(error, upload);
    } catch (const std::bad_alloc&) {
        result["error"] = error_json(ErrorKind::too_large, "the file needs more memory than an import may use");
    } catch (const std::exception& error) {
        result["error"] = error_json(ErrorKind::corrupt_file, fmt::format("the file cannot be read: {}", error.what()));
    }
    write_file_atomically(kResult, to_text(result));
    return 0;
}

}  // namespace kontur::viewer
