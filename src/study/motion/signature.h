#pragma once
#include <array>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "core/archive.h"
#include "core/vec.h"
#include "study/data/flow_source.h"

namespace faba {

/// Flow of one pair of frames above the threshold by direction: sums over the pixels, px of the video times
/// its px^2.
struct DirectionSums {
  static constexpr int kSectors = 24;    ///< of 15 degrees; a cone of +-45 degrees has six
  std::array<float, kSectors> amount{};  ///< of |u| + |v|
  std::array<float, kSectors> u{}, v{};
  void archive(Archive& a) {
    for (std::array<float, kSectors>* sums : {&amount, &u, &v})
      for (float& sum : *sums) a& sum;
  }
};

/// The activity of a video, pair by pair (theory A16).
class Signature {
 public:
  /// Sectors are counted from `zero_deg` (image frame: 0 right, 90 down). Flows below `threshold_px` are
  /// ignored.
  Signature(double threshold_px, double zero_deg) : threshold_px_(threshold_px), zero_deg_(zero_deg) {}

  /// Adds the flow of a pair; `px_side` is FlowSource::shrink().
  void add(const FlowPair& pair, int px_side);

  std::size_t size() const { return sums_.size(); }
  double threshold_px() const { return threshold_px_; }
  double t0_s(std::size_t k) const { return t0_s_[k]; }
  double t1_s(std::size_t k) const { return t1_s_[k]; }
  double t_s(std::size_t k) const { return (t0_s_[k] + t1_s_[k]) / 2; }

  bool still() const;  ///< whether no flow is above the threshold
  /// The direction nearest to `deg` whose cone consists of complete sectors.
  double nearest_deg(double deg) const;
  /// Sum of |u| + |v| over the pixels whose flow is within 45 degrees of `deg`, as in the thesis.
  double amount(std::size_t k, double deg) const;
  /// Sum of the flow along `deg` within 45 degrees of it, minus that within 45 degrees of the opposite: the
  /// expectation for noise without a direction is zero.
  double along(std::size_t k, double deg) const;
  /// Sum of all flows, and of their speeds.
  Vec2 sum(std::size_t k) const;
  double speed(std::size_t k) const;
  void archive(Archive& a) { a& threshold_px_& zero_deg_& t0_s_& t1_s_& sums_; }

 private:
  /// Calls take(sector) for the six sectors about `deg`.
  template <class Take>
  void each_in_cone(double deg, Take&& take) const;
  double threshold_px_, zero_deg_;
  std::vector<double> t0_s_, t1_s_;
  std::vector<DirectionSums> sums_;
};

/// Speeds due to noise, px per pair.
struct NoiseLevel {
  double threshold_px = 0;  ///< 99 % quantile of the speed in the quietest pairs
  bool quiet = true;        ///< false: the quietest pairs have over half of the motion of the busiest
};
/// From about 48 pairs spread over a video: the median of the threshold in the quietest tenth of them. Throws
/// the errors of FlowSource.
NoiseLevel noise_level(const std::filesystem::path& video, const FlowSourceOptions& options,
                       const std::function<void(std::uint64_t, std::uint64_t)>& progress);

}  // namespace faba
