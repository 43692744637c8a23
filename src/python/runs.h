#pragma once
#include <pybind11/pybind11.h>

namespace faba::python {

/// The functions that record a run: run_scene, resume_run, bench_run, replay_run.
void bind_runs(pybind11::module_& m);

}  // namespace faba::python
