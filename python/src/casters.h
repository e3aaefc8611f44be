// SPDX-License-Identifier: Apache-2.0
#pragma once

// How values cross between C++ and Python. Every source of the bindings includes this file, because a conversion must be
// the same in all of them.

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <filesystem>
#include <limits>
#include <string>
#include <type_traits>
#include <vector>

#include "kontur/base/error.h"
#include "kontur/base/smallest_ball.h"
#include "kontur/extract/track.h"
#include "kontur/extract/voxelize.h"
#include "kontur/fit/constraints.h"
#include "kontur/fit/fit.h"
#include "kontur/io/dicom/rtstruct.h"
#include "kontur/io/images/read_image_options.h"
#include "kontur/shape/contour.h"
#include "kontur/shape/grid.h"

namespace kontur::python {

namespace py = pybind11;

/// C-ordered array of these numbers. As an argument it takes other arrays and sequences too, see `numbers_of`.
template <class Value>
using ArrayOf = py::array_t<Value, py::array::c_style | py::array::forcecast>;

static_assert(sizeof(Vec3) == 3 * sizeof(double) && sizeof(std::array<std::uint32_t, 3>) == 3 * sizeof(std::uint32_t));

/// Nothing is at a path that was to be read: MissingFileError in Python.
class MissingFile : public Error {
public:
    explicit MissingFile(const std::filesystem::path& path);
};

/// A file or folder to be read. As an argument it throws MissingFile where there is none.
struct ExistingPath : std::filesystem::path {
    using path::path;
};

/// "(4, 3)"
std::string shape_text(const py::array& array);

/// An array or a sequence as an array; null for what NumPy makes no array of. Throws Error(invalid_input) for one with
/// masked entries (numpy.ma), whose mask would be lost.
py::array array_from(py::handle source);

/// Throws Error(invalid_input) unless the array holds real numbers or booleans, whole ones where `whole`. Without elements
/// anything goes.
void check_numbers(const py::array& array, bool whole);

/// Throws Error(invalid_input) for a whole number that Value does not have.
template <class Value>
void check_range(const py::array& array) {
    const py::int_ least(std::numeric_limits<Value>::min()), most(std::numeric_limits<Value>::max());
    for (const char* extreme : {"min", "max"})
        if (const py::int_ value(array.attr(extreme)()); value < least || value > most)
            throw Error(ErrorKind::invalid_input, py::str("an array has the value {}; {} to {} are possible")
                                                      .format(value, least, most)
                                                      .template cast<std::string>());
}

/// An array or a sequence as an array of these numbers; null for what NumPy makes no array of.
template <class Value>
ArrayOf<Value> numbers_of(py::handle source) {
    const py::array array = array_from(source);
    if (!array) return py::reinterpret_steal<ArrayOf<Value>>(py::handle());
    constexpr bool kWhole = std::is_integral_v<Value>;
    check_numbers(array, kWhole);
    if constexpr (kWhole)
        if (array.size() > 0 && !py::isinstance<py::array_t<Value>>(array)) check_range<Value>(array);
    return ArrayOf<Value>::ensure(array);
}

/// The rows of an (n, 3) array, or of an empty one. Throws Error(invalid_input) for another shape.
std::span<const Vec3> points_of(const ArrayOf<double>& array);

/// An array of the given shape that owns the vector's memory.
template <class Element, class Value = Element>
py::array_t<Value> owning_array(std::vector<Element>&& values, std::vector<py::ssize_t> shape) {
    auto* owned = new std::vector<Element>(std::move(values));
    const py::capsule owner(owned, [](void* memory) { delete static_cast<std::vector<Element>*>(memory); });
    return py::array_t<Value>(std::move(shape), reinterpret_cast<const Value*>(owned->data()), owner);
}

/// An array on memory that belongs to `owner`, which it keeps alive.
template <class Value>
py::array_t<Value> array_view(const Value* values, std::vector<py::ssize_t> shape, py::handle owner) {
    return py::array_t<Value>(std::move(shape), values, owner);
}

/// The same without the right to write.
template <class Array>
Array read_only(Array array) {
    array.attr("flags").attr("writeable") = false;
    return array;
}

/// The `values` of an enumeration that are words in Python: those that the command line has for them.
template <class Enum>
struct Words;

template <class Enum>
concept HasWords = requires {
    Words<Enum>::values;
};

template <>
struct Words<Kernel> {
    static constexpr std::array values{Kernel::screened, Kernel::triharmonic, Kernel::biharmonic};
};
template <>
struct Words<Normals> {
    static constexpr std::array values{Normals::surface, Normals::in_plane};
};
template <>
struct Words<Solver> {
    static constexpr std::array values{Solver::automatic, Solver::iterative, Solver::cholesky, Solver::dense};
};
template <>
struct Words<Voxelizer> {
    static constexpr std::array values{Voxelizer::adaptive, Voxelizer::tracked, Voxelizer::exhaustive};
};

template <>
struct Words<ContourEnd> {
    static constexpr std::array values{ContourEnd::automatic, ContourEnd::flat, ContourEnd::round};
};
template <>
struct Words<Hand> {
    static constexpr std::array values{Hand::left, Hand::right};
};

inline std::string_view name(HoleEncoding holes) {
    constexpr std::array<std::string_view, 3> kNames{"keyhole", "xor", "nested"};
    return kNames[static_cast<std::size_t>(holes)];
}
template <>
struct Words<HoleEncoding> {
    static constexpr std::array values{HoleEncoding::keyhole, HoleEncoding::exclusive, HoleEncoding::nested};
};

inline std::string_view name(NiftiTransform transform) { return transform == NiftiTransform::qform ? "qform" : "sform"; }
template <>
struct Words<NiftiTransform> {
    static constexpr std::array values{NiftiTransform::qform, NiftiTransform::sform};
};

template <class Enum>
std::string word_of(Enum value) {
    return std::string(name(value));
}

/// {'screened', 'triharmonic', 'biharmonic'}
template <class Enum>
std::string choices() {
    std::string text;
    for (const Enum value : Words<Enum>::values) text += (text.empty() ? "'" : ", '") + word_of(value) + "'";
    return "{" + text + "}";
}

}  // namespace kontur::python

namespace pybind11::detail {

// Its vector of unique pointers only looks as if it could be copied.
template <>
struct is_copy_constructible<kontur::SurfaceLattice> : std::false_type {};

template <kontur::python::HasWords Enum>
struct type_caster<Enum> {
    PYBIND11_TYPE_CASTER(Enum, const_name("str"));

    bool load(handle source, bool) {
        if (!isinstance<str>(source)) return false;
        const std::string word = source.cast<std::string>();
        for (const Enum candidate : kontur::python::Words<Enum>::values) {
            if (kontur::python::word_of(candidate) != word) continue;
            value = candidate;
            return true;
        }
        throw kontur::Error(kontur::ErrorKind::invalid_input,
                            "'" + word + "' is none of " + kontur::python::choices<Enum>());
    }
    static handle cast(Enum source, return_value_policy, handle) { return str(kontur::python::word_of(source)).release(); }
};

template <>
struct type_caster<kontur::python::ExistingPath> {
    PYBIND11_TYPE_CASTER(kontur::python::ExistingPath, make_caster<std::filesystem::path>::name);

    bool load(handle source, bool convert) {
        make_caster<std::filesystem::path> path;
        if (!path.load(source, convert)) return false;
        value = {cast_op<std::filesystem::path&>(path)};
        std::error_code failure;
        if (std::filesystem::status(value, failure).type() == std::filesystem::file_type::not_found)
            throw kontur::python::MissingFile(value);
        return true;
    }
};

template <class Value>
struct pyobject_caster<kontur::python::ArrayOf<Value>> {
    using type = kontur::python::ArrayOf<Value>;

    bool load(handle source, bool convert) {
        if (!convert && !type::check_(source)) return false;
        value = kontur::python::numbers_of<Value>(source);
        return static_cast<bool>(value);
    }
    static handle cast(const handle& source, return_value_policy, handle) { return source.inc_ref(); }
    PYBIND11_TYPE_CASTER(type, handle_type_name<type>::name);
};

/// Three numbers; an array of float64, shape (3,), in Python.
template <>
struct type_caster<kontur::Vec3> {
    PYBIND11_TYPE_CASTER(kontur::Vec3, const_name("numpy.ndarray"));

    bool load(handle source, bool) {
        const auto array = kontur::python::numbers_of<double>(source);
        if (!array) return false;
        if (array.ndim() != 1 || array.size() != 3)
            throw kontur::Error(kontur::ErrorKind::invalid_input,
                                "an array has the shape " + kontur::python::shape_text(array) + "; (3,) is needed");
        value = {array.at(0), array.at(1), array.at(2)};
        return true;
    }
    static handle cast(const kontur::Vec3& v, return_value_policy, handle) { return array_t<double>(3, &v.x).release(); }
};

/// Rows of three numbers; an array of float64, shape (n, 3), in Python.
template <>
struct type_caster<std::vector<kontur::Vec3>> {
    PYBIND11_TYPE_CASTER(std::vector<kontur::Vec3>, const_name("numpy.ndarray"));

    bool load(handle source, bool) {
        const auto array = kontur::python::numbers_of<double>(source);
        if (!array) return false;
        const auto points = kontur::python::points_of(array);
        value.assign(points.begin(), points.end());
        return true;
    }
    template <class Points>
    static handle cast(Points&& points, return_value_policy, handle) {
        const auto count = static_cast<ssize_t>(points.size());
        return kontur::python::owning_array<kontur::Vec3, double>(std::vector<kontur::Vec3>(std::forward<Points>(points)),
                                                                  {count, 3})
            .release();
    }
};

/// (i, j, k)
template <>
struct type_caster<kontur::Index3> {
    PYBIND11_TYPE_CASTER(kontur::Index3, const_name("tuple[int, int, int]"));

    bool load(handle source, bool convert) {
        make_caster<std::array<std::int64_t, 3>> numbers;
        if (!numbers.load(source, convert)) return false;
        const auto& n = cast_op<std::array<std::int64_t, 3>&>(numbers);
        value = {n[0], n[1], n[2]};
        return true;
    }
    static handle cast(const kontur::Index3& n, return_value_policy, handle) { return make_tuple(n.i, n.j, n.k).release(); }
};

/// (centre, radius)
template <>
struct type_caster<kontur::Ball3> {
    PYBIND11_TYPE_CASTER(kontur::Ball3, const_name("tuple[numpy.ndarray, float]"));

    bool load(handle source, bool convert) {
        make_caster<std::pair<kontur::Vec3, double>> parts;
        if (!parts.load(source, convert)) return false;
        const auto& [center, radius] = cast_op<std::pair<kontur::Vec3, double>>(parts);
        value = {center, radius};
        return true;
    }
    static handle cast(const kontur::Ball3& ball, return_value_policy, handle) {
        return make_tuple(object(pybind11::cast(ball.center)), ball.radius).release();
    }
};

/// The corners of smallest and largest coordinates; an array of float64, shape (2, 3), in Python.
template <>
struct type_caster<kontur::Box3> {
    PYBIND11_TYPE_CASTER(kontur::Box3, const_name("numpy.ndarray"));

    bool load(handle source, bool convert) {
        make_caster<std::vector<kontur::Vec3>> corners;
        if (!corners.load(source, convert)) return false;
        const auto& c = cast_op<std::vector<kontur::Vec3>&>(corners);
        if (c.size() != 2)
            throw kontur::Error(kontur::ErrorKind::invalid_input,
                                "a box has " + std::to_string(c.size()) + " corners; the lowest and the highest are needed");
        value = {c[0], c[1]};
        return true;
    }
    static handle cast(const kontur::Box3& box, return_value_policy policy, handle parent) {
        return make_caster<std::vector<kontur::Vec3>>::cast(std::vector{box.min, box.max}, policy, parent);
    }
};

}  // namespace pybind11::detail
