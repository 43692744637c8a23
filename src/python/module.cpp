#include <pybind11/pybind11.h>

#include "python/batch.h"
#include "python/loop_values.h"
#include "python/measures.h"
#include "python/raised.h"
#include "python/runs.h"
#include "python/simulation.h"
#include "python/worlds.h"

namespace {

namespace py = pybind11;

// Parts in Python are called from threads of the engine, which have no interpreter of their own: the GIL is
// always that of the main interpreter.
bool in_main_interpreter() {
  if (PyInterpreterState_Get() == PyInterpreterState_Main()) return true;
  PyErr_SetString(PyExc_ImportError,
                  "faba cannot be used in a subinterpreter; import it in the main interpreter");
  return false;
}

PyObject* require_main_interpreter(PyObject*, PyObject*) {
  if (!in_main_interpreter()) return nullptr;
  Py_RETURN_NONE;
}

// Without pybind11, which does not work in a subinterpreter. Python does not initialise the module again
// there.
PyMethodDef require = {"require_main_interpreter", require_main_interpreter, METH_NOARGS,
                       "Raises ImportError in a subinterpreter."};
PyModuleDef definition = {
    PyModuleDef_HEAD_INIT, "_faba", nullptr, -1, nullptr, nullptr, nullptr, nullptr, nullptr};

PyObject* make_module() {
  (void)py::detail::get_internals();
  py::module_ m =
      py::module_::create_extension_module("_faba", "The engine of Faba; use the package faba.", &definition);
  m.attr("__version__") = FABA_VERSION;
  m.attr("require_main_interpreter") = py::reinterpret_steal<py::object>(PyCFunction_New(&require, nullptr));
  faba::python::bind_error(m);
  faba::python::bind_loop_values(m);
  faba::python::bind_simulation(m);
  faba::python::bind_runs(m);
  faba::python::bind_batch(m);
  faba::python::bind_worlds(m);
  faba::python::bind_measures(m);
  return m.release().ptr();
}

}  // namespace

// What the macro PYBIND11_MODULE defines, after the check of the interpreter. Python prescribes the name.
// NOLINTBEGIN(bugprone-reserved-identifier)
extern "C" PYBIND11_EXPORT PyObject* PyInit__faba();
extern "C" PYBIND11_EXPORT PyObject* PyInit__faba() {
  if (!in_main_interpreter()) return nullptr;
  try {
    return make_module();
  } catch (py::error_already_set& e) {
    py::raise_from(e, PyExc_ImportError, "initialization failed");
  } catch (const std::exception& e) {
    PyErr_SetString(PyExc_ImportError, e.what());
  }
  return nullptr;
}
// NOLINTEND(bugprone-reserved-identifier)
