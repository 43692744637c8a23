#include "study/tracks/cell_count.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "study/data/run_video.h"
#include "study/data/series.h"
#include "vision/flow/flow_file.h"

namespace faba {
namespace {

constexpr std::int64_t kFramesCounted = 25;  // at most

// Number of visible cells recorded by the simulation.
std::optional<double> counted_by_run(const std::filesystem::path& run, const VideoPart& part) {
  const Series series = read_series(run / "series.csv");
  const auto counts = series.find("visible_count"), times = series.column("t_s");
  double sum = 0, n = 0;
  for (std::size_t i = 0; i < counts.size(); ++i)
    if (std::isfinite(counts[i]) && part.holds(times[i])) {
      sum += counts[i];
      n += 1;
    }
  return n > 0 ? std::optional(sum / n) : std::nullopt;
}

}  // namespace

CellCount::CellCount(const std::filesystem::path& path, const VideoPart& part, unsigned threads)
    : part_(part), threads_(threads) {
  if (is_run(path) && !has_camera_video(path)) {
    of_run_ = counted_by_run(path, part);
    return;
  }
  const std::filesystem::path video = run_video(path).file;
  if (FlowFileReader::recognises(video)) return;
  video_ = video;
  options_.video = video;
  options_.part = part;
  options_.threads = threads;
}

FrameInspector CellCount::survey() {
  if (!reads_frames()) return {};
  surveyor_ = std::make_unique<TrackSurveyor>(options_);
  return surveyor_->inspector();
}

void CellCount::end_survey() {
  if (!surveys_frames()) return;
  Pool pool(threads_);
  // The number of bits and the frame rate have no effect here.
  survey_ = surveyor_->result(8, true, pool, SurveyScope::input);
  surveyor_.reset();
  if (survey_.temporal)
    detector_ =
        std::make_unique<Detector>(std::move(survey_.background), detector_options(options_, survey_, {}));
  survey_.background = {};
  survey_.first = {};
  step_ = std::max<std::int64_t>(1, (survey_.frames + kFramesCounted - 1) / kFramesCounted);
}

FrameInspector CellCount::count() {
  if (!reads_frames()) return {};
  return {[this](double) { return frames_++ % step_ == 0; },
          [this](const GrayF& frame) -> std::function<void()> {
            std::size_t& spots = counts_.emplace_back();
            return [this, &spots, kept = std::make_shared<GrayF>(frame)] { spots = spots_in(*kept); };
          }};
}

std::size_t CellCount::spots_in(GrayF& frame) const {
  make_finite(frame);
  if (detector_) return detector_->find(frame).size();
  const Detector of_frame(spatial_background(frame, survey_.smoothing_px),
                          detector_options(options_, survey_, {}));
  return of_frame.find(frame).size();
}

void CellCount::read(const FrameInspector& inspector, const std::function<void()>& check) const {
  inspect_video(video_, part_, inspector, threads_, [&](auto, auto) { check(); });
}

std::optional<double> CellCount::mean() const {
  if (!reads_frames()) return of_run_;
  if (counts_.empty()) return {};
  double sum = 0;
  for (const std::size_t n : counts_) sum += double(n);
  return sum / double(counts_.size());
}

}  // namespace faba
