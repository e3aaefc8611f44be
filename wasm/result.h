// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <exception>
#include <new>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include "kontur/base/error.h"
#include "kontur/base/work.h"
#include "kontur/function/implicit_function.h"
#include "kontur/shape/mesh.h"

// What calls of JavaScript make, and how they fail.

#define KONTUR_EXPORT(name) extern "C" __attribute__((export_name(#name))) auto name

namespace kontur::wasm {

/// Arrays of numbers as JavaScript takes them, and what else a call made.
struct Result {
    nlohmann::json about;  ///< answered as text
    std::string text{};
    std::vector<std::uint8_t> voxels{};  ///< the bytes of a mask's or an image's samples
    std::vector<float> points{}, normals{};
    std::vector<std::uint32_t> triangles{};
    TriangleMesh mesh{};
    ImplicitFunction function{};
};

/// Which kontur_error tells then.
void note_error(std::string_view kind, std::string_view message);

/// 0 where `make` throws.
template <class Make>
auto or_error(const Make& make) -> decltype(make()) {
    try {
        return make();
    } catch (const Error& error) {
        note_error(name(error.kind()), error.what());
    } catch (const std::bad_alloc&) {
        note_error(name(ErrorKind::too_large), "it needs more memory than the 4 GB that WebAssembly can address");
    } catch (const std::exception& error) {
        note_error("internal", error.what());
    }
    return {};
}

/// On one thread; tells JavaScript how far it is, which may stop it.
Work told_work();

}  // namespace kontur::wasm
