#pragma once
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <vector>

#include "core/toml.h"
#include "core/vec.h"

namespace faba::python {
namespace py = pybind11;

/// JSON of None, bool, numbers (also of NumPy), text, lists, tuples, arrays and dictionaries. Throws
/// Error(usage) at `where` for other objects, and for nesting deeper than 64 levels.
Json json_of(py::handle value, const std::string& where);
/// The Python object of JSON: dict, list, str, int, float, bool, None.
py::object object_of(const Json& value);

/// A number of threads; 0: all. Throws Error(usage) for more than 1024.
unsigned checked_threads(unsigned threads);

/// A vector as an array of two numbers.
py::array_t<double> array_of(Vec2 v);
py::array_t<double> array_of(const std::vector<double>& v);
/// A vector from a sequence of two numbers. Throws Error(usage) at `where`.
Vec2 vector_of(py::handle value, const std::string& where);
/// Numbers from a sequence; NaN and infinity are errors. Throws Error(usage) at `where`.
std::vector<double> numbers_of(py::handle value, const std::string& where);

/// A read-only view of `size` elements that keeps `owner` alive.
template <class T>
py::array_t<T> view_of(const T* data, std::vector<py::ssize_t> shape, std::vector<py::ssize_t> strides,
                       py::handle owner) {
  py::array_t<T> a(std::move(shape), std::move(strides), data, owner);
  a.attr("setflags")(py::arg("write") = false);
  return a;
}

}  // namespace faba::python
