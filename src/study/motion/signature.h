#pragma once
#include <array>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "core/vec.h"
#include "study/data/flow_source.h"

namespace faba {

/// What the flow of one pair of frames holds above the threshold, sorted by direction: sums over the pixels,
/// px of the video times its px^2.
struct DirectionSums {
  static constexpr int kSectors = 24;    ///< of 15 degrees, so that a cone of +-45 degrees is six of them
  std::array<float, kSectors> amount{};  ///< of |u| + |v|
  std::array<float, kSectors> u{}, v{};
};

/// The activity of a video, pair by pair (theory A16).
class Signature {
 public:
  /// Sectors are counted from `zero_deg` (image frame: 0 right, 90 down). `threshold_px`: flows of less are
  /// left out.
  Signature(double threshold_px, double zero_deg) : threshold_px_(threshold_px), zero_deg_(zero_deg) {}

  /// Adds the flow of a pair; `px_side` as FlowSource::shrink.
  void add(const FlowPair& pair, int px_side);

  std::size_t size() const { return sums_.size(); }
  double threshold_px() const { return threshold_px_; }
  double t0_s(std::size_t k) const { return t0_s_[k]; }
  double t1_s(std::size_t k) const { return t1_s_[k]; }
  double t_s(std::size_t k) const { return (t0_s_[k] + t1_s_[k]) / 2; }

  bool still() const;  ///< whether nothing is above the threshold in any pair
  /// The direction nearest to `deg` whose cone is whole sectors.
  double nearest_deg(double deg) const;
  /// Sum of |u| + |v| over the pixels whose flow is within 45 degrees of `deg`, as the thesis has it.
  double amount(std::size_t k, double deg) const;
  /// Sum of the flow along `deg` within 45 degrees of it, less that within 45 degrees of the opposite: noise
  /// without a direction adds nothing in the mean.
  double along(std::size_t k, double deg) const;
  /// Sum of all flow, and of its speed.
  Vec2 sum(std::size_t k) const;
  double speed(std::size_t k) const;

 private:
  /// Calls take(sector) for the six about `deg`.
  template <class Take>
  void each_in_cone(double deg, Take&& take) const;
  double threshold_px_, zero_deg_;
  std::vector<double> t0_s_, t1_s_;
  std::vector<DirectionSums> sums_;
};

/// Speeds that noise alone gives, px per pair.
struct NoiseLevel {
  double threshold_px = 0;  ///< 99 % of the pixels are slower in the quietest pairs
  bool quiet =
      true;  ///< false: even the quietest pairs have half the motion of the busiest, and are no measure
};
/// From some 48 pairs spread over a video: the median of the threshold in the quietest tenth of them. Throws
/// as FlowSource.
NoiseLevel noise_level(const std::filesystem::path& video, const FlowSourceOptions& options, Pool& pool,
                       const std::function<void(std::uint64_t, std::uint64_t)>& progress);

}  // namespace faba
