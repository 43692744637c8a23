#include <pybind11/pybind11.h>

#include "python/batch.h"
#include "python/loop_values.h"
#include "python/measures.h"
#include "python/raised.h"
#include "python/runs.h"
#include "python/simulation.h"
#include "python/worlds.h"

PYBIND11_MODULE(_faba, m) {
  if (PyInterpreterState_Get() != PyInterpreterState_Main())
    throw pybind11::import_error(
        "faba cannot be used in a subinterpreter; import it in the main interpreter");
  m.doc() = "The engine of Faba; use the package faba.";
  m.attr("__version__") = FABA_VERSION;
  faba::python::bind_error(m);
  faba::python::bind_loop_values(m);
  faba::python::bind_simulation(m);
  faba::python::bind_runs(m);
  faba::python::bind_batch(m);
  faba::python::bind_worlds(m);
  faba::python::bind_measures(m);
}
