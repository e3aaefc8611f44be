// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dctk.h>
#include <dcmtk/dcmjpeg/djdecode.h>
#include <dcmtk/dcmjpeg/djencode.h>
#include <dcmtk/dcmjpeg/djrplol.h>
#include <dcmtk/dcmjpls/djencode.h>
#include <dcmtk/dcmjpls/djrparam.h>
#include <dcmtk/oflog/oflog.h>

#include <filesystem>
#include <stdexcept>

namespace kontur::test {

/// Rewrites every DICOM file in the folder with its pixels compressed without loss (EXS_JPEGProcess14SV1: JPEG,
/// EXS_JPEGLSLossless: JPEG-LS).
inline void recompress(const std::filesystem::path& folder, E_TransferSyntax syntax) {
    OFLog::configure(OFLogger::OFF_LOG_LEVEL);
    DJEncoderRegistration::registerCodecs();
    DJLSEncoderRegistration::registerCodecs();
    const DJ_RPLossless jpeg;
    const DJLSRepresentationParameter jpeg_ls;
    const DcmRepresentationParameter* how = &jpeg_ls;
    if (syntax == EXS_JPEGProcess14SV1) how = &jpeg;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
        DcmFileFormat file;
        const OFFilename name(entry.path().c_str());
        if (file.loadFile(name).bad() || file.loadAllDataIntoMemory().bad() ||
            file.getDataset()->chooseRepresentation(syntax, how).bad() || file.saveFile(name, syntax).bad())
            throw std::runtime_error("cannot recompress " + entry.path().string());
    }
}

}  // namespace kontur::test
