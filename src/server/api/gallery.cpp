#include <fmt/format.h>

#include <algorithm>
#include <mutex>
#include <sstream>

#include "app/scenario/read_scenario.h"
#include "app/scenario/scenario.h"
#include "core/error.h"
#include "core/file.h"
#include "server/api/lab_services.h"
#include "server/api/responses.h"
#include "server/gallery_index.h"
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

// The name of the model with its preset, if the file has one: "dipole IT-1".
std::string model_name(const Json& swarm, const Swarm& read) {
  const Json model = swarm.value("model", Json());
  const std::string preset = model.is_object() ? model.value("preset", "") : "";
  return preset.empty() ? read.model.type : read.model.type + " " + preset;
}

Json card(const LabServices& lab, const fs::path& file) {
  Json one = {{"name", file.stem()}, {"file", "scenes/" + file.filename().string()}};
  try {
    const Document d = read_toml(file);
    const Scenario s = read_scenario(d, lab.parts);
    std::uint64_t cells = 0;
    Json models = Json::array();
    for (std::size_t i = 0; i < s.swarms.size(); ++i) {
      cells += s.swarms[i].params.count;
      const std::string model = model_name(d.root["swarm"][i], s.swarms[i]);
      if (std::find(models.begin(), models.end(), model) == models.end()) models.push_back(model);
    }
    one.update({{"title", s.params.title},
                {"about", about(file)},
                {"cells", cells},
                {"duration_s", s.params.duration},
                {"models", models},
                {"controller", s.controller.type},
                {"bench", s.rig.has_value()}});
  } catch (const Error& e) {
    one.update({{"title", file.stem()}, {"error", e.what()}});
  }
  return one;
}

// The cards of the index come first, in its order.
Json scenes(const LabServices& lab) {
  Json listed = Json::array(), others = Json::array();
  std::vector<GalleryCard> index;
  try {
    index = read_gallery_index(lab.workspace.gallery());
  } catch (const Error& e) {
    others.push_back({{"name", kGalleryIndex},
                      {"file", std::string("scenes/") + kGalleryIndex},
                      {"title", kGalleryIndex},
                      {"error", e.what()}});
  }
  std::vector<fs::path> files = lab.workspace.scenes();
  for (const GalleryCard& c : index) {
    const auto file =
        std::find_if(files.begin(), files.end(), [&](const fs::path& f) { return f.stem() == c.name; });
    if (file == files.end()) continue;
    listed.push_back(card(lab, *file));
    listed.back().update(texts(c));
    files.erase(file);
  }
  for (const fs::path& file : files) others.push_back(card(lab, file));
  for (Json& one : others) listed.push_back(std::move(one));
  return listed;
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
