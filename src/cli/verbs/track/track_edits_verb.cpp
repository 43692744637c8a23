// Application of edits to the result of a tracking.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "cli/output_file.h"
#include "cli/provenance.h"
#include "cli/verbs/track/track_verb.h"
#include "core/error.h"
#include "core/file.h"
#include "study/pages/tracks/track_folder.h"
#include "study/pages/tracks/track_output.h"

namespace faba::cli {
namespace {

namespace fs = std::filesystem;

// Options that a result does not permit: it was measured with other ones.
void check_edit_options(const TrackVerb& v, const Common& c) {
  if (v.videos.size() != 1)
    throw Error(Errc::usage, "--edits", "requires one folder, which faba track --result has written");
  for (const CLI::Option* option : c.verb->get_options()) {
    const std::string name = option->get_name();
    const bool allowed = option->get_positional() || name == "--edits" || name == "--out" ||
                         name == "--format" || name == "--per-track" || name == "--json" ||
                         name == "--quiet" || name == "--force" || name == "--threads";
    if (option->count() > 0 && !allowed)
      throw Error(Errc::usage, name, "has no effect with --edits, which reads tracks; omit it");
  }
  if (v.out.size() > 1) throw Error(Errc::usage, "--out", "may be given once with --edits");
  const fs::path folder = v.videos.front();
  std::vector<fs::path> inputs = {folder / track_files::kTracks, folder / track_files::kSummary,
                                  folder / track_files::kPerTrack, v.edits};
  for (const TrackTable& table : tables_of(v))
    check_output(table.file, extensions_of(table.format), v.force, inputs);
  check_output(v.per_track, {".csv"}, v.force, inputs);
  std::vector<fs::path> outputs = v.out;
  outputs.push_back(v.per_track);
  check_distinct(std::move(outputs));
}

// The CSV table of this program has comments with the edits; the readers of the others do not permit
// comments.
void write_edited(const TrackTable& table, const TrackFolder& folder, const EditedFolder& edited) {
  if (table.file.extension() == ".csv" && table.format <= TrackFormat::csv)
    return write_file(table.file, edited_tracks_csv(folder, edited));
  const auto out = track_output(table, {folder.width, folder.height, folder.um_per_px, folder.timed});
  for (const EditedTrack& t : edited.tracks)
    if (t.used()) out->write(t.track);
  out->complete();
}

}  // namespace

int apply_track_edits(const TrackVerb& v, const Common& c) {
  check_edit_options(v, c);
  const TrackFolder folder = read_track_folder(v.videos.front());
  const EditedFolder edited = apply_edits(folder, read_track_edits(read_toml(v.edits), folder));
  const std::vector<TrackTable> tables = tables_of(v);
  for (const TrackTable& table : tables) write_edited(table, folder, edited);
  if (!v.per_track.empty()) write_file(v.per_track, track_features_csv(folder, edited));
  nlohmann::ordered_json j = edited_json(folder, edited);
  j.erase("tables");
  if (!v.formats.empty()) j["tables"] = tables_json(tables, folder.um_per_px);
  if (c.json) {
    fmt::print("{}\n", j.dump());
    return 0;
  }
  if (c.quiet) return 0;
  const auto& n = j["edited_tracks"];
  fmt::print("tracks   {} of {} measured ({} cut, {} deleted by hand, {} kept by hand)\n",
             j["tracks"].get<std::uint64_t>(), folder.tracks.size(), n["cut"].get<int>(),
             n["deleted"].get<int>(), n["kept"].get<int>());
  if (j["speed"].is_object() && j["speed"]["mean_px_s"].is_number())
    fmt::print("speed    mean {:.4g} px/s\n", j["speed"]["mean_px_s"].get<double>());
  for (const auto& p : j["populations"])
    fmt::print("         {:.0f} % {}, median speed {:.4g} px/s\n", 100 * p["fraction"].get<double>(),
               p["motion"].get<std::string>(), p["speed_px_per_s"].get<double>());
  for (const TrackTable& table : tables)
    fmt::print("wrote    {}{}\n", table.file.string(), table_remark(table, folder.um_per_px));
  if (!v.per_track.empty()) fmt::print("wrote    {}\n", v.per_track.string());
  return 0;
}

}  // namespace faba::cli
