#pragma once
#include <pybind11/pybind11.h>

#include <atomic>
#include <limits>
#include <optional>
#include <string>

#include "core/error.h"

namespace faba::python {
namespace py = pybind11;

/// What Python code raised while the engine ran without the global interpreter lock (GIL): a part, or the
/// handler of Ctrl-C. The engine sees an Error, as from its own parts; the caller in Python gets the original
/// exception with its traceback.
class Raised {
 public:
  /// Keeps the exception, unless there is one, and returns the Error that ends the run. The caller has the
  /// GIL.
  Error keep(const std::string& where, const py::error_already_set& e);
  /// Whether something was raised, also by Ctrl-C; asks the interpreter at most every 50 ms. The caller does
  /// not have the GIL. Several threads may call it; Python runs the handler of Ctrl-C in its main thread
  /// only.
  bool stopped();

  /// Calls `work` without the GIL; then throws what Python code raised, or else what `work` threw. `note` is
  /// added to the exception of Python code.
  template <class Work>
  void run(Work&& work, const std::string& note = {}) {
    std::exception_ptr error;
    {
      const py::gil_scoped_release released;
      try {
        work();
      } catch (...) {
        error = std::current_exception();
      }
    }
    rethrow(note);
    if (error) std::rethrow_exception(error);
  }

  /// Longest call of a part in Python, s: on a bench the time that the guard waits for a command.
  double longest_call = std::numeric_limits<double>::infinity();

 private:
  void rethrow(const std::string& note);

  std::optional<py::error_already_set> first_;
  std::atomic<bool> raised_{false};
  std::atomic<double> asked_{0};  ///< s
};

/// Registers faba.Error, and its translation from the C++ type.
void bind_error(py::module_& m);

}  // namespace faba::python
