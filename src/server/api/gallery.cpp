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
#include "server/request_values.h"
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

// The document of a scene without the wiring of its coils.
Json without_coils(Json scene) {
  if (scene.contains("rig") && scene["rig"].is_object()) scene["rig"].erase("coil");
  return scene;
}

// A copy of a scene with other tables [[rig.coil]]. Nothing else may differ: a scene of a page must not name
// files, such as the library of a driver, that the page could not read otherwise.
Json save_copy(const LabServices& lab, const Json& asked) {
  const std::string name = text_of(asked, "name"), toml = text_of(asked, "toml");
  constexpr const char* kAllowed = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-_. ";
  if (name.find_first_not_of(kAllowed) != std::string::npos || name.front() == '.' || name.size() > 60)
    throw Error(Errc::usage, "name",
                "invalid name; it must consist of at most 60 letters, digits, spaces, dots, underscores and "
                "dashes, such as bench-coils");
  const fs::path original = lab.workspace.scene(text_of(asked, "copy_of"));
  const std::string shown = "scenes/" + name + ".toml";
  const fs::path file = lab.workspace.inside(shown);
  std::error_code ec;
  if (!fs::equivalent(file.parent_path(), original.parent_path(), ec))
    throw Error(Errc::usage, "scenes/",
                "not found in the folder of the lab: the scenes of the gallery are those of the program; "
                "copy the table of the coils into a scene of yours");
  if (fs::exists(file, ec)) throw Error(Errc::usage, shown, "exists; choose another name");
  try {
    const Document copy = parse_toml(toml, file.string());
    if (without_coils(copy.root) != without_coils(read_toml(original).root))
      throw Error(Errc::usage, shown,
                  "differs from its original in more than [[rig.coil]]; open the scene again");
    (void)read_scenario(copy, lab.parts);
  } catch (const Error& e) {  // pages know files by their names in the workspace
    const std::string where = e.where(), full = file.string();
    throw Error(e.code(), where.starts_with(full) ? shown + where.substr(full.size()) : where, e.reason());
  }
  write_file(file, toml);
  return {{"name", name}, {"file", shown}};
}

}  // namespace

void add_gallery_routes(Routes& routes, const LabServices& lab) {
  routes.add("GET", "/api/scenes", [&lab](const auto&, const auto&) { return json_answer(scenes(lab)); });
  routes.add("POST", "/api/scenes",
             [&lab](const auto& r, const auto&) { return json_answer(save_copy(lab, body_of(r))); });
  routes.add("GET", "/api/scenes/*", [&lab](const auto&, const auto& names) { return scene(lab, names[0]); });
  routes.add("GET", "/api/scenes/*/picture.png", [&lab](const auto&, const auto& names) {
    return picture_answer(picture_of(lab, lab.workspace.scene(names[0])));
  });
}

}  // namespace faba
