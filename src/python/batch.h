#pragma once
#include <pybind11/pybind11.h>

namespace faba::python {

/// The functions for many simulations: simulate, compare_controllers.
void bind_batch(pybind11::module_& m);

}  // namespace faba::python
