// SPDX-License-Identifier: Apache-2.0
#include "kontur/io/dicom/dicom_suv.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cmath>

#include "kontur/base/error.h"
#include "kontur/io/dicom/dcmtk.h"

namespace kontur {
namespace {

constexpr double kDay_s = 86400;
constexpr double kMostHalfLives = 10;            ///< from dose to scan: then a thousandth is left, and nothing is seen
constexpr double kSameDayHalfLife_s = 6 * 3600;  ///< of tracers that live longer patients come back on another day

/// Why there is no SUV.
struct NoSuv {
    std::string because;
};

[[noreturn]] void missing(const DcmTagKey& tag) { throw NoSuv{dcmtk::tag_name(tag) + " is missing"}; }

std::string needed_text(DcmItem& item, const DcmTagKey& tag) {
    std::string text = dcmtk::text(item, tag);
    if (text.empty()) missing(tag);
    return text;
}

double needed_positive(DcmItem& item, const DcmTagKey& tag) {
    const std::vector<double> values = dcmtk::decimals(item, tag);
    if (values.empty()) missing(tag);
    if (!(values.front() > 0))
        throw NoSuv{fmt::format("{} is {:g}; more than 0 is needed", dcmtk::tag_name(tag), values.front())};
    return values.front();
}

/// Digits of `text` from `at` on; nullopt where there are fewer or others.
std::optional<int> digits(std::string_view text, std::size_t at, std::size_t count) {
    int value = 0;
    if (text.size() < at + count) return std::nullopt;
    const auto [end, error] = std::from_chars(text.data() + at, text.data() + at + count, value);
    const bool is_whole = error == std::errc{} && end == text.data() + at + count && text[at] != '-';
    return is_whole ? std::optional(value) : std::nullopt;
}

/// Seconds since midnight of a TM ("HHMM", "HHMMSS" or "HHMMSS.FFF").
std::optional<double> time_of_day_s(std::string_view text) {
    const auto hours = digits(text, 0, 2), minutes = digits(text, 2, 2);
    if (!hours || !minutes) return std::nullopt;
    double seconds = digits(text, 4, 2).value_or(0);
    if (text.size() > 7 && text[6] == '.') {
        double divisor = 1;
        for (std::size_t at = 7; at < text.size() && digits(text, at, 1); ++at)
            seconds += *digits(text, at, 1) / (divisor *= 10);
    }
    return 3600.0 * *hours + 60.0 * *minutes + seconds;
}

/// Seconds since 1970 of a DA ("YYYYMMDD") at midnight.
std::optional<double> date_s(std::string_view text) {
    const auto year = digits(text, 0, 4), month = digits(text, 4, 2), day = digits(text, 6, 2);
    if (!year || !month || !day) return std::nullopt;
    const std::chrono::year_month_day date{std::chrono::year(*year), std::chrono::month(static_cast<unsigned>(*month)),
                                           std::chrono::day(static_cast<unsigned>(*day))};
    if (!date.ok()) return std::nullopt;
    return kDay_s * static_cast<double>(std::chrono::sys_days(date).time_since_epoch().count());
}

template <class Read>
double readable(DcmItem& item, const DcmTagKey& tag, const Read& read) {
    const std::string text = needed_text(item, tag);
    if (const auto value = read(text)) return *value;
    throw NoSuv{fmt::format("{} is \"{}\", which is none", dcmtk::tag_name(tag), text)};
}

double moment_s(DcmItem& item, const DcmTagKey& date, const DcmTagKey& time) {
    return readable(item, date, date_s) + readable(item, time, time_of_day_s);
}

/// To which decay was corrected (DecayCorrection START).
double scan_begin_s(DcmItem& item) {
    const double series = moment_s(item, DCM_SeriesDate, DCM_SeriesTime);
    if (series > moment_s(item, DCM_AcquisitionDate, DCM_AcquisitionTime))
        throw NoSuv{"the series' time is after the acquisition's, so that it does not say when the scan began"};
    return series;
}

/// From the dose to `scan_s`. Where the file has the time of day alone, it is the last one before the scan.
double waited_s(DcmItem& tracer, double scan_s, double half_life_s) {
    const std::string stamp = dcmtk::text(tracer, DCM_RadiopharmaceuticalStartDateTime);
    const auto day = date_s(stamp);
    const auto time = stamp.size() > 8 ? time_of_day_s(std::string_view(stamp).substr(8)) : std::nullopt;
    if (day && time) return scan_s - *day - *time;
    if (half_life_s > kSameDayHalfLife_s) missing(DCM_RadiopharmaceuticalStartDateTime);
    const double of_day = readable(tracer, DCM_RadiopharmaceuticalStartTime, time_of_day_s);
    return std::fmod(std::fmod(scan_s - of_day, kDay_s) + kDay_s, kDay_s);
}

double decayed_share(DcmItem& item, DcmItem& tracer, double& waited) {
    const std::string corrected_to = needed_text(item, DCM_DecayCorrection);
    if (corrected_to == "ADMIN") return 1;
    if (corrected_to != "START")
        throw NoSuv{
            fmt::format("{} is \"{}\"; START or ADMIN is needed", dcmtk::tag_name(DCM_DecayCorrection), corrected_to)};
    const double half_life = needed_positive(tracer, DCM_RadionuclideHalfLife);
    waited = waited_s(tracer, scan_begin_s(item), half_life);
    if (!(waited >= 0 && waited <= kMostHalfLives * half_life))
        throw NoSuv{fmt::format("the tracer, whose half-life is {:.4g} min, was given {:.4g} min {} the scan began",
                                half_life / 60, std::abs(waited) / 60, waited < 0 ? "after" : "before")};
    return std::exp2(-waited / half_life);
}

void check_corrections(DcmItem& item) {
    const std::string corrections = needed_text(item, DCM_CorrectedImage);
    for (const char* needed : {"DECY", "ATTN"})
        if (corrections.find(needed) == std::string::npos)
            throw NoSuv{fmt::format("{} is \"{}\", without {}", dcmtk::tag_name(DCM_CorrectedImage), corrections, needed)};
}

SuvScale scale_of(DcmItem& item) {
    check_corrections(item);
    const double weight_kg = needed_positive(item, DCM_PatientWeight);
    const std::vector<DcmItem*> tracers = dcmtk::items(item, DCM_RadiopharmaceuticalInformationSequence);
    if (tracers.empty()) missing(DCM_RadiopharmaceuticalInformationSequence);
    if (tracers.size() > 1) throw NoSuv{fmt::format("{} tracers were given; 1 is needed", tracers.size())};
    const double dose_bq = needed_positive(*tracers.front(), DCM_RadionuclideTotalDose);
    double waited = 0;
    const double left_bq = dose_bq * decayed_share(item, *tracers.front(), waited);
    // Some write MBq, where the standard has Bq: nobody is given so little, or so much.
    if (!(dose_bq >= 1e5 && dose_bq <= 1e11))
        throw NoSuv{fmt::format("{} is {:g} Bq; from 1e5 to 1e11 is plausible", dcmtk::tag_name(DCM_RadionuclideTotalDose),
                                dose_bq)};
    const double scale = 1000 * weight_kg / left_bq;
    return {scale, fmt::format("Values are SUV by body weight: 1 g/ml is {:.4g} Bq/ml, of {:g} kg and {:.4g} MBq{}.",
                               1 / scale, weight_kg, dose_bq / 1e6,
                               waited > 0 ? fmt::format(" given {:.0f} min before the scan", waited / 60) : "")};
}

}  // namespace

std::optional<SuvScale> suv_scale(const std::filesystem::path& file) {
    dcmtk::set_up();
    DcmFileFormat dicom;
    dcmtk::load(dicom, file, DCM_PixelData);
    DcmItem& item = *dicom.getDataset();
    if (dcmtk::text(item, DCM_Modality) != "PT" || dcmtk::text(item, DCM_Units) != "BQML") return std::nullopt;
    try {
        return scale_of(item);
    } catch (const NoSuv& reason) {
        return SuvScale{0, fmt::format("Values stay in Bq/ml, since SUV cannot be told: {}.", reason.because)};
    } catch (const Error& error) {
        return SuvScale{0, fmt::format("Values stay in Bq/ml, since SUV cannot be told: {}.", error.what())};
    }
}

}  // namespace kontur
