# SPDX-License-Identifier: Apache-2.0
# fmt and nlohmann-json by their headers alone, for builds that link nothing else. By paths, and not by their packages, which are
# for one architecture: a cross compiler takes them from a folder that has nothing else (FMT_INCLUDE_DIR, JSON_INCLUDE_DIR).
# An sdist brings them in third_party.
find_path(FMT_INCLUDE_DIR fmt/format-inl.h HINTS ${PROJECT_SOURCE_DIR}/third_party REQUIRED)
find_path(JSON_INCLUDE_DIR nlohmann/json.hpp HINTS ${PROJECT_SOURCE_DIR}/third_party REQUIRED)
set(header_libraries kontur_json kontur_fmt)
add_library(kontur_json INTERFACE)
target_include_directories(kontur_json SYSTEM INTERFACE ${JSON_INCLUDE_DIR})

file(STRINGS ${FMT_INCLUDE_DIR}/fmt/core.h version REGEX "^#define FMT_VERSION ")
if(version MATCHES " 9....$")
  add_library(kontur_fmt STATIC fmt_definitions.cpp)
  target_include_directories(kontur_fmt SYSTEM PUBLIC ${FMT_INCLUDE_DIR})
  target_compile_features(kontur_fmt PUBLIC cxx_std_20)
  target_compile_definitions(kontur_fmt INTERFACE FMT_SHARED)  # the flags of other builds, whose objects ccache has
else()
  add_library(kontur_fmt INTERFACE)
  target_include_directories(kontur_fmt SYSTEM INTERFACE ${FMT_INCLUDE_DIR})
  target_compile_definitions(kontur_fmt INTERFACE FMT_HEADER_ONLY=1)
endif()
