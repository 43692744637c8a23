#pragma once
#include <array>
#include <cstddef>
#include <string_view>
#include <vector>

#include "vision/cells/tracker.h"

namespace faba {

/// A property of a track by which tracks are selected.
enum class TrackFeature : std::size_t {
  speed,
  duration,
  points,
  displacement,
  path,
  straightness,
  turning,
  snr
};
inline constexpr std::size_t kTrackFeatures = 8;

/// Name and unit, as in files: lengths are in px, because the scale may change.
struct TrackFeatureName {
  std::string_view name;  ///< "speed"
  std::string_view unit;  ///< "px/s"; empty: none
};
inline constexpr std::array<TrackFeatureName, kTrackFeatures> kTrackFeatureNames{{{"speed", "px/s"},
                                                                                  {"duration", "s"},
                                                                                  {"points", ""},
                                                                                  {"displacement", "px"},
                                                                                  {"path", "px"},
                                                                                  {"straightness", ""},
                                                                                  {"turning", "deg/s"},
                                                                                  {"snr", ""}}};

/// Values of one track, in the order of TrackFeature; NaN: not defined for it.
using TrackFeatures = std::array<double, kTrackFeatures>;

/// `interval`: number of frames of the displacements of which speed and turning are the means, as in the
/// summary of all tracks; a track that is shorter has the speed between its ends, and no turning.
/// straightness: displacement over path, 0 to 1; path: sum of the distances of consecutive detections;
/// turning: mean angle between consecutive displacements over their time; snr: mean signal-to-noise ratio.
TrackFeatures features_of(const Track& track, double frame_s, int interval);

}  // namespace faba
