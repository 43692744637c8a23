#include "server/tracks/track_results.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstring>
#include <ctime>

#include "core/error.h"
#include "core/file.h"
#include "core/hash.h"
#include "core/json_input.h"
#include "server/experiments/experiment_store.h"
#include "server/files/opened_input.h"
#include "server/request_values.h"

namespace faba {
namespace {

namespace fs = std::filesystem;
constexpr std::size_t kKeptResults = 3, kMostResults = 200;
constexpr const char* kEditedTracks = "edited_tracks.csv";
constexpr const char* kEditedFeatures = "edited_features.csv";
constexpr std::array<const char*, 4> kFates = {"passes", "cut", "deleted", "kept"};

std::string edits_revision(const std::string& content) {
  Hash h;
  h.text(content);
  return h.hex();
}

std::string edits_text(const fs::path& folder) {
  const fs::path file = folder / track_files::kEdits;
  std::error_code ec;
  return fs::exists(file, ec) ? read_file(file) : "";
}

void find_results(const fs::path& below, std::vector<std::pair<fs::file_time_type, fs::path>>& found) {
  std::error_code ec;
  for (const auto& e : fs::directory_iterator(below, ec))
    if (!e.path().filename().string().starts_with('.') && holds_tracks(e.path()))
      found.emplace_back(fs::last_write_time(e.path() / track_files::kSummary, ec), e.path());
}

}  // namespace

Json TrackResults::list() const {
  std::vector<std::pair<fs::file_time_type, fs::path>> found;
  find_results(workspace_.root() / "runs", found);
  std::error_code ec;
  for (const auto& e : fs::directory_iterator(workspace_.root() / "experiments", ec))
    find_results(e.path() / "tracks", found);
  std::sort(found.rbegin(), found.rend());
  Json all = Json::array();
  for (const auto& [_, dir] : found) {
    if (all.size() >= kMostResults) break;
    const Json j = parse_json(read_file(dir / track_files::kSummary));
    if (!j.is_object()) continue;
    all.push_back({{"folder", fs::relative(dir, workspace_.root(), ec).string()},
                   {"video", fs::path(j.value("video", "")).filename().string()},
                   {"tracks", j.value("tracks", 0)},
                   {"quality", j.value("quality", "")}});
  }
  return all;
}

std::string TrackResults::new_folder(const std::string& video) const {
  static std::atomic<unsigned> number{0};
  const std::string stamp = fmt::format("{:%Y%m%d-%H%M%S}-{}", fmt::localtime(std::time(nullptr)), ++number);
  const std::string stem = safe_name(fs::path(video).stem().string());
  const fs::path given = fs::path(video).lexically_normal();
  auto part = given.begin();
  std::string folder = "runs";
  std::string name = fmt::format("tracks-{}-{}", stem, stamp);
  if (part != given.end() && *part == "experiments" && std::distance(given.begin(), given.end()) > 2) {
    folder = fmt::format("experiments/{}/tracks", std::next(part)->string());
    name = fmt::format("{}-{}", stem, stamp);
  }
  fs::create_directories(workspace_.inside(folder));
  return folder + "/" + name;
}

fs::path TrackResults::path(const std::string& folder) const {
  fs::path dir = workspace_.existing(folder);
  if (!holds_tracks(dir)) throw Error(Errc::input, folder.substr(0, 200), "is not a folder with tracks");
  return dir;
}

std::shared_ptr<const TrackResults::Loaded> TrackResults::load(const std::string& folder) {
  const fs::path dir = path(folder);
  const std::string edits = edits_text(dir);
  const auto changed = fs::last_write_time(dir / track_files::kSummary).time_since_epoch().count();
  const std::string key = fmt::format("{}\n{}", dir.string(), changed), revision = edits_revision(edits);
  const std::lock_guard lock(mutex_);
  const auto at = std::find_if(loaded_.begin(), loaded_.end(), [&](const auto& r) { return r->key == key; });
  if (at != loaded_.end()) loaded_.splice(loaded_.begin(), loaded_, at);
  const bool known = at != loaded_.end();
  if (known && loaded_.front()->revision == revision) return loaded_.front();
  auto r = std::make_shared<Loaded>();
  r->key = key;
  r->revision = revision;
  r->folder = known ? loaded_.front()->folder : read_track_folder(dir);
  r->edited = apply_edits(r->folder, read_track_edits(dir, r->folder));
  if (known) loaded_.pop_front();
  loaded_.push_front(r);
  if (loaded_.size() > kKeptResults) loaded_.pop_back();
  return r;
}

Json TrackResults::tracks_json(const Loaded& r) const {
  Json tracks = Json::array(), features = Json::array();
  for (const TrackFeatureName& f : kTrackFeatureNames)
    features.push_back({{"name", f.name}, {"unit", f.unit}});
  for (const EditedTrack& t : r.edited.tracks) {
    Json values = Json::array();
    for (const double v : t.features) values.push_back(std::isfinite(v) ? Json(v) : Json(nullptr));
    tracks.push_back({{"number", t.track.number},
                      {"points", t.track.points.size()},
                      {"fate", kFates[std::size_t(t.fate)]},
                      {"values", std::move(values)}});
  }
  return {{"features", std::move(features)},
          {"tracks", std::move(tracks)},
          {"edits", edits_document(r.edited.edits, r.folder)},
          {"revision", r.revision}};
}

Json TrackResults::read(const std::string& folder) {
  const auto r = load(folder);
  Json j = tracks_json(*r);
  j["folder"] = folder;
  j["summary"] = r->folder.summary;
  j["video"] = nullptr;
  // The job was given a path relative to the workspace. Without its video, tracks are shown without pictures.
  const fs::path video = workspace_.root() / r->folder.summary.value("video", "");
  std::error_code ec;
  if (workspace_.may_read(video) && fs::exists(video, ec)) j["video"] = workspace_.name_of(video);
  return j;
}

std::string TrackResults::points(const std::string& folder) {
  const auto r = load(folder);
  std::string bytes;
  for (const EditedTrack& t : r->edited.tracks)
    for (const TrackPoint& p : t.track.points) {
      const auto frame = std::uint32_t(p.frame);
      const float values[] = {float(p.t_s), float(p.x_px), float(p.y_px)};
      char row[16];
      std::memcpy(row, &frame, 4);
      std::memcpy(row + 4, values, 12);
      bytes.append(row, sizeof row);
    }
  return bytes;
}

Json TrackResults::change(const std::string& folder, const Json& asked) {
  static std::mutex one_at_a_time;
  const std::lock_guard lock(one_at_a_time);
  const auto before = load(folder);
  if (text_of(asked, "revision") != before->revision)
    throw Error(Errc::usage, "revision",
                "the edits were changed by another page; load them again and repeat the change");
  Document d;
  d.name = track_files::kEdits;
  d.root = asked.value("edits", Json::object());
  if (!d.root.is_object()) throw Error(Errc::usage, "edits", "must be an object with cut and edit");
  d.root.erase("sha256");
  const TrackEdits edits = read_track_edits(d, before->folder);
  (void)apply_edits(before->folder, edits);  // invalid edits are not written
  const std::string text = to_toml(edits_document(edits, before->folder));
  with_opened(path(folder), folder,
              [&](const fs::path& dir) { write_file(dir / track_files::kEdits, text); });
  return tracks_json(*load(folder));
}

Json TrackResults::edited(const std::string& folder) {
  const auto r = load(folder);
  return edited_json(r->folder, r->edited);
}

Json TrackResults::write(const std::string& folder) {
  const auto r = load(folder);
  with_opened(path(folder), folder, [&](const fs::path& dir) {
    write_file(dir / kEditedTracks, edited_tracks_csv(r->folder, r->edited));
    write_file(dir / kEditedFeatures, track_features_csv(r->folder, r->edited));
  });
  return {{"tracks", kEditedTracks}, {"features", kEditedFeatures}};
}

}  // namespace faba
