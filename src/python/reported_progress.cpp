#include "python/reported_progress.h"

namespace faba::python {

ReportedProgress::ReportedProgress(const py::object& function, std::shared_ptr<Raised> raised)
    : raised_(std::move(raised)) {
  if (!function.is_none()) function_.emplace(function);
}

void ReportedProgress::report(std::uint64_t done, std::uint64_t total) {
  constexpr double kEvery = 0.1;  // s
  const double now = monotonic_now();
  if (!function_ || (now - reported_ < kEvery && done != total)) return;
  reported_ = now;
  const py::gil_scoped_acquire gil;
  try {
    function_->get()(done, total);
  } catch (const py::error_already_set& e) {
    (void)raised_->keep("progress", e);
  }
}

}  // namespace faba::python
