#include "study/data/run_info.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "core/error.h"
#include "core/file.h"
#include "core/json_input.h"
#include "core/toml.h"

namespace faba {
namespace {

/// An object of the manifest with its path, for messages.
class Keys {
 public:
  Keys(const Json& json, std::string file, std::string prefix)
      : json_(json), file_(std::move(file)), prefix_(std::move(prefix)) {}

  const Json* find(const char* key) const {
    const auto at = json_.find(key);
    return at == json_.end() || at->is_null() ? nullptr : &*at;
  }
  [[noreturn]] void fail(const char* key, const char* wanted) const {
    throw Error(Errc::input, file_, fmt::format("{}{} must be {}", prefix_, key, wanted));
  }
  /// A string, or a number as its JSON text.
  std::string text(const char* key) const {
    const Json* value = find(key);
    if (!value) return {};
    if (value->is_structured()) fail(key, "a string or a number");
    return value->is_string() ? value->get<std::string>() : value->dump();
  }
  std::optional<double> number(const char* key) const {
    const Json* value = find(key);
    if (!value) return std::nullopt;
    if (!value->is_number()) fail(key, "a number");
    return value->get<double>();
  }
  std::optional<Vec2> pair(const char* key) const {
    const Json* value = find(key);
    if (!value) return std::nullopt;
    if (!value->is_array() || value->size() != 2 || !(*value)[0].is_number() || !(*value)[1].is_number()) {
      fail(key, "two numbers");
    }
    return Vec2{(*value)[0].get<double>(), (*value)[1].get<double>()};
  }

 private:
  const Json& json_;
  std::string file_, prefix_;
};

Json parsed(const std::filesystem::path& path) {
  Json json = parse_json(read_file(path));
  if (!json.is_object()) throw Error(Errc::input, path.string(), "not a JSON object");
  return json;
}

/// The scalar members of an object, as "name value, name value".
std::string one_line(const Json& object) {
  std::string line;
  for (const auto& [key, value] : object.items()) {
    if (value.is_structured() || value.is_null()) continue;
    line += fmt::format("{}{} {}", line.empty() ? "" : ", ", key,
                        value.is_string() ? value.get<std::string>() : value.dump());
  }
  return line;
}

std::vector<std::vector<Vec2>> polygons(const Json& list, const Keys& keys) {
  const auto number_pair = [](const Json& p) {
    return p.is_array() && p.size() == 2 && p[0].is_number() && p[1].is_number();
  };
  std::vector<std::vector<Vec2>> all;
  if (!list.is_array()) keys.fail("obstacles_px", "a list of polygons");
  for (const Json& polygon : list) {
    if (!polygon.is_array() || polygon.size() < 3 ||
        !std::all_of(polygon.begin(), polygon.end(), number_pair))
      keys.fail("obstacles_px", "a list of polygons: lists of at least 3 points [x, y]");
    std::vector<Vec2>& corners = all.emplace_back();
    for (const Json& p : polygon) corners.push_back({p[0].get<double>(), p[1].get<double>()});
  }
  return all;
}

/// `source`: for messages.
RunInfo run_info(const Json& json, const std::string& source) {
  const Keys keys(json, source, "");
  RunInfo info;
  info.version = keys.text("version");
  if (info.version.empty())
    throw Error(Errc::input, source, "has no key \"version\"; it is not the manifest of a run");
  info.title = keys.text("title");
  info.polarity = keys.text("polarity");
  info.seed = keys.text("seed");
  info.threads = keys.text("threads");
  info.state_hash = keys.text("state_hash");
  info.scenario_hash = keys.text("scenario_hash");
  info.video_shows = keys.text("video_shows");
  if (const Json* complete = keys.find("complete")) {
    if (!complete->is_boolean()) keys.fail("complete", "true or false");
    info.complete = complete->get<bool>();
  }
  info.duration_s = keys.number("duration_s");
  info.wall_time_s = keys.number("wall_time_s");
  info.setpoints = keys.number("setpoints");
  info.setpoint_tolerance_px = keys.number("setpoint_tolerance_px");
  info.path_done = keys.number("path_done");
  if (const auto both = keys.pair("two_swarm_distances_px")) info.two_swarm_distances_px = {both->x, both->y};
  info.um_per_px = keys.number("um_per_px");
  if (info.um_per_px && !(*info.um_per_px > 0)) keys.fail("um_per_px", "greater than 0");
  info.um_per_px_source = keys.text("um_per_px_source");
  info.nominal_um_per_px = keys.number("nominal_um_per_px");
  info.view_px = keys.pair("view_px");
  if (info.view_px && !(info.view_px->x > 0 && info.view_px->y > 0)) keys.fail("view_px", "greater than 0");

  if (const Json* arena = keys.find("arena")) {
    if (!arena->is_object()) keys.fail("arena", "an object");
    const Keys inside(*arena, source, "arena.");
    const auto centre = inside.pair("centre_px");
    if (centre)
      info.arena = {inside.text("type"), *centre, inside.number("radius_px"), inside.pair("size_px")};
  }
  if (const Json* obstacles = keys.find("obstacles_px")) info.obstacles_px = polygons(*obstacles, keys);
  if (const Json* notes = keys.find("notes")) {
    if (!notes->is_array()) keys.fail("notes", "a list");
    for (const Json& note : *notes) {
      if (!note.is_string()) keys.fail("notes", "a list of strings");
      info.notes.push_back(note.get<std::string>());
    }
  }
  if (const Json* swarms = keys.find("swarms")) {
    if (!swarms->is_array()) keys.fail("swarms", "a list");
    for (const Json& swarm : *swarms) {
      if (!swarm.is_object()) keys.fail("swarms", "a list of objects");
      info.swarms.push_back(one_line(swarm));
      const double cells = Keys(swarm, source, "swarms[].").number("count").value_or(0);
      if (!(cells >= 0 && cells < 1e15)) keys.fail("swarms[].count", "between 0 and 1e15");
      info.swarm_cells.push_back(std::uint64_t(cells));
    }
  }
  return info;
}

}  // namespace

RunInfo run_info(const Manifest& m) {
  RunInfo info;
  info.version = FABA_VERSION;
  info.title = m.title;
  info.polarity = m.polarity;
  info.seed = std::to_string(m.seed);
  info.scenario_hash = m.scenario_hash;
  info.complete = m.complete;
  info.open_loop = m.open_loop;
  info.um_per_px = m.um_per_px;
  info.nominal_um_per_px = m.nominal_um_per_px;
  if (m.um_per_px_source.is_string()) info.um_per_px_source = m.um_per_px_source.get<std::string>();
  info.view_px = m.view_px;
  info.arena = {m.arena_type, m.arena_centre_px, {}, {}};
  if (m.arena_radius_px > 0)
    info.arena->radius_px = m.arena_radius_px;
  else
    info.arena->size_px = m.view_px;
  if (m.simulated || m.bench) {
    info.video_shows = m.video_shows;
    info.duration_s = m.duration_s;
    info.wall_time_s = m.wall_time_s;
    info.setpoints = double(m.setpoints);
    info.setpoint_tolerance_px = m.setpoint_tolerance_px;
    info.path_done = m.path_done;
    info.two_swarm_distances_px = m.two_swarm_distances_px;
    info.obstacles_px = m.obstacles_px;
    info.notes = m.notes;
  }
  if (m.simulated) {
    info.threads = std::to_string(m.simulated->threads);
    info.state_hash = m.simulated->state_hash;
    for (const Manifest::Swarm& s : m.simulated->swarms) {
      info.swarms.push_back(one_line(swarm_json(s)));
      info.swarm_cells.push_back(s.params.count);
    }
  }
  return info;
}

RunInfo read_run_info(const std::filesystem::path& path) { return run_info(parsed(path), path.string()); }

}  // namespace faba
