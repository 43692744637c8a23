#pragma once
#include <pybind11/pybind11.h>

#include "app/scenario/scenario.h"
#include "python/python_parts.h"

namespace faba::python {

/// What a scenario is read from in Python.
struct SceneArguments {
  py::object scene;                  ///< path, TOML text, or dictionary
  py::object seed = py::none();      ///< None: that of the scenario, else a random seed
  py::object set = py::none();       ///< dictionary from paths, such as swarm[0].count, to values
  py::object duration = py::none();  ///< s, or text such as "10 s"; None: that of the scenario
  GivenParts parts = {};
};

/// Sets a value of a scenario; a text is read like that of --set on the command line. `label` is the place of
/// the value in errors; "--set" and other options become the names of arguments.
void set_value(Document& d, const std::string& path, const Json& value, const std::string& label);
/// The document with all changes; parts in Python are named.
Document read_document(const SceneArguments& a);
/// Its scenario, with a seed. Exceptions of parts in Python are kept in `raised`. Throws Error(usage).
Scenario read_scene(const SceneArguments& a, const std::shared_ptr<Raised>& raised);
/// The same from a document, with the parts of a.parts.parts().
Scenario read_scenario_with(Document d, const Parts& parts);

}  // namespace faba::python
