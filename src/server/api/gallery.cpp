#include <fmt/format.h>

#include <mutex>

#include "app/scenario/read_scenario.h"
#include "app/scenario/scenario.h"
#include "core/error.h"
#include "core/file.h"
#include "server/api/lab_services.h"
#include "server/api/responses.h"
#include "server/request_values.h"
#include "server/scenarios/scene_cards.h"
#include "study/pages/thumbnail.h"

namespace faba {
namespace {

namespace fs = std::filesystem;

// Rendered again only if the scene file has changed.
fs::path picture_of(const LabServices& lab, const fs::path& scene) {
  const auto changed = fs::last_write_time(scene).time_since_epoch().count();
  fs::path file = lab.pictures / fmt::format("scene-{}-{}.png", scene.stem().string(), changed);
  static std::mutex one_at_a_time;
  const std::lock_guard lock(one_at_a_time);
  if (!fs::exists(file)) write_scene_thumbnail(read_scenario(read_toml(scene), lab.parts), file);
  return file;
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
    const std::string& where = e.where();
    const std::string full = file.string();
    throw Error(e.code(), where.starts_with(full) ? shown + where.substr(full.size()) : where, e.reason());
  }
  write_file(file, toml);
  return {{"name", name}, {"file", shown}};
}

}  // namespace

void add_gallery_routes(Routes& routes, const LabServices& lab) {
  routes.add("GET", "/api/scenes", [&lab](const auto&, const auto&) {
    return json_answer(scene_cards(lab.workspace.gallery(), lab.workspace.scenes(), lab.parts));
  });
  routes.add("POST", "/api/scenes",
             [&lab](const auto& r, const auto&) { return json_answer(save_copy(lab, body_of(r))); });
  routes.add("GET", "/api/scenes/*", [&lab](const auto&, const auto& names) {
    return json_answer(scene_answer(lab.workspace.scene(names[0]), lab.parts));
  });
  routes.add("GET", "/api/scenes/*/picture.png", [&lab](const auto&, const auto& names) {
    return picture_answer(picture_of(lab, lab.workspace.scene(names[0])));
  });
}

}  // namespace faba
