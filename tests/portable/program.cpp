// SPDX-License-Identifier: Apache-2.0
// From contours as JSON to a mask and a mesh, with the core alone. Usage: program FOLDER CASE ...: writes CASE.json,
// CASE.nii and CASE.stl of cases of the phantom.
#include <exception>
#include <filesystem>
#include <fstream>
#include <iostream>

#include "kontur/io/contours/contour_json.h"
#include "kontur/io/images/image_view.h"
#include "kontur/io/images/nifti.h"
#include "kontur/io/meshes/mesh.h"
#include "kontur/phantom/cases.h"
#include "kontur/segment.h"

namespace {

void segment_case(const std::filesystem::path& folder, const std::string& name) {
    const kontur::PhantomCase chosen = kontur::phantom_case(name);
    const std::string text = kontur::to_contour_json(chosen.contours);
    std::ofstream(folder / (name + ".json")) << text;
    kontur::SegmentOptions options;
    options.mesh = true;
    const kontur::Segmentation made = kontur::segment(kontur::parse_contour_json(text), chosen.grid, options);
    kontur::write_nifti(folder / (name + ".nii"), kontur::ImageView(made.mask));
    kontur::write_mesh(folder / (name + ".stl"), made.mesh.value());
    std::cout << name << " " << made.report.mask_volume_ml << " ml\n";
}

}  // namespace

int main(int count, char** words) {
    try {
        for (int n = 2; n < count; ++n) segment_case(words[1], words[n]);
    } catch (const std::exception& error) {
        std::cerr << error.what() << "\n";
        return 1;
    }
}
