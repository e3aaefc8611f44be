// SPDX-License-Identifier: Apache-2.0
#include "kontur/io/dicom/rtstruct_approval.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "kontur/io/dicom/dicom_document.h"
#include "kontur/io/dicom/dicom_names.h"

namespace kontur {
namespace {

using dcmtk::put;
using dcmtk::text;

constexpr std::size_t kMostName = 64;  ///< characters, of VR PN

std::string digits_of(const std::string& value) {
    std::string digits;
    for (const char c : value.substr(0, value.find('.', 8)))  // without fractions of a second
        if (c >= '0' && c <= '9') digits += c;
    return digits;
}

/// "2026-11-30T21:02:43" of DICOM's date and time, whose end may be missing; "" without a whole date.
std::string local_time(const std::string& date, const std::string& time) {
    const std::string day = digits_of(date);
    if (day.size() != 8) return "";
    std::string clock = digits_of(time);
    clock.resize(6, '0');
    return fmt::format("{}-{}-{}T{}:{}:{}", day.substr(0, 4), day.substr(4, 2), day.substr(6, 2), clock.substr(0, 2),
                       clock.substr(2, 2), clock.substr(4, 2));
}

std::string quoted_reviewer(const std::string& name) { return name.empty() ? "somebody" : fmt::format("'{}'", name); }

}  // namespace

void read_approval(DcmItem& dataset, StructureSet& set) {
    const std::string status = text(dataset, DCM_ApprovalStatus), name = text(dataset, DCM_ReviewerName);
    if (status == "REJECTED") set.notes.push_back(fmt::format("{} rejected this structure set", quoted_reviewer(name)));
    if (status != "APPROVED") return;
    const Approval approval{name, local_time(text(dataset, DCM_ReviewDate), text(dataset, DCM_ReviewTime))};
    for (Roi& roi : set.rois) roi.contours.attributes.review.approved = approval;
}

void put_approval(DcmItem& document, const std::vector<Roi>& rois, std::vector<std::string>& notes) {
    std::vector<Approval> approvals;
    for (const Roi& roi : rois)
        if (const auto& approved = roi.contours.attributes.review.approved) approvals.push_back(*approved);
    const bool all = !rois.empty() && approvals.size() == rois.size();
    put(document, DCM_ApprovalStatus, all ? "APPROVED" : "UNAPPROVED");
    if (!all) {
        if (!approvals.empty())
            notes.push_back(fmt::format("{} of {} ROIs {} approved; DICOM approves all or none, so the file says UNAPPROVED",
                                        approvals.size(), rois.size(), approvals.size() == 1 ? "is" : "are"));
        return;
    }
    const Approval& last = *std::ranges::max_element(approvals, {}, &Approval::at);
    std::set<std::string> names;
    for (const Approval& one : approvals) names.insert(one.by);
    const std::string name = dcmtk::noted_value(last.by, kMostName, "the reviewer's name", notes);
    if (names.size() > 1)
        notes.push_back(fmt::format("{} people approved the ROIs; DICOM has room for one, and the file names {}, the last",
                                    names.size(), quoted_reviewer(name)));
    const std::string digits = digits_of(last.at);
    put(document, DCM_ReviewDate, digits.substr(0, 8));
    put(document, DCM_ReviewTime, digits.size() > 8 ? digits.substr(8) : "");
    put(document, DCM_ReviewerName, name);
}

}  // namespace kontur
