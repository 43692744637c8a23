#include "python/convert.h"

#include <fmt/format.h>

#include <cmath>

#include "core/error.h"

namespace faba::python {
namespace {

constexpr int kDepth = 64;  // as parse_json()
constexpr py::ssize_t kMostOfRange = 10'000'000;

std::string type_name(py::handle value) { return py::str(py::type::of(value).attr("__name__")); }

Json integer_of(py::handle value, const std::string& where) {
  int overflow = 0;
  const long long signed_value = PyLong_AsLongLongAndOverflow(value.ptr(), &overflow);
  if (overflow == 0) return signed_value;
  if (overflow > 0) {
    const unsigned long long large = PyLong_AsUnsignedLongLong(value.ptr());
    if (!PyErr_Occurred()) return large;
    PyErr_Clear();
  }
  throw Error(Errc::usage, where, "the integer has more than 64 bits");
}

Json json_at(py::handle value, const std::string& where, int depth) {
  if (depth > kDepth) throw Error(Errc::usage, where, fmt::format("is nested deeper than {} levels", kDepth));
  if (value.is_none()) return Json();
  if (py::isinstance<py::bool_>(value)) return value.cast<bool>();
  if (py::isinstance<py::int_>(value)) return integer_of(value, where);
  if (py::isinstance<py::float_>(value)) return value.cast<double>();
  if (py::isinstance<py::str>(value)) return value.cast<std::string>();
  if (py::isinstance<py::dict>(value)) {
    Json j = Json::object();
    for (const auto& [k, v] : py::reinterpret_borrow<py::dict>(value)) {
      const auto key = py::str(k).cast<std::string>();
      j[key] = json_at(v, where.empty() ? key : fmt::format("{}.{}", where, key), depth + 1);
    }
    return j;
  }
  if (PyRange_Check(value.ptr())) {
    const py::ssize_t length = PyObject_Length(value.ptr());
    if (length < 0) throw py::error_already_set();  // more than 64 bits
    if (length > kMostOfRange)
      throw Error(Errc::usage, where, fmt::format("is a range of more than {} numbers", kMostOfRange));
  }
  if (py::isinstance<py::list>(value) || py::isinstance<py::tuple>(value) || PyRange_Check(value.ptr())) {
    Json j = Json::array();
    for (const auto v : value) j.push_back(json_at(v, where, depth + 1));
    return j;
  }
  if (py::hasattr(value, "tolist")) return json_at(value.attr("tolist")(), where, depth + 1);  // NumPy
  if (py::hasattr(value, "__fspath__")) return value.attr("__fspath__")().cast<std::string>();
  throw Error(Errc::usage, where,
              fmt::format("has the type {}; give a number, text, a list or a dictionary", type_name(value)));
}

}  // namespace

Json json_of(py::handle value, const std::string& where) { return json_at(value, where, 0); }

py::object object_of(const Json& value) {
  switch (value.type()) {
    case Json::value_t::boolean:
      return py::bool_(value.get<bool>());
    case Json::value_t::number_integer:
      return py::int_(value.get<long long>());
    case Json::value_t::number_unsigned:
      return py::int_(value.get<unsigned long long>());
    case Json::value_t::number_float:
      return py::float_(value.get<double>());
    case Json::value_t::string:
      return py::str(value.get<std::string>());
    case Json::value_t::array: {
      py::list list;
      for (const Json& v : value) list.append(object_of(v));
      return list;
    }
    case Json::value_t::object: {
      py::dict dict;
      for (const auto& [k, v] : value.items()) dict[py::str(k)] = object_of(v);
      return dict;
    }
    default:
      return py::none();
  }
}

unsigned checked_threads(unsigned threads) {
  constexpr unsigned kMost = 1024;  // as on the command line
  if (threads <= kMost) return threads;
  throw Error(Errc::usage, "threads", fmt::format("{} is not between 0 (all) and {}", threads, kMost));
}

py::array_t<double> array_of(Vec2 v) {
  py::array_t<double> a(2);
  a.mutable_at(0) = v.x;
  a.mutable_at(1) = v.y;
  return a;
}

py::array_t<double> array_of(const std::vector<double>& v) {
  return py::array_t<double>(py::ssize_t(v.size()), v.data());
}

std::vector<double> numbers_of(py::handle value, const std::string& where) {
  using Array = py::array_t<double, py::array::c_style | py::array::forcecast>;
  if (py::isinstance<py::str>(value) || value.is_none())
    throw Error(Errc::usage, where, fmt::format("has the type {}; give numbers", type_name(value)));
  const Array a = Array::ensure(py::reinterpret_borrow<py::object>(value));
  if (!a) {
    PyErr_Clear();
    throw Error(Errc::usage, where, fmt::format("has the type {}; give numbers", type_name(value)));
  }
  if (a.ndim() != 1)
    throw Error(Errc::usage, where, fmt::format("has {} dimensions; give a sequence of numbers", a.ndim()));
  std::vector<double> v(a.data(), a.data() + a.size());
  for (std::size_t i = 0; i < v.size(); ++i)
    if (!std::isfinite(v[i]))
      throw Error(Errc::usage, where, fmt::format("number {} is {}; give finite numbers", i, v[i]));
  return v;
}

Vec2 vector_of(py::handle value, const std::string& where) {
  const std::vector<double> v = numbers_of(value, where);
  if (v.size() != 2)
    throw Error(Errc::usage, where, fmt::format("has {} numbers; give two, x and y", v.size()));
  return {v[0], v[1]};
}

}  // namespace faba::python
