// SPDX-License-Identifier: Apache-2.0
#include "casters.h"

#include "checked.h"
#include "define.h"
#include "points.h"

namespace kontur::python {

std::string shape_text(const py::array& array) { return py::str(py::tuple(array.attr("shape"))).cast<std::string>(); }

std::string given_text(py::handle value) {
    constexpr std::size_t kLongest = 40;
    if (py::isinstance<py::array>(value)) return "an array of shape " + shape_text(py::reinterpret_borrow<py::array>(value));
    const auto text = py::repr(value).cast<std::string>();
    if (text.size() <= kLongest && text.find('\n') == std::string::npos) return text;
    return "an object of type " + py::type::of(value).attr("__name__").cast<std::string>();
}

void refuse_argument(const std::string& function, const std::string& parameter, const std::string& needed,
                     py::handle given) {
    throw py::type_error(function + "(): " + parameter + ": " + needed + " is needed, not " + given_text(given));
}

void check_numbers(const py::array& array, bool whole) {
    const std::string_view kinds = whole ? "biu" : "biufO";
    if (array.size() == 0 || kinds.find(array.dtype().kind()) != std::string_view::npos) return;
    throw Error(ErrorKind::invalid_input, "an array of type " + py::str(array.dtype()).cast<std::string>() + "; " +
                                              (whole ? "whole" : "real") + " numbers are needed");
}

namespace {

void refuse_masked(py::handle source, py::handle type) {
    if (PyList_Check(source.ptr()) || PyTuple_Check(source.ptr())) {
        for (const py::handle item : source) refuse_masked(item, type);
        return;
    }
    if (!py::isinstance(source, type)) return;
    const auto count = py::module_::import("numpy.ma").attr("count_masked")(source).cast<std::size_t>();
    if (count > 0)
        throw Error(ErrorKind::invalid_input,
                    py::str("an array is masked at {} of its {} entries; give these a value first (`array.filled(...)`)")
                        .format(count, source.attr("size"))
                        .cast<std::string>());
}

}  // namespace

void refuse_masked(py::handle source) {
    // Who has not imported it has no masked arrays.
    const py::dict modules = py::module_::import("sys").attr("modules");
    if (modules.contains("numpy.ma")) refuse_masked(source, modules["numpy.ma"].attr("MaskedArray"));
}

py::array array_from(py::handle source) {
    refuse_masked(source);
    return py::array::ensure(source);
}

MissingFile::MissingFile(const std::filesystem::path& path)
    : Error(ErrorKind::io, "cannot read " + path.string() + ": " + std::generic_category().message(ENOENT)) {}

std::span<const Vec3> points_of(const ArrayOf<double>& array) {
    if (array.size() == 0) return {};
    if (array.ndim() != 2 || array.shape(1) != 3)
        throw Error(ErrorKind::invalid_input,
                    "an array of points has the shape " + shape_text(array) + "; (n, 3) is needed");
    return {reinterpret_cast<const Vec3*>(array.data()), static_cast<std::size_t>(array.shape(0))};
}

std::vector<py::ssize_t> leading_shape(const py::array& points) {
    if (points.ndim() < 1 || points.shape(points.ndim() - 1) != 3)
        throw Error(ErrorKind::invalid_input,
                    "an array of points has the shape " + shape_text(points) + "; (..., 3) is needed");
    return {points.shape(), points.shape() + points.ndim() - 1};
}

std::vector<double> list_of(const ArrayOf<double>& numbers, const char* what) {
    if (numbers.size() > 0 && numbers.ndim() != 1)
        throw Error(ErrorKind::invalid_input,
                    std::string("an array of ") + what + " has the shape " + shape_text(numbers) + "; (n,) is needed");
    return {numbers.data(), numbers.data() + numbers.size()};
}

std::string filled_in(std::string help, const std::string& options) {
    const std::pair<std::string_view, std::string_view> marks[] = {
        {"@options\n", options},
        {"@threads\n", R"(threads : int
    0: the machine's. The result does not depend on it.
)"},
        {"@progress\n", R"(progress, stop : optional
    As for `segment`.
)"},
        {"@on_note\n", R"(on_note : callable, optional
    Called with each sentence on what the reader decided for you or doubts; when left out they are warnings of the logger 'kontur'.
)"},
        {"@provenance\n", R"(provenance : dict of str to str, optional
    How it was made, for the file's text, such as what `provenance` gives; in DICOM the description of kontur's contribution.
)"},
    };
    for (const auto& [mark, text] : marks)
        if (const std::size_t at = help.find(mark); at != std::string::npos) help.replace(at, mark.size(), text);
    return help;
}

}  // namespace kontur::python
