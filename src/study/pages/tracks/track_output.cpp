#include "study/pages/tracks/track_output.h"

#include <fmt/format.h>

#include <iterator>
#include <string>
#include <system_error>

#include "core/error.h"
#include "core/file.h"
#include "core/h5/h5.h"

namespace faba {
namespace {

void remove_quietly(const std::filesystem::path& path) {
  std::error_code ignored;
  std::filesystem::remove(path, ignored);
}

class CsvTracks final : public TrackOutput {
 public:
  explicit CsvTracks(std::filesystem::path path)
      : path_(std::move(path)), file_(temporary_name(path_), 0, path_) {
    file_.append(kTrackColumns);
  }
  ~CsvTracks() override {
    if (!complete_) remove_quietly(temporary_name(path_));
  }
  void write(const Track& track) override { file_.append(track_rows(track)); }
  void complete() override {
    file_.sync();
    file_.close();
    rename_complete(temporary_name(path_), path_);
    complete_ = true;
  }

 private:
  std::filesystem::path path_;
  OutputFile file_;
  bool complete_ = false;
};

class H5Tracks final : public TrackOutput {
 public:
  H5Tracks(std::filesystem::path path, const TrackedVideo& video)
      : path_(std::move(path)), file_(H5File::create(temporary_name(path_))) {
    constexpr std::uint64_t kRows = 4096;
    for (const char* name : {"track", "frame"})
      integers_.push_back(file_.table<std::uint64_t>(name, {}, kRows, 1, true));
    for (const char* name : {"t_s", "x_px", "y_px", "mass", "snr"})
      numbers_.push_back(file_.table<double>(name, {}, kRows, 1, true));
    file_.attribute("/", "format", std::string("faba tracked 1"));
    file_.attribute("/", "width_px", double(video.width));
    file_.attribute("/", "height_px", double(video.height));
    if (video.um_per_px > 0) file_.attribute("/", "um_per_px", video.um_per_px);
    file_.begin_writing();
  }
  ~H5Tracks() override {
    if (!complete_) remove_quietly(temporary_name(path_));
  }
  void write(const Track& track) override {
    for (const TrackPoint& p : track.points) {
      integers_[0].append<std::uint64_t>({&track.number, 1});
      integers_[1].append<std::uint64_t>({&p.frame, 1});
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

std::unique_ptr<TrackOutput> track_output(const std::filesystem::path& path, const TrackedVideo& video) {
  if (path.extension() == ".csv") return std::make_unique<CsvTracks>(path);
  if (path.extension() == ".h5") return std::make_unique<H5Tracks>(path, video);
  throw Error(Errc::usage, path.string(), "must end in .csv or .h5");
}

}  // namespace faba
