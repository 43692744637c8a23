#include "study/pages/tracks/track_folder.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <unordered_map>

#include "core/error.h"
#include "core/file.h"
#include "core/json_input.h"
#include "core/schema.h"
#include "core/table.h"
#include "study/data/sha256.h"
#include "study/data/table_list.h"
#include "study/pages/tracks/track_json.h"
#include "study/pages/tracks/track_output.h"

namespace faba {
namespace {

namespace fs = std::filesystem;
constexpr double kLargestNumber = 1e15;

std::vector<std::string> feature_words() {
  std::vector<std::string> words;
  words.reserve(std::size(kTrackFeatureNames));
  for (const TrackFeatureName& f : kTrackFeatureNames) words.emplace_back(f.name);
  return words;
}
const std::vector<std::string> kEditWords = {"delete", "keep", "split", "join"};

Schema<TrackCut> cut_schema() {
  return Schema<TrackCut>("cut", "Limits of a feature of the tracks that are used")
      .add("feature", &TrackCut::feature,
           {.doc = "Feature of a track; lengths are in px", .choices = feature_words()})
      .add("min", &TrackCut::min, {.doc = "Smallest value"})
      .add("max", &TrackCut::max, {.doc = "Largest value"})
      .check([](const TrackCut& c) -> std::string {
        if (!c.min && !c.max) return "needs min, max or both";
        if (c.min && c.max && *c.min > *c.max)
          return fmt::format("min = {:g} is above max = {:g}; give a smaller min", *c.min, *c.max);
        return "";
      });
}

Schema<TrackEdit> edit_schema() {
  return Schema<TrackEdit>("edit", "A change by hand")
      .add("action", &TrackEdit::kind, {.doc = "What is done with the track", .choices = kEditWords})
      .add("track", &TrackEdit::track, {.min = 1, .max = kLargestNumber, .doc = "Number of the track"})
      .add("frame", &TrackEdit::frame,
           {.min = 0, .max = kLargestNumber, .doc = "split: first frame of the new track"})
      .add("with", &TrackEdit::with,
           {.min = 0, .max = kLargestNumber, .doc = "join: number of the track that is added"});
}

// Long tracks are in several pieces in the file.
std::vector<Track> tracks_of(const Table& t) {
  const auto number = t.column("track"), frame = t.column("frame"), time = t.column("t_s"),
             x = t.column("x_px"), y = t.column("y_px"), mass = t.column("mass"), snr = t.column("snr");
  std::vector<Track> tracks;
  std::unordered_map<std::uint64_t, std::size_t> index_of;
  for (std::size_t i = 0; i < t.size(); ++i) {
    if (!(number[i] >= 1 && number[i] < kLargestNumber) || !(frame[i] >= 0 && frame[i] < kLargestNumber))
      throw Error(Errc::input, t.location(i), "track and frame must be positive numbers");
    const auto [at, is_new] = index_of.emplace(std::uint64_t(number[i]), tracks.size());
    if (is_new) tracks.push_back({std::uint64_t(number[i]), {}, false});
    std::vector<TrackPoint>& points = tracks[at->second].points;
    if (!points.empty() && std::uint64_t(frame[i]) <= points.back().frame)
      throw Error(Errc::input, t.location(i), "the frames of a track must increase");
    points.push_back({std::uint64_t(frame[i]), time[i], x[i], y[i], mass[i], snr[i]});
  }
  return tracks;
}

std::string provenance_comment(const TrackFolder& folder, const EditedFolder& e) {
  const auto used = std::count_if(e.tracks.begin(), e.tracks.end(), [](const auto& t) { return t.used(); });
  std::string out = fmt::format("# {} of {} tracks of {}, sha256 {}\n", used, e.tracks.size(),
                                track_files::kTracks, folder.sha256);
  const auto limit = [](const std::optional<double>& v) { return v ? fmt::format("{}", *v) : "any"; };
  for (const TrackCut& c : e.edits.cuts) {
    const TrackFeatureName& f = kTrackFeatureNames[std::size_t(c.feature)];
    out += fmt::format("# cut: {} from {} to {}{}{}\n", f.name, limit(c.min), limit(c.max),
                       f.unit.empty() ? "" : " ", f.unit);
  }
  for (const TrackEdit& d : e.edits.edits) {
    out += fmt::format("# edit: {} track {}", kEditWords[std::size_t(d.kind)], d.track);
    if (d.kind == TrackEditKind::split) out += fmt::format(" at frame {}", d.frame);
    if (d.kind == TrackEditKind::join) out += fmt::format(" with track {}", d.with);
    out += '\n';
  }
  return out;
}

}  // namespace

bool holds_tracks(const fs::path& folder) {
  std::error_code ec;
  return fs::is_regular_file(folder / track_files::kTracks, ec) &&
         fs::is_regular_file(folder / track_files::kSummary, ec);
}

TrackFolder read_track_folder(const fs::path& folder) {
  if (!holds_tracks(folder))
    throw Error(Errc::input, folder.string(),
                fmt::format("has no {} and {}; give a folder that faba track --result has written",
                            track_files::kTracks, track_files::kSummary));
  TrackFolder out;
  const fs::path summary = folder / track_files::kSummary;
  try {
    out.summary = parse_json(read_file(summary));
    if (out.summary.contains("image_size")) {
      out.width = out.summary["image_size"].at(0).get<int>();
      out.height = out.summary["image_size"].at(1).get<int>();
    }
    out.frame_s = out.summary.at("frame_s").get<double>();
    out.timed = out.summary.value("timed", true);
    if (const Json& um = out.summary.at("um_per_px"); um.is_number()) out.um_per_px = um.get<double>();
    if (const Json& speed = out.summary.at("speed"); speed.is_object())
      out.interval = std::max(1, speed.at("interval_frames").get<int>());
    out.drift_removed = out.summary.at("stage").at("removed").get<bool>();
  } catch (const Json::exception&) {
    throw Error(Errc::input, summary.string(), "is not the output of faba track --json");
  }
  if (!(out.frame_s > 0)) throw Error(Errc::input, summary.string(), "frame_s must be positive");
  out.sha256 = sha256_of(folder / track_files::kTracks);
  out.tracks = tracks_of(read_table(folder / track_files::kTracks));
  return out;
}

TrackEdits read_track_edits(const Document& d, const TrackFolder& tracks) {
  const Node root(d);
  for (const auto& [key, _] : root.json->items())
    if (key != "sha256" && key != "cut" && key != "edit")
      root.child(key).fail(fmt::format("unknown key \"{}\"; it must be one of sha256, cut, edit", key));
  if (root.has("sha256") && *root.child("sha256").json != tracks.sha256)
    root.child("sha256").fail(
        "the edits were made for other tracks; apply them to the result that they belong to, or edit the new "
        "tracks");
  TrackEdits e{tables_of(root, "cut", cut_schema()), tables_of(root, "edit", edit_schema())};
  for (std::size_t i = 0; i < e.cuts.size(); ++i)
    for (std::size_t k = 0; k < i; ++k)
      if (e.cuts[k].feature == e.cuts[i].feature)
        root.child("cut").item(i).fail("has the feature of another cut; give min and max in one of them");
  return e;
}

TrackEdits read_track_edits(const fs::path& folder, const TrackFolder& tracks) {
  const fs::path file = folder / track_files::kEdits;
  std::error_code ec;
  return fs::exists(file, ec) ? read_track_edits(read_toml(file), tracks) : TrackEdits{};
}

Json edits_document(const TrackEdits& edits, const TrackFolder& tracks) {
  Json j = {{"sha256", tracks.sha256}};
  for (const TrackCut& c : edits.cuts) j["cut"].push_back(cut_schema().to_json(c));
  for (const TrackEdit& e : edits.edits) {
    Json one = {{"action", kEditWords[std::size_t(e.kind)]}, {"track", e.track}};
    if (e.kind == TrackEditKind::split) one["frame"] = e.frame;
    if (e.kind == TrackEditKind::join) one["with"] = e.with;
    j["edit"].push_back(one);
  }
  return j;
}

EditedFolder apply_edits(const TrackFolder& folder, TrackEdits edits) {
  EditedFolder e;
  e.tracks = edited_tracks(folder.tracks, edits, folder.frame_s, folder.interval);
  e.edits = std::move(edits);
  return e;
}

std::string edited_tracks_csv(const TrackFolder& folder, const EditedFolder& edited) {
  std::string out = provenance_comment(folder, edited) + kTrackColumns;
  for (const EditedTrack& t : edited.tracks)
    if (t.used()) out += track_rows(t.track);
  return out;
}

std::string track_features_csv(const TrackFolder& folder, const EditedFolder& edited) {
  std::string out = provenance_comment(folder, edited) +
                    "track,first_frame,last_frame,speed_px_s,duration_s,points,displacement_px,path_px,"
                    "straightness,turning_deg_s,snr\n";
  for (const EditedTrack& t : edited.tracks) {
    if (!t.used()) continue;
    fmt::format_to(std::back_inserter(out), "{},{},{}", t.track.number, t.track.points.front().frame,
                   t.track.points.back().frame);
    for (const double v : t.features) out += std::isfinite(v) ? fmt::format(",{:.6g}", v) : ",";
    out += '\n';
  }
  return out;
}

Json edited_json(const TrackFolder& folder, const EditedFolder& edited) {
  const SelectedMotion m =
      motion_of(edited.tracks, folder.tracks, folder.frame_s, folder.interval, folder.drift_removed);
  Json j = folder.summary;
  j.erase("track_quality");  // is not known for tracks that were split or joined
  j.update(motion_json(m.summary, m.populations, folder.um_per_px));
  const auto number = [&](TrackFate fate) {
    return std::count_if(edited.tracks.begin(), edited.tracks.end(),
                         [&](const auto& t) { return t.fate == fate; });
  };
  j["edits"] = edits_document(edited.edits, folder);
  j["edited_tracks"] = {{"measured", folder.tracks.size()},
                        {"pass", number(TrackFate::passes)},
                        {"cut", number(TrackFate::cut)},
                        {"deleted", number(TrackFate::removed)},
                        {"kept", number(TrackFate::kept)}};
  return j;
}

}  // namespace faba
