// SPDX-License-Identifier: Apache-2.0
#include <new>
#include <stdexcept>

#include "archive.h"

namespace kontur::python {
namespace {

void raise(const py::object& exception) { PyErr_SetObject(py::type::of(exception).ptr(), exception.ptr()); }

/// Raises the class of kontur.errors that the error's kind names.
void raise(const Error& error) {
    raise(py::module_::import("kontur.errors").attr("from_kind")(std::string(name(error.kind())), error.what()));
}

/// The names of all kinds, which the classes of kontur.errors must match.
std::vector<std::string> error_kinds() {
    std::vector<std::string> names;
    for (const ErrorKind kind : {ErrorKind::invalid_input, ErrorKind::unsupported, ErrorKind::corrupt_file, ErrorKind::io,
                                 ErrorKind::singular_system, ErrorKind::too_large, ErrorKind::cancelled})
        names.emplace_back(name(kind));
    return names;
}

}  // namespace
}  // namespace kontur::python

PYBIND11_MODULE(_core, m) {
    using namespace kontur::python;
    py::options options;
    options.disable_function_signatures();
    py::register_exception_translator([](std::exception_ptr pointer) {
        try {
            if (pointer) std::rethrow_exception(pointer);
        } catch (const MissingFile& error) {
            raise(py::module_::import("kontur.errors").attr("MissingFileError")(error.what()));
        } catch (const kontur::Error& error) {
            raise(error);
        } catch (const std::bad_alloc&) {
            raise({kontur::ErrorKind::too_large, "there is not enough memory for what this asks for"});
        } catch (const std::length_error&) {
            raise({kontur::ErrorKind::too_large, "this asks for more memory than any machine has"});
        }
    });
    m.attr("__version__") = KONTUR_VERSION;
    py::module_ stages = m.def_submodule("_stages");
    py::module_ archive = m.def_submodule("_archive");
    m.def("_error_kinds", &kontur::python::error_kinds);
    bind_grids(m);
    bind_planes(m);
    bind_attributes(m);
    bind_contours(m);
    bind_crossings(m, stages);
    bind_curves(m, stages);
    bind_volumes(m);
    bind_meshes(m);
    bind_functions(m, stages);
    bind_fast_functions(stages);
    bind_constraints(stages);
    bind_fitting(stages);
    bind_extraction(m, stages);
    bind_uncertainty_types(m);
    bind_section_checks(m);
    bind_segment(m);
    bind_moving(m);
    bind_together(m);
    bind_shared_surfaces(m);
    bind_labels(m);
    bind_uncertainty(m);
    bind_editor(m);
    bind_corrections(m);
    bind_derivation(m);
    bind_measures(m);
    bind_findings(m);
    bind_pictures(m);
    bind_livewire(stages);
    bind_files(m);
    bind_images(m);
    bind_dicom(m);
    bind_segmentations(m);
    bind_archive(archive);
    bind_phantom(m, stages);
}
