// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <ostream>
#include <span>
#include <string>
#include <string_view>

namespace kontur::fuzz {

using Bytes = std::span<const std::uint8_t>;

/// Something that untrusted bytes are fed to. It may end normally or in a kontur::Error, and in nothing else.
struct Target {
    std::string_view name;
    void (*run)(Bytes);
};

/// By its name in the list of tests, not by its address.
inline void PrintTo(const Target& target, std::ostream* out) { *out << target.name; }

/// All of them; libFuzzer runs one (KONTUR_FUZZ_TARGET), the test suite replays findings through each.
std::span<const Target> targets();

/// nullptr when there is none of that name.
const Target* find_target(std::string_view name);

/// Runs the target; a kontur::Error is a good end if it is one printable sentence, else the process is aborted.
void run(const Target& target, Bytes bytes);

// The targets, by file.
void nifti(Bytes bytes);
void nrrd(Bytes bytes);
void metaimage(Bytes bytes);
void nifti_pair(Bytes bytes);
void mgh(Bytes bytes);
void gipl(Bytes bytes);
void dicom(Bytes bytes);
void dicom_seg(Bytes bytes);
void rtstruct(Bytes bytes);
void contour_json(Bytes bytes);
void markups(Bytes bytes);
void stl(Bytes bytes);
void ply(Bytes bytes);
void obj(Bytes bytes);
void vtk(Bytes bytes);
void vtp(Bytes bytes);
void csv(Bytes bytes);
void pipeline(Bytes bytes);
void fitting(Bytes bytes);
void messages(Bytes bytes);
void project(Bytes bytes);

}  // namespace kontur::fuzz
