#include <fmt/format.h>

#include <mutex>
#include <sstream>

#include "app/scenario/read_scenario.h"
#include "app/scenario/scenario.h"
#include "core/error.h"
#include "core/file.h"
#include "server/api/lab_services.h"
#include "server/api/responses.h"
#include "study/pages/thumbnail.h"

namespace faba {
namespace {

namespace fs = std::filesystem;

// The comment at the top of a scene.
std::string about(const fs::path& scene) {
  std::string text;
  std::istringstream in(read_file(scene));
  for (std::string line; std::getline(in, line) && line.starts_with("#");)
    text += (text.empty() ? "" : " ") + line.substr(std::min(line.find_first_not_of("# "), line.size()));
  return text;
}

Json scenes(const LabServices& lab) {
  Json all = Json::array();
  for (const fs::path& file : lab.workspace.scenes()) {
    Json one = {{"name", file.stem()}, {"file", "scenes/" + file.filename().string()}};
    try {
      const Scenario s = read_scenario(read_toml(file), lab.parts);
      std::uint64_t cells = 0;
      for (const Swarm& swarm : s.swarms) cells += swarm.params.count;
      one.update({{"title", s.params.title},
                  {"about", about(file)},
                  {"cells", cells},
                  {"bench", s.rig.has_value()}});
    } catch (const Error& e) {
      one.update({{"title", file.stem()}, {"error", e.what()}});
    }
    all.push_back(one);
  }
  return all;
}

// Rendered again only if the scene file has changed.
fs::path picture_of(const LabServices& lab, const fs::path& scene) {
  const auto changed = fs::last_write_time(scene).time_since_epoch().count();
  fs::path file = lab.pictures / fmt::format("scene-{}-{}.png", scene.stem().string(), changed);
  static std::mutex one_at_a_time;
  const std::lock_guard lock(one_at_a_time);
  if (!fs::exists(file)) write_scene_thumbnail(read_scenario(read_toml(scene), lab.parts), file);
  return file;
}

WebResponse scene(const LabServices& lab, const std::string& name) {
  const fs::path file = lab.workspace.scene(name);
  const Scenario s = read_scenario(read_toml(file), lab.parts);
  return json_answer({{"name", name},
                      {"file", "scenes/" + name + ".toml"},
                      {"toml", read_file(file)},
                      {"scenario", s.resolved()}});
}

}  // namespace

void add_gallery_routes(Routes& routes, const LabServices& lab) {
  routes.add("GET", "/api/scenes", [&lab](const auto&, const auto&) { return json_answer(scenes(lab)); });
  routes.add("GET", "/api/scenes/*", [&lab](const auto&, const auto& names) { return scene(lab, names[0]); });
  routes.add("GET", "/api/scenes/*/picture.png", [&lab](const auto&, const auto& names) {
    return picture_answer(picture_of(lab, lab.workspace.scene(names[0])));
  });
}

}  // namespace faba
