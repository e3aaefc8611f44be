// SPDX-License-Identifier: Apache-2.0
// ITK's signed distances (Maurer, Qi and Raghavan 2003) of a mask, in mm, negative inside, as a program: what
// bench/margins.py holds margins against. ITK measures from the centres of the object's outermost voxels, which for places
// inside lie on the wrong side: those are measured from the voxels around the object.
#include <itkImageFileReader.h>
#include <itkImageFileWriter.h>
#include <itkNiftiImageIOFactory.h>
#include <itkSignedMaurerDistanceMapImageFilter.h>

#include <cstdint>
#include <cstdio>
#include <cstdlib>

namespace {

using Mask = itk::Image<std::uint8_t, 3>;
using Distances = itk::Image<float, 3>;

Distances::Pointer distances(Mask* mask) {
    const auto filter = itk::SignedMaurerDistanceMapImageFilter<Mask, Distances>::New();
    filter->SetInput(mask);
    filter->SetUseImageSpacing(true);
    filter->SetSquaredDistance(false);
    filter->Update();
    return filter->GetOutput();
}

void measure(const char* mask, const char* result) {
    const auto reader = itk::ImageFileReader<Mask>::New();
    reader->SetFileName(mask);
    reader->Update();
    const Distances::Pointer from_object = distances(reader->GetOutput());
    Mask* const voxels = reader->GetOutput();
    const std::size_t count = voxels->GetBufferedRegion().GetNumberOfPixels();
    std::uint8_t* const values = voxels->GetBufferPointer();
    for (std::size_t n = 0; n < count; ++n) values[n] = values[n] == 0;
    voxels->Modified();
    const Distances::Pointer around = distances(voxels);
    for (std::size_t n = 0; n < count; ++n)
        if (values[n] == 0) from_object->GetBufferPointer()[n] = -around->GetBufferPointer()[n];
    const auto writer = itk::ImageFileWriter<Distances>::New();
    writer->SetFileName(result);
    writer->SetInput(from_object);
    writer->Update();
}

}  // namespace

int main(int count, char** arguments) {
    if (count != 3) {
        std::fprintf(stderr, "usage: itk_distance MASK DISTANCES\n");
        return EXIT_FAILURE;
    }
    try {
        itk::NiftiImageIOFactory::RegisterOneFactory();
        measure(arguments[1], arguments[2]);
        return EXIT_SUCCESS;
    } catch (const std::exception& error) {
        std::fprintf(stderr, "itk_distance: %s\n", error.what());
        return EXIT_FAILURE;
    }
}
