#include "server/jobs/composed_study.h"

#include <fmt/format.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cctype>

#include "core/error.h"
#include "core/file.h"
#include "core/units.h"
#include "server/experiments/experiment_store.h"
#include "server/jobs/job_estimate.h"
#include "server/jobs/job_words.h"
#include "study/identify/identify_study.h"
#include "study/steering/controller_study.h"

namespace faba {
namespace {

namespace fs = std::filesystem;
constexpr const char* kStudies = "studies";

// The name that a page uses for a scene of the gallery with this stem; empty if it is not found.
std::string scene_name(const std::string& name, const Workspace& w) {
  for (const fs::path& scene : w.scenes())
    if (scene.stem() == fs::path(name).stem()) return "scenes/" + scene.filename().string();
  return "";
}

// Files of the page are relative to the workspace, those of a study file to its folder.
void relocate(Json& table, const char* key, const fs::path& folder, const Workspace& w,
              const std::string& where) {
  if (!table.contains(key)) return;
  try {
    const std::string name = table[key].is_string() ? table[key].get<std::string>() : "";
    // The gallery may be that of the program, outside the workspace.
    const bool in_gallery = std::string_view(key) == "scene" && name == scene_name(name, w);
    const fs::path file = in_gallery ? w.scene(fs::path(name).stem().string()) : w.existing(name);
    table[key] = file.lexically_relative(folder).generic_string();
  } catch (const Error& e) {
    throw Error(Errc::usage, where + key, e.what());
  }
}

void turn(Json& table, const std::string& where) {
  if (!table.contains("direction")) return;
  const JobInput direction{
      .key = where + "direction", .kind = JobInput::Kind::direction, .unit = "deg", .min = -360, .max = 360};
  table["direction"] = word_of(direction, table["direction"]) + " deg";
}

bool is_quantity(const Json& value) {
  if (!value.is_string()) return false;
  try {
    (void)parse_quantity(value.get<std::string>());
    return true;
  } catch (const std::invalid_argument&) {
    return false;
  }
}

// Values that override those of a scene are numbers: a text could name a file outside the workspace.
void check_numbers(const Json& variant, const std::string& where) {
  if (!variant.contains("set")) return;
  for (const auto& [path, value] : variant["set"].items()) {
    const JobInput number{.key = fmt::format("{}set.{}", where, path)};
    const auto key = path.substr(path.find_last_of('.') + 1);
    if (key == "file" || key == "background")
      throw Error(Errc::usage, number.key, "is the name of a file; choose a number of the scenario");
    if (!value.is_number() && !is_quantity(value))
      throw Error(Errc::usage, number.key, fmt::format("{} is not a number or a quantity", value.dump()));
  }
}

void prepare(Json& study, const fs::path& folder, const Workspace& w) {
  for (const char* key : {"scene", "scale", "calibration"})
    if (study.contains(key) && study[key].is_string()) relocate(study, key, folder, w, "");
  turn(study, "");
  const auto each = [&](const char* list, auto&& does) {
    if (!study.contains(list)) return;
    if (!study[list].is_array()) throw Error(Errc::usage, list, "must be a list of tables");
    for (std::size_t i = 0; i < study[list].size(); ++i) {
      if (!study[list][i].is_object())
        throw Error(Errc::usage, fmt::format("{}[{}]", list, i), "must be a table");
      does(study[list][i], fmt::format("{}[{}].", list, i));
    }
  };
  each("video", [&](Json& v, const std::string& where) {
    relocate(v, "file", folder, w, where);
    turn(v, where);
    if (v.contains("segment") && v["segment"].is_array())
      for (Json& s : v["segment"])
        if (s.is_object()) turn(s, where + "segment.");
  });
  for (const char* list : {"model", "controller"})
    each(list, [&](Json& v, const std::string& where) {
      w.check_files(v);
      check_numbers(v, where);
    });
  if (study.contains("scene") && study["scene"].is_object()) w.check_files(study["scene"]);
}

// Reads the study as the verb does, including the combinations of controllers and models.
void check(const JobKind& kind, const fs::path& file) {
  if (kind.study == JobStudy::identification) {
    (void)read_identify_study(file);
  } else {
    const ControllerStudy study = read_controller_study(file);
    (void)controller_trials(study, [] { return false; });
  }
}

// The place of an error without the temporary name of the file: "video[0].direction".
Error in_study(const Error& e, const fs::path& file) {
  std::string where = e.where(), what = e.reason();
  for (std::string* text : {&where, &what})
    for (const std::string& name : {file.string(), file.filename().string()})
      for (std::size_t at; (at = text->find(name)) != std::string::npos;) {
        std::size_t end = at + name.size();
        // ":12: ", the line
        while (end < text->size() && (std::isdigit(static_cast<unsigned char>((*text)[end])) ||
                                      (*text)[end] == ':' || (*text)[end] == ' '))
          ++end;
        text->erase(at, end - at);
      }
  return {Errc::usage, where, what};
}

fs::path free_name(const fs::path& folder, const std::string& name, const std::string& toml) {
  fs::path file = folder / (name + ".toml");
  for (int i = 2; fs::exists(file) && read_file(file) != toml; ++i)
    file = folder / fmt::format("{}-{}.toml", name, i);
  return file;
}

}  // namespace

ComposedStudy compose_study(const JobKind& kind, const Json& asked, const Workspace& w) {
  if (kind.study == JobStudy::none)
    throw Error(Errc::usage, "kind",
                fmt::format("{} has no study; it must be identify or compare-controllers", kind.name));
  const std::string name = safe_name(asked.value("name", ""));
  const bool draft = asked.value("draft", false);
  if (name.empty() && !draft) throw Error(Errc::usage, "name", "must have at least one letter or digit");
  if (!asked.contains("study") || !asked["study"].is_object())
    throw Error(Errc::usage, "study", "missing; it must be a table");
  const std::string base = asked.value("folder", "");
  const fs::path folder = (base.empty() ? w.root() : w.existing(base)) / kStudies;
  Json study = asked["study"];
  prepare(study, folder, w);
  const bool is_new = !fs::exists(folder);
  fs::create_directories(folder);
  static std::atomic<unsigned> number{0};
  const fs::path temporary = folder / fmt::format(".draft-{}-{}.toml", ::getpid(), ++number);
  ComposedStudy composed{.file = {}, .toml = to_toml(study)};
  try {
    write_file(temporary, composed.toml);
    check(kind, temporary);
    composed.work = work_of_study(kind, temporary);
    const fs::path file = free_name(folder, name.empty() ? kind.name : name, composed.toml);
    composed.file = file.lexically_relative(w.root()).generic_string();
    if (draft)
      fs::remove(temporary);
    else
      fs::rename(temporary, file);
  } catch (const Error& e) {
    std::error_code ec;
    fs::remove(temporary, ec);
    if (is_new) fs::remove(folder, ec);
    throw in_study(e, temporary);
  }
  if (draft && is_new) {
    std::error_code ec;
    fs::remove(folder, ec);
  }
  return composed;
}

}  // namespace faba
