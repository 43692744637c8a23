#include "study/pages/tracks/track_output.h"

#include <fmt/format.h>

#include <functional>
#include <iterator>
#include <string>
#include <system_error>
#include <utility>

#include <nlohmann/json.hpp>

#include "core/error.h"
#include "core/file.h"
#include "core/h5/h5.h"

namespace faba {
namespace {

void remove_quietly(const std::filesystem::path& path) {
  std::error_code ignored;
  std::filesystem::remove(path, ignored);
}

/// The columns of a CSV table, and the lines of a track in it.
struct CsvLayout {
  const char* header;
  std::function<std::string(const Track&)> rows;
};

class CsvTracks final : public TrackOutput {
 public:
  CsvTracks(std::filesystem::path path, CsvLayout layout)
      : path_(std::move(path)), file_(temporary_name(path_), 0, path_), layout_(std::move(layout)) {
    file_.append(layout_.header);
  }
  ~CsvTracks() override {
    if (!complete_) remove_quietly(temporary_name(path_));
  }
  void write(const Track& track) override { file_.append(layout_.rows(track)); }
  void complete() override {
    file_.sync();
    file_.close();
    rename_complete(temporary_name(path_), path_);
    complete_ = true;
  }

 private:
  std::filesystem::path path_;
  OutputFile file_;
  CsvLayout layout_;
  bool complete_ = false;
};

// TrackMate takes x for z if there is no column z.
CsvLayout trackmate_layout(const std::optional<double>& um_per_px) {
  return {"track,frame,t_s,x,y,z,quality\n", [scale = um_per_px.value_or(1)](const Track& track) {
            std::string lines;
            for (const TrackPoint& p : track.points)
              fmt::format_to(std::back_inserter(lines), "{},{},{:.6f},{:.5f},{:.5f},0,{:.4g}\n", track.number,
                             p.frame, p.t_s, scale * p.x_px, scale * p.y_px, p.snr);
            return lines;
          }};
}

CsvLayout napari_layout() {
  return {"track_id,frame,y,x\n", [](const Track& track) {
            std::string lines;
            for (const TrackPoint& p : track.points)
              fmt::format_to(std::back_inserter(lines), "{},{},{:.3f},{:.3f}\n", track.number, p.frame,
                             p.y_px, p.x_px);
            return lines;
          }};
}

class H5Tracks final : public TrackOutput {
 public:
  H5Tracks(std::filesystem::path path, const TrackedVideo& video)
      : path_(std::move(path)), file_(H5File::create(temporary_name(path_))) {
    constexpr std::uint64_t kRows = 4096;
    for (const char* name : {"point", "track", "frame"})
      integers_.push_back(file_.table<std::uint64_t>(name, {}, kRows, 1, true));
    for (const char* name : {"t_s", "x_px", "y_px", "mass", "snr"})
      numbers_.push_back(file_.table<double>(name, {}, kRows, 1, true));
    // Dimension, coordinates and units, as netCDF programs read them.
    for (const auto& [name, units] : {std::pair{"point", "1"},
                                      {"track", "1"},
                                      {"frame", "1"},
                                      {"t_s", video.timed ? "s" : "frames"},
                                      {"x_px", "px"},
                                      {"y_px", "px"},
                                      {"mass", "px2"},
                                      {"snr", "1"}}) {
      file_.attribute(name, "units", std::string(units));
      if (name != std::string("point")) file_.name_dimensions(name, {"point"});
    }
    for (const char* name : {"x_px", "y_px", "mass", "snr"})
      file_.attribute(name, "coordinates", std::string("track frame t_s"));
    file_.attribute("/", "format", std::string("faba tracked 1"));
    file_.attribute("/", "width_px", double(video.width));
    file_.attribute("/", "height_px", double(video.height));
    if (video.um_per_px) file_.attribute("/", "um_per_px", *video.um_per_px);
    file_.begin_writing();
  }
  ~H5Tracks() override {
    if (!complete_) remove_quietly(temporary_name(path_));
  }
  void write(const Track& track) override {
    for (const TrackPoint& p : track.points) {
      const std::uint64_t point = integers_[0].rows();
      integers_[0].append<std::uint64_t>({&point, 1});
      integers_[1].append<std::uint64_t>({&track.number, 1});
      integers_[2].append<std::uint64_t>({&p.frame, 1});
      const double row[] = {p.t_s, p.x_px, p.y_px, p.mass, p.snr};
      for (std::size_t i = 0; i < numbers_.size(); ++i) numbers_[i].append<double>({&row[i], 1});
    }
  }
  void complete() override {
    file_.sync();
    integers_.clear();
    numbers_.clear();
    file_.close();
    rename_complete(temporary_name(path_), path_);
    complete_ = true;
  }

 private:
  std::filesystem::path path_;
  H5File file_;
  std::vector<H5Table> integers_, numbers_;
  bool complete_ = false;
};

TrackFormat resolved(const TrackTable& table) {
  if (table.format != TrackFormat::automatic) return table.format;
  if (table.file.extension() == ".csv") return TrackFormat::csv;
  return table.file.extension() == ".h5" ? TrackFormat::hdf5 : TrackFormat::automatic;
}

}  // namespace

std::string track_rows(const Track& track) {
  std::string lines;
  for (const TrackPoint& p : track.points)
    fmt::format_to(std::back_inserter(lines), "{},{},{:.6f},{:.3f},{:.3f},{:.4g},{:.4g}\n", track.number,
                   p.frame, p.t_s, p.x_px, p.y_px, p.mass, p.snr);
  return lines;
}

std::string per_track_csv(const std::vector<TrackScore>& scores) {
  std::string out =
      "track,first_frame,last_frame,points,duration_s,path_px,distance_px,links_tested,links_reproduced,"
      "score\n";
  for (const TrackScore& s : scores) {
    fmt::format_to(std::back_inserter(out), "{},{},{},{},{:.6f},{:.3f},{:.3f},{},{},", s.number,
                   s.first_frame, s.last_frame, s.points, s.duration_s, s.path_px, s.distance_px,
                   s.links_tested, s.links_reproduced);
    out += s.score ? fmt::format("{:.4f}\n", *s.score) : "\n";
  }
  return out;
}

std::unique_ptr<TrackOutput> track_output(const TrackTable& table, const TrackedVideo& video) {
  switch (resolved(table)) {
    case TrackFormat::csv:
      return std::make_unique<CsvTracks>(table.file, CsvLayout{kTrackColumns, track_rows});
    case TrackFormat::hdf5:
      return std::make_unique<H5Tracks>(table.file, video);
    case TrackFormat::trackmate:
      return std::make_unique<CsvTracks>(table.file, trackmate_layout(video.um_per_px));
    case TrackFormat::napari:
      return std::make_unique<CsvTracks>(table.file, napari_layout());
    case TrackFormat::automatic:
      break;
  }
  throw Error(Errc::usage, table.file.string(), "must end in .csv or .h5");
}

nlohmann::ordered_json tables_json(const std::vector<TrackTable>& tables,
                                   const std::optional<double>& um_per_px) {
  auto all = nlohmann::ordered_json::array();
  for (const TrackTable& t : tables) {
    const TrackFormat format = resolved(t);
    const bool um = format == TrackFormat::trackmate && um_per_px;
    nlohmann::ordered_json one = {{"file", t.file.string()},
                                  {"format", kTrackFormatWords[std::size_t(format)]},
                                  {"length_unit", um ? "um" : "px"}};
    const double scale = um_per_px.value_or(1);
    if (format == TrackFormat::napari) one["scale"] = {1.0, scale, scale};
    all.push_back(std::move(one));
  }
  return all;
}

std::string table_remark(const TrackTable& table, const std::optional<double>& um_per_px) {
  if (table.format == TrackFormat::trackmate)
    return um_per_px ? " (TrackMate, x and y in um)" : " (TrackMate, x and y in px: the scale is not known)";
  if (table.format != TrackFormat::napari) return "";
  return um_per_px ? fmt::format(" (napari: add_tracks(..., scale=(1, {0:.6g}, {0:.6g})) for um)", *um_per_px)
                   : " (napari: add_tracks(..., scale=(1, 1, 1)), px: the scale is not known)";
}

}  // namespace faba
