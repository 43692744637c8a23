#include "python/scene.h"

#include <fmt/format.h>

#include "app/run/random_seed.h"
#include "app/scenario/read_scenario.h"
#include "core/process/installation.h"
#include "python/convert.h"

namespace faba::python {
namespace {

bool is_toml_text(const std::string& scene) {
  return scene.find('\n') != std::string::npos || scene.find('=') != std::string::npos;
}

Document read_source(const py::object& scene) {
  if (py::isinstance<py::dict>(scene)) {
    Document d;
    d.name = "scene";
    d.root = json_of(scene, "");
    d.set("title", d.root.value("title", "scene"), "scene");
    return d;
  }
  const py::object path = py::hasattr(scene, "__fspath__") ? scene.attr("__fspath__")() : scene;
  if (!py::isinstance<py::str>(path))
    throw Error(Errc::usage, "scene",
                fmt::format("has the type {}; give the path of a scenario, its text, or a dictionary",
                            py::str(py::type::of(scene).attr("__name__")).cast<std::string>()));
  auto text = path.cast<std::string>();
  const bool is_text = path.is(scene) && is_toml_text(text);
  if (!is_text) text = file_or_example(text, "scenes").string();
  Document d = is_text ? parse_toml(text, "scene") : read_toml(text);
  if (!d.root.contains("title"))
    d.set("title", Json(is_text ? "scene" : std::filesystem::path(text).stem().string()), text);
  return d;
}

}  // namespace

void set_value(Document& d, const std::string& path, const Json& value, const std::string& label) {
  if (value.is_string())
    d.set(path, value.get<std::string>(), label);
  else
    d.set(path, value, label);
}

Document read_document(const SceneArguments& a) {
  Document d = read_source(a.scene);
  if (!a.set.is_none()) {
    if (!py::isinstance<py::dict>(a.set))
      throw Error(Errc::usage, "set", "is not a dictionary from paths to values");
    for (const auto& [path, value] : py::reinterpret_borrow<py::dict>(a.set)) {
      const auto name = py::str(path).cast<std::string>();
      set_value(d, name, json_of(value, name), "--set");
    }
  }
  if (!a.duration.is_none()) set_value(d, "duration", json_of(a.duration, "duration"), "--duration");
  if (!a.seed.is_none()) set_value(d, "seed", json_of(a.seed, "seed"), "--seed");
  a.parts.name_in(d);
  return d;
}

Scenario read_scenario_with(Document d, const Parts& parts) {
  Scenario s = read_scenario(std::move(d), parts);
  if (!s.params.seed) s.params.seed = random_seed();
  return s;
}

Scenario read_scene(const SceneArguments& a, const std::shared_ptr<Raised>& raised) {
  return read_scenario_with(read_document(a), a.parts.parts(raised));
}

}  // namespace faba::python
