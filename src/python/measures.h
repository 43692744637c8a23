#pragma once
#include <pybind11/pybind11.h>

namespace faba::python {

/// Coil fields and measures of arrays: Field, flow, distance; parts and schema.
void bind_measures(pybind11::module_& m);

}  // namespace faba::python
