// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "define.h"
#include "run.h"

// One function for each source: it adds its part of the library to the module, or to its submodule of stages. Types come
// before what uses them.

namespace kontur::python {

void bind_planes(py::module_& m);
void bind_contours(py::module_& m);
void bind_grids(py::module_& m);
void bind_volumes(py::module_& m);
void bind_meshes(py::module_& m);
void bind_functions(py::module_& m, py::module_& stages);
void bind_fast_functions(py::module_& stages);
void bind_fitting(py::module_& stages);
void bind_constraints(py::module_& stages);
void bind_extraction(py::module_& m, py::module_& stages);
void bind_segment(py::module_& m);
void bind_moving(py::module_& m);
void bind_together(py::module_& m);
void bind_shared_surfaces(py::module_& m);
void bind_uncertainty_types(py::module_& m);
void bind_uncertainty(py::module_& m);
void bind_crossings(py::module_& m, py::module_& stages);
void bind_curves(py::module_& m, py::module_& stages);
void bind_labels(py::module_& m);
void bind_editor(py::module_& m);
void bind_corrections(py::module_& m);
void bind_derivation(py::module_& m);
void bind_measures(py::module_& m);
void bind_findings(py::module_& m);
void bind_section_checks(py::module_& m);
void bind_pictures(py::module_& m);
void bind_livewire(py::module_& stages);
void bind_files(py::module_& m);
void bind_images(py::module_& m);
void bind_attributes(py::module_& m);
void bind_dicom(py::module_& m);
void bind_segmentations(py::module_& m);
void bind_phantom(py::module_& m, py::module_& stages);

/// Shape (z, y, x) of an array over the grid.
inline std::vector<py::ssize_t> array_shape(const Grid& grid) { return {grid.size.k, grid.size.j, grid.size.i}; }

/// For pickle and copy: `arguments` gives what the constructor needs to make an equal object.
template <class Class, class Arguments>
void picklable(Class& type, Arguments arguments) {
    using Value = typename Class::type;
    type.def("__reduce__", [arguments](const py::object& self) {
        return py::make_tuple(py::type::of(self), arguments(self.cast<const Value&>()));
    });
}

/// Arguments that most long functions end with.
inline const py::arg_v kThreads = py::arg("threads") = 0;
inline const py::arg_v kProgress = py::arg("progress") = py::none();
inline const py::arg_v kStop = py::arg("stop") = py::none();

}  // namespace kontur::python
