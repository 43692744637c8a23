#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <set>
#include <string>

#include "app/scenario/rig_file.h"
#include "core/error.h"
#include "core/file.h"
#include "server/api/lab_services.h"
#include "server/api/responses.h"
#include "server/files/opened_input.h"
#include "server/request_values.h"
#include "study/pages/field_report.h"

namespace faba {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostCoils = 24, kMostCoilFiles = 500, kLongestCoilName = 60;
constexpr std::uint64_t kMostGrid = 64;
constexpr double kLeastView = 1e-4, kMostView = 10;       // m
constexpr double kLeastSample = 1e-6, kMostSample = 0.1;  // m
constexpr const char* kCoilFolder = "rigs";

// `n` coordinates in m.
std::vector<double> position_of(const Json& asked, const char* key, std::size_t n) {
  const Json values = asked.contains(key) ? asked[key] : Json();
  const bool valid =
      values.is_array() && values.size() == n && std::all_of(values.begin(), values.end(), [](const Json& v) {
        return v.is_number() && std::fabs(v.get<double>()) <= kMostView;
      });
  if (!valid)
    throw Error(Errc::usage, key,
                fmt::format("must be a list of {} coordinates in m, each between {:g} and {:g} m", n,
                            -kMostView, kMostView));
  return values;
}

// The coil system that a page sends, with the limits of the editor. Measured maps are files; they have no
// winding to draw.
Document system_of(const Json& asked) {
  if (!asked.contains("system") || !asked["system"].is_object())
    throw Error(Errc::usage, "system", "missing; it must be a table with the coils");
  Document d;
  d.root = asked["system"];
  if (!d.root.contains("coil") || !d.root["coil"].is_array() || d.root["coil"].empty())
    throw Error(Errc::usage, "coil", "the coil system has no coils; add at least one");
  const Json& coils = d.root["coil"];
  if (coils.size() > kMostCoils)
    throw Error(
        Errc::usage, "coil",
        fmt::format("the coil system has {} coils; it must have at most {}", coils.size(), kMostCoils));
  for (std::size_t k = 0; k < coils.size(); ++k)
    if (coils[k].is_object() && coils[k].value("type", Json()) == "map")
      throw Error(Errc::usage, fmt::format("coil[{}]", k),
                  "is a measured map, which the editor cannot draw; edit the file as text, and use the "
                  "analyses of coil systems");
  return d;
}

CoilDesignOptions options_of(const Json& asked, const Parts& parts) {
  CoilDesignOptions o;
  o.width = number_of(asked, "width_m", kLeastView, kMostView);
  o.height = number_of(asked, "height_m", kLeastView, kMostView);
  o.columns = int(count_of(asked, "columns", 1, kMostGrid));
  o.rows = int(count_of(asked, "rows", 1, kMostGrid));
  if (asked.value("side", false)) o.planes.push_back(CoilDesignOptions::Plane::side);
  o.fast = asked.value("fast", false);
  const auto probe = position_of(asked, "probe_m", 3), target = position_of(asked, "target_m", 2);
  o.probe = {probe[0], probe[1], probe[2]};
  o.target = {target[0], target[1]};
  const std::string polarity = asked.value("polarity", "north");
  if (polarity != "north" && polarity != "south")
    throw Error(Errc::usage, "polarity",
                fmt::format("unknown polarity \"{}\"; it must be north or south", polarity.substr(0, 80)));
  o.polarity = polarity == "south" ? -1 : 1;
  o.sample = number_of(asked, "sample_m", kLeastSample, kMostSample);
  Document d;
  d.root = {{"model", asked.value("model", Json("dipole"))}};
  o.cell = turning_motion(parts.model.resolve(Node(d).child("model")));
  return o;
}

Json evaluate(const LabServices& lab, const Json& asked) {
  const auto field = read_rig(system_of(asked), lab.parts).make({});
  return field_json(coil_design(*field, options_of(asked, lab.parts)));
}

// The coil systems in rigs/ of the workspace, and of the project of the gallery: those that are installed
// with the program.
Json list(const LabServices& lab) {
  std::set<std::string> found;
  for (const fs::path& project : {lab.workspace.root(), lab.workspace.gallery().parent_path()}) {
    std::error_code ec;
    for (const auto& e : fs::directory_iterator(project / kCoilFolder, ec))
      if (e.is_regular_file(ec) && e.path().extension() == ".toml" && found.size() < kMostCoilFiles)
        found.insert(fmt::format("{}/{}", kCoilFolder, e.path().filename().string()));
  }
  return found;
}

// A coil system of the workspace, or one that is installed with the program: as in its file, and with all
// defaults.
Json opened(const LabServices& lab, const std::string& name) {
  const fs::path installed = lab.workspace.gallery().parent_path() / kCoilFolder / fs::path(name).filename();
  std::error_code ec;
  const bool here = fs::exists(lab.workspace.inside(name), ec);
  const bool is_installed = !here && fs::path(name).parent_path() == kCoilFolder && fs::exists(installed, ec);
  const fs::path path =
      is_installed ? lab.workspace.scenario_file("../" + name) : lab.workspace.existing(name);
  const Document d = with_opened(path, name, [](const fs::path& file) { return read_toml(file); });
  const Document checked = system_of({{"system", d.root}});
  return {{"file", name}, {"system", checked.root}, {"resolved", read_rig(d, lab.parts).resolved}};
}

// Names that are valid in every file system and need no quotes in a command.
void check_name(const std::string& name) {
  const auto plain = [](unsigned char c) { return (std::isalnum(c) && c < 128) || c == '-' || c == '_'; };
  if (name.size() > kLongestCoilName || name.starts_with('-') ||
      !std::all_of(name.begin(), name.end(), plain))
    throw Error(Errc::usage, "name",
                fmt::format("\"{}\" is not a valid name; it must have at most {} letters (a to z), digits, "
                            "- and _, and not begin with -",
                            name.substr(0, 80), kLongestCoilName));
}

Json save(const LabServices& lab, const Json& asked) {
  const std::string name = text_of(asked, "name");
  check_name(name);
  const std::string text = to_toml(system_of(asked).root);
  (void)read_rig(parse_toml(text, name + ".toml"), lab.parts);
  const std::string shown = fmt::format("{}/{}.toml", kCoilFolder, name);
  const fs::path file = lab.workspace.inside(shown);
  if (fs::exists(fs::symlink_status(file)) && !asked.value("replace", false))
    return {{"file", shown}, {"exists", true}};
  fs::create_directories(file.parent_path());
  with_opened(file.parent_path(), kCoilFolder,
              [&](const fs::path& folder) { write_file(folder / file.filename(), text); });
  return {{"file", shown}, {"exists", false}, {"toml", text}};
}

}  // namespace

void add_coil_routes(Routes& routes, const LabServices& lab) {
  routes.add("POST", "/api/coils/evaluate",
             [&lab](const auto& r, const auto&) { return json_answer(evaluate(lab, body_of(r))); });
  routes.add("POST", "/api/coils",
             [&lab](const auto& r, const auto&) { return json_answer(save(lab, body_of(r))); });
  routes.add("GET", "/api/coils", [&lab](const auto&, const auto&) { return json_answer(list(lab)); });
  routes.add("GET", "/api/coils/**",
             [&lab](const auto&, const auto& names) { return json_answer(opened(lab, names[0])); });
}

}  // namespace faba
