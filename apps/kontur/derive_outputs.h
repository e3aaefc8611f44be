// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "commands.h"
#include "derive_sources.h"
#include "kontur/derive/derive.h"
#include "kontur/shape/provenance.h"

namespace kontur::app {

/// A structure to write.
struct DeriveOutput {
    Mask mask;
    ContourSet outlines;  ///< with its name and attributes
    bool is_derived = true;
};

/// What rules made, behind their sources where these are asked for. Types of an RTSTRUCT are those of --type, else they
/// follow from names that begin with GTV, CTV or PTV and from BODY and EXTERNAL. Throws Error(invalid_input) for a --type of
/// none.
std::vector<DeriveOutput> derive_outputs(const DeriveCommand& command, const DeriveSources& sources,
                                         std::vector<DerivedStructure> derived, const Work& work);

/// What is said of a derived structure beside its voxels.
DicomSegment derived_segment(const std::string& name, const StructureAttributes& attributes);

/// Throws Error for what `--type` cannot mean.
void check_types(const std::vector<std::string>& types);

/// Write to the name's format and return what the user should know.
std::vector<std::string> write_derived(const std::filesystem::path& path, const DeriveCommand& command,
                                       const std::vector<DeriveOutput>& all, const Provenance& provenance, const Work& work);
std::vector<std::string> write_derived_rtstruct(const std::filesystem::path& path, const DeriveCommand& command,
                                                const std::vector<DeriveOutput>& all, const Provenance& provenance);
/// Each structure against each other, as CSV.
void write_relations(const std::filesystem::path& path, const std::vector<StructureRelation>& relations);

}  // namespace kontur::app
