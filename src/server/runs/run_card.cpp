#include "server/runs/run_card.h"

#include <fmt/format.h>

#include <algorithm>

#include "app/recording/run_lock.h"
#include "core/error.h"
#include "core/file.h"
#include "core/json_input.h"
#include "server/files/trash.h"
#include "study/data/run_info.h"
#include "study/data/series.h"
#include "study/steering/metrics.h"

namespace faba {
namespace {

namespace fs = std::filesystem;
constexpr std::size_t kMostTags = 20, kLongestTag = 40, kLongestNote = 4000;  // bytes

// The models of the swarms, each once: "dipole, adapted"; of a run on a bench the driver of its coils.
std::string models_of(const Json& manifest) {
  if (manifest.contains("rig")) return manifest["rig"].value("driver", "");
  std::vector<std::string> names;
  for (const Json& swarm : manifest.value("swarms", Json::array())) {
    const std::string name = swarm.value("model", "");
    if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  }
  return fmt::format("{}", fmt::join(names, ", "));
}

void add_tags(Json& card, const fs::path& dir) {
  card["tags"] = Json::array();
  card["note"] = "";
  std::error_code ec;
  if (!fs::is_regular_file(dir / kTagsFile, ec)) return;
  try {
    card.update(tags_of(parse_json(read_file(dir / kTagsFile))));
  } catch (const std::exception&) {
    return;  // edited by hand; the page can replace it
  }
}

void measure(Json& card, const fs::path& dir) {
  const Document scenario = read_toml(dir / run_files::kScenario);
  const Json controller = scenario.root.value("controller", Json());
  if (controller.is_object()) card["controller"] = controller.value("type", "");
  if (!fs::exists(dir / "series.csv")) return;
  const RunInfo info = read_run_info(dir / run_files::kManifest);
  const Metrics m = control_metrics(read_series(dir / "series.csv"), info.setpoint_tolerance_px,
                                    std::size_t(info.setpoints.value_or(0)));
  if (m.setpoints == 0) return;
  card["has_setpoint"] = true;
  if (m.settling_time_s) card["settling_time_s"] = *m.settling_time_s;
  if (!m.steady_rms_px) return;
  card["steady_rms_px"] = *m.steady_rms_px;
  if (info.um_per_px) card["steady_rms_um"] = *m.steady_rms_px * *info.um_per_px;
}

std::string trimmed(std::string text) {
  text.erase(0, text.find_first_not_of(" \t"));
  text.erase(text.find_last_not_of(" \t") + 1);
  return text;
}

std::string tag_of(const Json& asked) {
  std::string tag = asked.is_string() ? trimmed(asked.get<std::string>()) : "";
  const bool plain = std::none_of(tag.begin(), tag.end(), [](char c) { return std::uint8_t(c) < 0x20; });
  if (tag.empty() || tag.size() > kLongestTag || !plain)
    throw Error(Errc::usage, "tags",
                fmt::format("{} is not a tag; a tag must be a text of 1 to {} bytes in one line",
                            asked.dump().substr(0, 2 * kLongestTag), kLongestTag));
  return tag;
}

}  // namespace

Json run_card(const std::string& name, const fs::path& dir) {
  const Json m = parse_json(read_file(dir / run_files::kManifest));
  if (!m.is_object()) throw Error(Errc::input, name, "has an invalid manifest");
  Json files = Json::array();
  for (const char* file : {"series.csv", "tracks.h5", "video.mp4", "video.avi", "flow.h5", "report.html"})
    if (fs::exists(dir / file)) files.push_back(file);
  Json card = {{"name", name},
               {"title", m.value("title", "")},
               {"date", m.value("date", "")},
               {"complete", m.value("complete", false) && !RunLock::marks(dir)},
               {"frames", m.value("frames", 0)},
               {"duration_s", m.value("duration_s", 0.0)},
               {"recorded_s", m.value("recorded_s", Json())},
               {"seed", m.contains("seed") ? m["seed"].dump() : ""},
               {"state_hash", m.value("state_hash", "")},
               {"cells", m.value("cells", Json())},
               {"model", models_of(m)},
               {"bytes", bytes_of(dir)},
               {"files", files},
               {"measured", false}};
  add_tags(card, dir);
  return card;
}

void measure_run(Json& card, const fs::path& dir) {
  card.update({{"measured", true},
               {"controller", ""},
               {"has_setpoint", false},
               {"settling_time_s", nullptr},
               {"steady_rms_px", nullptr},
               {"steady_rms_um", nullptr}});
  try {
    measure(card, dir);
  } catch (const std::exception&) {
    return;
  }
}

Json tags_of(const Json& asked) {
  const Json given = asked.is_object() ? asked.value("tags", Json::array()) : Json();
  if (!given.is_array() || given.size() > kMostTags)
    throw Error(Errc::usage, "tags", fmt::format("must be a list of at most {} tags", kMostTags));
  Json tags = Json::array();
  for (const Json& one : given) {
    const std::string tag = tag_of(one);
    if (std::find(tags.begin(), tags.end(), Json(tag)) == tags.end()) tags.push_back(tag);
  }
  const Json note = asked.value("note", Json(""));
  if (!note.is_string() || note.get_ref<const std::string&>().size() > kLongestNote)
    throw Error(Errc::usage, "note", fmt::format("must be a text of at most {} bytes", kLongestNote));
  return {{"tags", tags}, {"note", note}};
}

}  // namespace faba
