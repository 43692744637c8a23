#include "study/tracks/spot_sums.h"

#include <algorithm>
#include <utility>

#include "core/statistics.h"
#include "vision/drop/drop_edge.h"

namespace faba {
namespace {

constexpr std::size_t kMostSnr = 200000;  // spots

double searched_area(const PixelRegion& region, const std::optional<DropMask>& drop) {
  double area = 0;
  for (int row = 0; row < region.height; ++row)
    for (int col = 0; col < region.width; ++col) area += !excludes(drop, region.col + col, region.row + row);
  return area;
}

}  // namespace

void SpotSums::take(const std::vector<Spot>& spots) {
  ++frames_;
  spots_ += double(spots.size());
  for (const Spot& s : spots) {
    elongation_ += s.elongation;
    place_sd_ += s.sd_px;
    if (snr_.size() < kMostSnr) snr_.push_back(s.snr);
  }
}

void SpotSums::describe(TrackDetection& d) const {
  d.spots_per_frame = spots_ / std::max(1.0, frames_);
  if (!snr_.empty()) d.median_snr = median(snr_);
  if (spots_ == 0) return;
  d.mean_place_sd_px = place_sd_ / spots_;
  d.mean_elongation = elongation_ / spots_;
}

std::vector<Spot> spots_in(const GrayF& frame, const Detector& detector, const TrackSurvey& s) {
  const GrayF part = cropped(frame, s.region);
  std::vector<Spot> spots =
      s.temporal ? detector.find(part)
                 : Detector(spatial_background(part, s.smoothing_px), detector.options()).find(part);
  for (Spot& spot : spots) {
    spot.x_px += s.region.col;
    spot.y_px += s.region.row;
  }
  return spots;
}

TrackDetection detection_of(const TrackOptions& o, const TrackSurvey& s, const Detector& detector,
                            const std::optional<DropMask>& drop) {
  std::vector<float> noise = s.background.noise_sd.px;
  TrackDetection d;
  d.size_px = s.size_px;
  d.size_given = o.size_px > 0;
  d.two_sizes = s.two_sizes;
  d.polarity = s.polarity;
  d.temporal = s.temporal;
  d.background_frames = s.background.frames;
  d.noise_grey = double(robust_spread_low(noise).median);
  d.threshold_snr = detector.threshold_sd();
  d.threshold_given = o.threshold_sd > 0;
  d.stationary_spots = s.stationary_spots;
  d.coding = s.coding;
  d.drop = drop;
  d.region = o.region;
  d.searched_px2 = searched_area(s.region, drop);
  return d;
}

std::optional<DropMask> drop_of(const TrackOptions& o, const TrackSurvey& s) {
  if (!o.inside_drop) return {};
  DropEdgeOptions edge_options;
  edge_options.name = o.video.string();
  const DropEdge edge = find_drop_edge(s.first, edge_options);
  return DropMask{edge.centre_image, edge.radius_px, edge.centre_side_inside, s.size_px};
}

}  // namespace faba
