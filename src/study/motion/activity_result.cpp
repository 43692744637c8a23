#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "study/motion/activity.h"

namespace faba {
namespace {

constexpr double kSameRate = 0.01;  // relative difference of frame periods

void fit_exposure_lines(ActivityResult& r) {
  std::vector<ExposureValue> peaks, means, per_cell;
  std::vector<ExposureResponse> responses;
  for (const VideoActivity& a : r.videos) {
    if (!a.input.exposure_s) continue;
    responses.push_back({*a.input.exposure_s, a.responds});
    means.push_back({*a.input.exposure_s, a.mean_amount, a.input.experiment});
    if (const auto value = activity_per_cell(a))
      per_cell.push_back({*a.input.exposure_s, *value, a.input.experiment});
  }
  r.cutoff = response_cutoff(responses);
  // A peak of a sample that no longer responds is due to noise.
  for (const VideoActivity& a : r.videos)
    if (a.input.exposure_s && has_peak(a) && (!r.cutoff || *a.input.exposure_s < r.cutoff->cutoff_s))
      peaks.push_back({*a.input.exposure_s, a.fit.peak_s - a.input.from_s, a.input.experiment});
  r.peak_line = mixed_line(peaks);
  r.peak_line_pooled = pooled_line(peaks);
  r.mean_line = mixed_line(means);
  r.mean_line_pooled = pooled_line(means);
  r.per_cell_line = mixed_line(per_cell);
  r.per_cell_line_pooled = pooled_line(per_cell);
  const double frame_s = r.videos.front().frame_s;
  if (std::all_of(r.videos.begin(), r.videos.end(),
                  [&](const VideoActivity& a) { return std::fabs(a.frame_s / frame_s - 1) < kSameRate; }))
    r.frame_s = frame_s;
}

}  // namespace

std::optional<double> activity_per_cell(const VideoActivity& a) {
  if (!a.visible_cells || !(*a.visible_cells > 0)) return {};
  return a.mean_amount / *a.visible_cells;
}

std::vector<Warning> all_warnings(const ActivityResult& r) {
  std::vector<Warning> all;
  for (const VideoActivity& a : r.videos)
    for (Warning w : a.warnings) {
      if (r.videos.size() > 1) w.evidence = fmt::format("{}: {}", a.input.file.string(), w.evidence);
      all.push_back(std::move(w));
    }
  return all;
}

std::optional<ChangePoint> onset_of(const VideoActivity& a) {
  if (!a.response || !a.response->responds) return {};
  return a.response->change;
}

std::optional<Measured> speed_um_s(const VideoActivity& a) {
  if (!a.um_per_px || !a.response || !a.response->speed_px_s) return {};
  constexpr double k90 = 1.645;  // quantile of the normal distribution for a 90 % interval
  const Measured& px = *a.response->speed_px_s;
  const double um = *a.um_per_px, of_scale = k90 * a.scale.standard_error.value_or(0) * px.value;
  const auto limit = [&](double of_px, double side) {
    return um * px.value + side * std::hypot(um * (of_px - px.value), of_scale);
  };
  return Measured{um * px.value, {limit(px.ci90[0], -1), limit(px.ci90[1], 1)}};
}

bool has_peak(const VideoActivity& a) { return a.fit.good && a.fit.amplitude > a.fit.offset; }

ActivityResult activity_result(std::vector<VideoActivity> videos) {
  ActivityResult r;
  r.videos = std::move(videos);
  fit_exposure_lines(r);
  return r;
}

}  // namespace faba
