# SPDX-License-Identifier: Apache-2.0
# What throws and catches: Debian's libc++abi for WebAssembly has no exceptions. Four source files of LLVM that its emscripten
# package carries, fetched and unpacked by tools/setup wasm.
set(KONTUR_LLVM_RUNTIME "" CACHE PATH "Folder with libcxxabi and libunwind of LLVM")
set(abi ${KONTUR_LLVM_RUNTIME}/libcxxabi)
set(unwind ${KONTUR_LLVM_RUNTIME}/libunwind)
if(NOT EXISTS ${abi}/src/cxa_personality.cpp)
  message(FATAL_ERROR "KONTUR_LLVM_RUNTIME does not name a folder with libcxxabi and libunwind; wasm/build sets it")
endif()
file(WRITE ${CMAKE_CURRENT_BINARY_DIR}/no_threads/threads.h "")
file(WRITE ${CMAKE_CURRENT_BINARY_DIR}/no_threads/__threading_support "")
add_library(kontur_exceptions OBJECT ${abi}/src/cxa_exception.cpp ${abi}/src/cxa_personality.cpp
            ${abi}/src/cxa_exception_storage.cpp ${unwind}/src/Unwind-wasm.c exception_tag.s)
set_target_properties(kontur_exceptions PROPERTIES CXX_STANDARD 14 C_STANDARD 17)
target_include_directories(kontur_exceptions PRIVATE ${CMAKE_CURRENT_BINARY_DIR}/no_threads ${abi}/include ${abi}/src
                           ${unwind}/include ${unwind}/src)
target_compile_definitions(kontur_exceptions PRIVATE
  NDEBUG __USING_WASM_EXCEPTIONS__ _LIBCXXABI_HAS_NO_THREADS _LIBUNWIND_HAS_NO_THREADS
  # Names that libc++ has dropped since that version.
  _LIBCPP_INLINE_VISIBILITY= _LIBCPP_ENABLE_CXX17_REMOVED_UNEXPECTED_FUNCTIONS
  $<$<COMPILE_LANGUAGE:C>:__EMSCRIPTEN__;_LIBUNWIND_DISABLE_VISIBILITY_ANNOTATIONS;thread_local=>)
target_compile_options(kontur_exceptions PRIVATE -w -O2)
