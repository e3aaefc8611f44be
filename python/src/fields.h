// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "casters.h"

namespace kontur::python {

/// The fields of a struct in Python: attributes for reading, and what its pickles and copies hold.
template <class Type>
class Fields {
public:
    explicit Fields(py::class_<Type>& type) : type_(type) {}

    template <class Value>
    Fields& field(const char* name, Value Type::*member, const char* help) {
        type_.def_readonly(name, member, help);
        return stored(name, member);
    }

    /// A field that is an attribute in another form, or none.
    template <class Value>
    Fields& stored(const char* name, Value Type::*member) {
        parts_.push_back({name, [member](const Type& value) -> py::object { return py::cast(value.*member); },
                          [member](Type& value, py::handle part) { value.*member = part.cast<Value>(); }});
        return *this;
    }

    /// Call once, last. A pickle names its fields: one of another version keeps those that both have.
    void picklable() const {
        type_.def(py::pickle([parts = parts_](const Type& value) { return state_of(parts, value); },
                             [parts = parts_](const py::dict& state) { return value_of(parts, state); }));
    }

private:
    struct Part {
        std::string name;
        std::function<py::object(const Type&)> get;
        std::function<void(Type&, py::handle)> set;
    };

    static py::dict state_of(const std::vector<Part>& parts, const Type& value) {
        py::dict state;
        for (const Part& part : parts) state[py::str(part.name)] = part.get(value);
        return state;
    }

    static Type value_of(const std::vector<Part>& parts, const py::dict& state) {
        Type value;
        for (const Part& part : parts)
            if (state.contains(part.name)) part.set(value, state[py::str(part.name)]);
        return value;
    }

    py::class_<Type>& type_;
    std::vector<Part> parts_;
};

}  // namespace kontur::python
