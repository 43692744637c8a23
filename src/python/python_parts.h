#pragma once
#include <pybind11/pybind11.h>

#include <memory>

#include "app/scenario/scenario.h"
#include "python/raised.h"

namespace faba::python {

/// Estimator, reference and controller for a run: objects or classes in Python, or the name or table of a
/// built-in part; None: those of the scenario.
struct GivenParts {
  py::object estimator = py::none(), reference = py::none(), controller = py::none();

  /// Names the parts in the scenario, before it is read.
  void name_in(Document& d) const;
  /// The parts of the program, and those of type "python": the objects, or classes that a scenario names,
  /// which are imported. Their exceptions are kept in `raised`.
  Parts parts(const std::shared_ptr<Raised>& raised) const;
};

/// Adds a controller in Python under the name `type`; `given`: as in GivenParts.
void add_python_controller(Parts& p, const std::string& type, const py::object& given,
                           const std::shared_ptr<Raised>& raised);

}  // namespace faba::python
