// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <functional>
#include <type_traits>

#include "casters.h"
#include "checked.h"

// Functions and their docstrings. A docstring starts with "name(parameters)\n--\n\n", from which inspect.signature and
// help() read the signature, as for the built-in functions of CPython.

namespace kontur::python {

template <class Value>
std::string type_text() {
    if constexpr (std::is_same_v<Value, bool>) return "bool";
    else if constexpr (std::is_enum_v<Value>) return choices<Value>();
    else if constexpr (std::is_integral_v<Value>) return "int";
    else if constexpr (std::is_floating_point_v<Value>) return "float";
    else if constexpr (std::is_same_v<Value, std::string>) return "str";
    else if constexpr (std::is_same_v<Value, std::array<double, 3>>) return "sequence of 3 float";
    else if constexpr (std::is_same_v<Value, Ball3>) return "(array_like, float)";
    else if constexpr (std::is_same_v<Value, Grid>) return "Grid";
    else if constexpr (requires(Value value) { value.size(); })
        return "sequence of " + type_text<typename Value::value_type>();
    else return type_text<typename Value::value_type>() + " or None";
}

/// An options struct as keyword arguments: the C++ struct holds the defaults, this table the words.
template <class Options>
class Keywords {
public:
    /// `member` leads from the struct to the value: a pointer to a member, or a function for a nested one.
    template <class Member>
    Keywords& field(const char* name, Member member, const char* help) {
        using Value = std::remove_cvref_t<std::invoke_result_t<Member, Options&>>;
        const auto set = [name, member](Options& options, py::handle value) {
            py::detail::make_caster<Value> caster;
            if (!loads(caster, name, value))
                throw py::type_error(std::string(name) + ": " + type_text<Value>() + " is needed, not " +
                                     py::repr(value).cast<std::string>());
            std::invoke(member, options) = py::detail::cast_op<Value&>(caster);
        };
        Options defaults;
        const std::string fallback = py::repr(py::cast(Value(std::invoke(member, defaults)))).template cast<std::string>();
        fields_.push_back(
            {name, set, fallback,
             std::string(name) + " : " + type_text<Value>() + ", default " + fallback + "\n    " + help + "\n"});
        return *this;
    }

    /// Throws TypeError for a word that is none of the fields.
    Options parse(const char* function, const py::kwargs& given) const {
        Options options;
        for (const auto& [key, value] : given) set(function, options, key.template cast<std::string>(), value);
        return options;
    }

    std::string parameters() const {
        std::string text;
        for (const Field& field : fields_) text += ", " + field.name + "=" + field.fallback;
        return text;
    }

    std::string documentation() const {
        std::string text;
        for (const Field& field : fields_) text += field.help;
        return text;
    }

private:
    struct Field {
        std::string name;
        std::function<void(Options&, py::handle)> set;
        std::string fallback;
        std::string help;
    };

    void set(const char* function, Options& options, const std::string& key, py::handle value) const {
        for (const Field& field : fields_)
            if (field.name == key) return field.set(options, value);
        throw py::type_error(std::string(function) + "() got an unexpected keyword argument '" + key + "'");
    }

    std::vector<Field> fields_;
};

/// Stands among the arguments of `define`: the function takes these keywords as its last parameter, py::kwargs.
struct KeywordText {
    std::string parameters, documentation;

    template <class Options>
    KeywordText(const Keywords<Options>& keywords)
        : parameters(keywords.parameters()), documentation(keywords.documentation()) {}
};

inline void append(std::string& text, const py::arg& argument) { text += std::string(", ") + argument.name; }
inline void append(std::string& text, const py::arg_v& argument) {
    text += std::string(", ") + argument.name + "=" + py::repr(argument.value).cast<std::string>();
}
inline void append(std::string& text, const py::kw_only&) { text += ", *"; }
inline void append(std::string& text, const KeywordText& keywords) { text += keywords.parameters; }
template <class Other>
void append(std::string&, const Other&) {}

/// `help` with the keywords' part in place of its line "@options", and what many functions say in place of the lines
/// "@threads", "@progress", "@on_note" and "@provenance".
std::string filled_in(std::string help, const std::string& options);

template <class... Extra>
std::string docstring(const std::string& name, const std::string& first, const std::string& help, const Extra&... extra) {
    std::string parameters = first.empty() ? "" : ", " + first, options;
    (append(parameters, extra), ...);
    (
        [&](const auto& item) {
            if constexpr (std::is_same_v<std::decay_t<decltype(item)>, KeywordText>) options += item.documentation;
        }(extra),
        ...);
    return name + "(" + parameters.substr(std::min<std::size_t>(2, parameters.size())) + ")\n--\n\n" +
           filled_in(help, options);
}

/// Of the extras, those that are pybind11's.
template <class Extra>
auto pybind_extra(const Extra& extra) {
    if constexpr (std::is_same_v<Extra, KeywordText>) return std::tuple<>();
    else return std::tuple<Extra>(extra);
}

/// With a default or without.
template <class Extra>
void append_name(std::vector<std::string>& names, const Extra& extra) {
    if constexpr (std::is_base_of_v<py::arg, Extra>) names.emplace_back(extra.name);
}

template <class... Extra>
std::vector<std::string> parameter_names(std::vector<std::string> names, const Extra&... extra) {
    (append_name(names, extra), ...);
    return names;
}

/// Adds a function to the module.
template <class Function, class... Extra>
void define(py::module_& module, const char* name, const char* help, Function function, const Extra&... extra) {
    const std::string doc = docstring(name, "", help, extra...);
    const auto its = checked(name, parameter_names({}, extra...), function);
    std::apply([&](const auto&... rest) { module.def(name, its, rest..., doc.c_str()); },
               std::tuple_cat(pybind_extra(extra)...));
}

/// Adds a method to a class.
template <class Class, class Function, class... Extra>
void method(Class& type, const char* name, const char* help, Function function, const Extra&... extra) {
    const std::string doc = docstring(name, "self", help, extra...);
    const auto its = checked(name, parameter_names({"self"}, extra...), function);
    std::apply([&](const auto&... rest) { type.def(name, its, rest..., doc.c_str()); },
               std::tuple_cat(pybind_extra(extra)...));
}

/// Adds a constructor that a function stands for.
template <class Class, class Factory, class... Extra>
void constructor(Class& type, Factory factory, const Extra&... extra) {
    const std::string doc = docstring("__init__", "self", "", extra...);
    const auto name = py::type::of<typename Class::type>().attr("__name__").template cast<std::string>();
    type.def(py::init(checked(name, parameter_names({}, extra...), factory)), extra..., doc.c_str());
}

}  // namespace kontur::python
