#include "server/scenarios/scene_cards.h"

#include <algorithm>
#include <sstream>

#include "app/scenario/read_scenario.h"
#include "app/scenario/scenario.h"
#include "core/error.h"
#include "core/file.h"
#include "server/scenarios/gallery_index.h"

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

Json card(const fs::path& file, const Parts& parts) {
  Json one = {{"name", file.stem()}, {"file", "scenes/" + file.filename().string()}};
  try {
    const Document d = read_toml(file);
    const Scenario s = read_scenario(d, parts);
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

}  // namespace

Json scene_cards(const fs::path& gallery, std::vector<fs::path> files, const Parts& parts) {
  Json listed = Json::array(), others = Json::array();
  std::vector<GalleryCard> index;
  try {
    index = read_gallery_index(gallery);
  } catch (const Error& e) {
    others.push_back({{"name", kGalleryIndex},
                      {"file", std::string("scenes/") + kGalleryIndex},
                      {"title", kGalleryIndex},
                      {"error", e.what()}});
  }
  for (const GalleryCard& c : index) {
    const auto file =
        std::find_if(files.begin(), files.end(), [&](const fs::path& f) { return f.stem() == c.name; });
    if (file == files.end()) continue;
    listed.push_back(card(*file, parts));
    listed.back().update(texts(c));
    files.erase(file);
  }
  for (const fs::path& file : files) others.push_back(card(file, parts));
  for (Json& one : others) listed.push_back(std::move(one));
  return listed;
}

Json scene_answer(const fs::path& file, const Parts& parts) {
  const Scenario s = read_scenario(read_toml(file), parts);
  return {{"name", file.stem()},
          {"file", "scenes/" + file.filename().string()},
          {"toml", read_file(file)},
          {"scenario", s.resolved()}};
}

}  // namespace faba
