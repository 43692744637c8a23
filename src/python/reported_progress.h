#pragma once
#include <pybind11/pybind11.h>

#include <atomic>
#include <memory>
#include <optional>

#include "python/python_object.h"

namespace faba::python {

/// Calls a function of Python with the progress, at most every 100 ms and at the end. An exception of it is
/// kept, so that Raised::stopped() is true.
class ReportedProgress {
 public:
  /// `function`: of the number of items done and their total; None: none.
  ReportedProgress(const py::object& function, std::shared_ptr<Raised> raised);
  /// The caller does not have the GIL. Several threads may call it.
  void report(std::uint64_t done, std::uint64_t total);

 private:
  std::optional<SharedObject> function_;
  std::shared_ptr<Raised> raised_;
  std::atomic<double> reported_{0};  ///< s
};

}  // namespace faba::python
