// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <span>
#include <vector>

namespace kontur::app {

/// The file that a name leads to, absolute and without links, so that two names of one file become one. Throws Error(io) for
/// links that lead in a circle.
std::filesystem::path destination(const std::filesystem::path& target);

/// Throws, before any work is done, what writing to `target` would throw after it: Error(invalid_input) when it is one of
/// the `inputs` or a slice of a DICOM series among them (given by its folder, one above it, or one slice), Error(io) when
/// its folder does not exist or may not be written to, or it is no regular file or write-protected. Empty paths are left
/// out.
void check_output(const std::filesystem::path& target, std::span<const std::filesystem::path> inputs);

/// The same for all outputs of a command, of which no two may be one file.
void check_outputs(std::span<const std::filesystem::path> targets, std::span<const std::filesystem::path> inputs);

/// The files of one command, which appear all together or not at all. Each is written into a hidden folder beside its target
/// and moved into place by `commit`; without a commit (an error, Ctrl-C) the hidden folders vanish with their content.
class Outputs {
public:
    Outputs() = default;
    ~Outputs();
    Outputs(const Outputs&) = delete;
    Outputs& operator=(const Outputs&) = delete;

    /// Calls `writer` with the path to write what shall become `target`; it has the same file name. Errors of the writer
    /// name the target. Throws Error(io), and Error(invalid_input) for the same target twice.
    void write(const std::filesystem::path& target, const std::function<void(const std::filesystem::path&)>& writer);

    /// Makes the folder if it is not there; without a commit it vanishes again. Throws Error(io).
    void create_folder(const std::filesystem::path& folder);

    /// Moves everything into place; when one file cannot be moved, those before it are taken back. Call once, last. Throws
    /// Error(io).
    void commit();

private:
    /// What stood at a target before the commit.
    struct PreviousFile {
        std::filesystem::path target, kept;  ///< kept: "" for nothing
    };

    void take_back(std::vector<PreviousFile>& before);
    std::filesystem::path staging_folder(const std::filesystem::path& folder);

    std::map<std::filesystem::path, std::filesystem::path> folders_;  ///< target folder to hidden folder
    std::map<std::filesystem::path, std::filesystem::path> files_;    ///< target to where it waits
    std::vector<int> locks_;                                          ///< of the hidden folders, until they are gone
    std::filesystem::path created_folder_;                            ///< to be removed again; empty: none
};

}  // namespace kontur::app
