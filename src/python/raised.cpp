#include "python/raised.h"

#include <array>
#include <regex>
#include <utility>

#include "core/monotonic.h"
#include "core/process/installation.h"

namespace faba::python {
namespace {

constexpr double kAskEvery = 0.05;  // s, between two questions for Ctrl-C

/// The class faba.Error; lives as long as the interpreter.
PyObject* error_class = nullptr;

/// Options of the command line in messages, and the arguments in Python.
constexpr std::array<std::pair<const char*, const char*>, 9> kOptions = {{{"--set", "set"},
                                                                          {"--seed", "seed"},
                                                                          {"--duration", "duration"},
                                                                          {"--threads", "threads"},
                                                                          {"--out", "out"},
                                                                          {"--force", "force=True"},
                                                                          {"--as-seen", "as_seen=True"},
                                                                          {"--arm", "arm=True"},
                                                                          {"--method", "method"}}};

// The text with the options of the command line replaced; commands in backticks are kept.
std::string with_arguments(const std::string& text) {
  static const std::regex option("`[^`]*`|--[a-z][a-z-]*");
  std::string result;
  auto from = text.begin();
  for (std::sregex_iterator it(text.begin(), text.end(), option), end; it != end; ++it) {
    std::string word = it->str();
    for (const auto& [name, argument] : kOptions)
      if (word == name) word = argument;
    result.append(from, (*it)[0].first).append(word);
    from = (*it)[0].second;
  }
  return result.append(from, text.end());
}

void raise(const Error& e) {
  const std::string where = with_arguments(e.where()), reason = with_arguments(e.reason());
  const py::object error =
      py::reinterpret_borrow<py::object>(error_class)(where.empty() ? reason : where + ": " + reason);
  error.attr("code") = int(e.code());
  error.attr("where") = where;
  error.attr("what") = reason;
  PyErr_SetObject(error_class, error.ptr());
}

}  // namespace

Error Raised::keep(const std::string& where, const py::error_already_set& e) {
  if (!first_) first_ = e;
  raised_ = true;
  const auto type = py::str(e.type().attr("__name__")).cast<std::string>();
  const bool interrupt = e.matches(PyExc_KeyboardInterrupt);
  return {interrupt ? Errc::interrupted : Errc::usage, where,
          type + ": " + py::str(e.value()).cast<std::string>()};
}

bool Raised::stopped() {
  if (raised_) return true;
  const double now = monotonic_now();
  if (now - asked_ < kAskEvery) return false;
  asked_ = now;
  const py::gil_scoped_acquire gil;
  if (PyErr_CheckSignals() == 0) return false;
  (void)keep("", py::error_already_set());
  return true;
}

void Raised::rethrow(const std::string& note) {
  if (!first_) return;
  py::error_already_set e = *first_;
  first_.reset();
  raised_ = false;
  if (!note.empty()) e.value().attr("add_note")(note);
  throw py::error_already_set(e);  // NOLINT(cert-err60-cpp): copies share the Python object
}

void bind_error(py::module_& m) {
  error_class = PyErr_NewExceptionWithDoc(
      "faba.Error",
      "An error of Faba.\n\n"
      "code : int\n    The exit code of the program for this error: 2 wrong use, 3 unsuitable input, 4 "
      "device,\n"
      "    11 the directory is in use, 130 interrupted, 1 anything else.\n"
      "where : str\n    The place in your terms: a key of the scenario, an option, a file, a device.\n"
      "what : str\n    The reason, the permitted values and an advice.",
      PyExc_RuntimeError, nullptr);
  if (!error_class) throw py::error_already_set();
  m.add_object("Error", error_class);
  // pybind11 prescribes the type of the parameter.
  // NOLINTNEXTLINE(performance-unnecessary-value-param)
  py::register_exception_translator([](std::exception_ptr p) {
    try {
      if (p) std::rethrow_exception(p);
    } catch (const Error& e) {
      raise({e.code(), e.where(), e.reason() + example_advice(e)});
    }
  });
}

}  // namespace faba::python
