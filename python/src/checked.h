// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

#include "casters.h"

// Functions that say which argument they cannot take, in a sentence. pybind11 lists the signature and all that was given,
// arrays with their numbers.

namespace kontur::python {

/// "ContourSet", "Optional[Plane]": as pybind11 calls what a parameter takes, without modules.
template <class Parameter>
std::string needed_text() {
    constexpr auto kText = py::detail::make_caster<Parameter>::name;
    const auto types = decltype(kText)::types();
    std::string text;
    std::size_t next = 0;
    for (const char* c = kText.text; *c != '\0'; ++c)
        if (*c == '%')
            text += py::handle(py::detail::get_type_handle(*types[next++], true)).attr("__name__").cast<std::string>();
        else text += *c;
    return text;
}

/// "an array of shape (10, 3)", "5", "a list": what was given, in few words.
std::string given_text(py::handle value);

[[noreturn]] void refuse_argument(const std::string& function, const std::string& parameter, const std::string& needed,
                                  py::handle given);

/// False for a value of another type. One of the right type that cannot be used throws Error, which names the parameter.
template <class Caster>
bool loads(Caster& caster, const std::string& parameter, py::handle value) {
    try {
        return caster.load(value, true);
    } catch (const MissingFile&) {
        throw;
    } catch (const Error& error) {
        throw error.with_context(parameter);
    }
}

/// Stands for a parameter until the function is called.
template <class Parameter>
struct Uncast {
    py::handle value;
};

template <class Parameter>
inline constexpr bool kIsRest =
    std::is_same_v<std::decay_t<Parameter>, py::kwargs> || std::is_same_v<std::decay_t<Parameter>, py::args>;

/// The rest of the arguments stays what it is; pybind11 knows it by its type.
template <class Parameter>
using UncastOrRest = std::conditional_t<kIsRest<Parameter>, Parameter, Uncast<Parameter>>;

/// One argument on its way into the function.
template <class Parameter>
class Argument {
public:
    Argument(const std::string& function, const std::string& parameter, const Uncast<Parameter>& given) {
        // None is null for all types of ours, of which there are no references.
        constexpr bool kIsObject =
            std::is_base_of_v<py::detail::type_caster_generic, Caster> && !std::is_pointer_v<Parameter>;
        if (!loads(caster_, parameter, given.value) || (kIsObject && given.value.is_none()))
            refuse_argument(function, parameter, needed_text<Parameter>(), given.value);
    }
    decltype(auto) pass() { return py::detail::cast_op<Parameter>(std::move(caster_)); }

private:
    using Caster = py::detail::make_caster<Parameter>;
    Caster caster_;
};

template <class Rest>
requires kIsRest<Rest>
class Argument<Rest> {
public:
    Argument(const std::string&, const std::string&, const std::decay_t<Rest>& rest) : rest_(rest) {}
    Rest pass() { return rest_; }

private:
    std::decay_t<Rest> rest_;
};

/// The function with arguments of which it tells by their names; those without one it counts.
template <class Function, class Result, class... Parameters>
auto checked(const std::string& name, const std::vector<std::string>& names, Function function, Result (*)(Parameters...)) {
    std::vector<std::string> parameters = names;
    while (parameters.size() < sizeof...(Parameters))
        parameters.push_back("argument " + std::to_string(parameters.size() + 1));
    return [name, parameters, function](UncastOrRest<Parameters>... given) -> Result {
        std::size_t n = 0;
        [[maybe_unused]] const auto next = [&]() -> const std::string& { return parameters[n++]; };
        std::tuple<Argument<Parameters>...> arguments{Argument<Parameters>(name, next(), given)...};
        return std::apply([&](auto&... each) -> Result { return function(each.pass()...); }, arguments);
    };
}

template <class Function>
auto checked(const std::string& name, const std::vector<std::string>& names, Function function) {
    using Signature = py::detail::function_signature_t<Function>;
    return checked(name, names, function, static_cast<Signature*>(nullptr));
}

template <class Class, class Result, class... Parameters>
auto checked(const std::string& name, const std::vector<std::string>& names, Result (Class::*method)(Parameters...) const) {
    return checked(name, names, [method](const Class& self, Parameters... given) -> Result {
        return (self.*method)(std::forward<Parameters>(given)...);
    });
}

template <class Class, class Result, class... Parameters>
auto checked(const std::string& name, const std::vector<std::string>& names, Result (Class::*method)(Parameters...)) {
    return checked(name, names, [method](Class& self, Parameters... given) -> Result {
        return (self.*method)(std::forward<Parameters>(given)...);
    });
}

}  // namespace kontur::python

namespace pybind11::detail {

template <class Parameter>
struct type_caster<kontur::python::Uncast<Parameter>> {
    PYBIND11_TYPE_CASTER(kontur::python::Uncast<Parameter>, make_caster<Parameter>::name);

    bool load(handle source, bool) {
        value = {source};
        return true;
    }
};

}  // namespace pybind11::detail
