// SPDX-License-Identifier: Apache-2.0
// ITK's morphological contour interpolation (Albu, Beugeling and Laurendeau 2008), which 3D Slicer and ITK-SNAP use, as a
// program: a peer of `kontur fill` in bench/fill.py. The filter belongs to a remote module of ITK that Debian's ITK does not
// contain: whoever wants to measure it says where its sources are (-DKONTUR_ITK_MODULE=FOLDER).
#include <itkImageFileReader.h>
#include <itkImageFileWriter.h>
#include <itkMorphologicalContourInterpolator.h>
#include <itkMultiThreaderBase.h>
#include <itkNiftiImageIOFactory.h>

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <stdexcept>
#include <string>
#include <vector>

namespace {

using LabelMap = itk::Image<std::uint8_t, 3>;

/// What the filter's own options do; the defaults are the filter's.
void set(itk::MorphologicalContourInterpolator<LabelMap>& filter, const std::string& option) {
    if (option == "--dilations") filter.SetUseDistanceTransform(false);
    else if (option == "--ball") filter.SetUseBallStructuringElement(true);
    else if (option == "--no-extrapolation") filter.SetUseExtrapolation(false);
    else throw std::invalid_argument("unknown option " + option);
}

void fill(const std::string& sparse, const std::string& full, const std::vector<std::string>& options) {
    const auto reader = itk::ImageFileReader<LabelMap>::New();
    reader->SetFileName(sparse);
    const auto filter = itk::MorphologicalContourInterpolator<LabelMap>::New();
    filter->SetInput(reader->GetOutput());
    for (const std::string& option : options) set(*filter, option);
    const auto writer = itk::ImageFileWriter<LabelMap>::New();
    writer->SetFileName(full);
    writer->SetInput(filter->GetOutput());
    writer->Update();
}

}  // namespace

int main(int argc, char** argv) {
    if (argc < 3) {
        std::fputs("usage: itk_fill SPARSE.nii FULL.nii [--dilations] [--ball] [--no-extrapolation]\n", stderr);
        return EXIT_FAILURE;
    }
    itk::NiftiImageIOFactory::RegisterOneFactory();
    // The filter keeps others for each thread, and ITK's pool of threads now and then aborts when it ends with them.
    itk::MultiThreaderBase::SetGlobalDefaultThreader(itk::MultiThreaderBase::ThreaderEnum::Platform);
    itk::MultiThreaderBase::SetGlobalMaximumNumberOfThreads(1);
    try {
        fill(argv[1], argv[2], {argv + 3, argv + argc});
    } catch (const std::exception& error) {
        std::fprintf(stderr, "itk_fill: error: %s\n", error.what());
        return EXIT_FAILURE;
    }
    return EXIT_SUCCESS;
}
