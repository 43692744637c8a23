#pragma once
#include <deque>
#include <memory>
#include <optional>

#include "rig/bench/camera_feed.h"
#include "rig/guard/guard_link.h"
#include "rig/rig.h"

namespace faba {

/// A camera and real coils. The coils are de-energised while no frame arrives or a control cycle overruns.
/// The rig starts disarmed: commands are discarded until arm().
class BenchRig final : public Rig {
 public:
  struct Params {
    double camera_timeout = 2;  ///< s
    CameraFeed::Keep keep = CameraFeed::Keep::newest;
  };
  /// `coils` null: camera only. Throws Error(device).
  BenchRig(std::shared_ptr<Camera> camera, std::unique_ptr<GuardLink> coils, const Params& p);
  ~BenchRig() override;

  /// Starts a new run: the next frame (of a live camera, the next one taken) is frame 0 at time 0, and the
  /// recorded delays are cleared. Disarms.
  void begin();
  /// Throws Error(device) if the camera fails or times out, if the control cycle overran, or if the guard
  /// tripped.
  bool read(Observation& out) override;
  void write(const Command& c) override;
  void safe() noexcept override;
  /// Throws Error(device) with the guard's reason if it refuses.
  void arm();
  CameraFeed& feed() { return feed_; }
  std::uint64_t dropped() const { return feed_.dropped() - dropped_before_; }  ///< frames, since begin()
  GuardLink* coils() { return coils_.get(); }

  /// Delays of one frame, s.
  struct Delay {
    double arrival;  ///< from mid-exposure to arrival in the program
    double command;  ///< from arrival until the device had the voltages; NaN without an answer
  };
  const std::vector<Delay>& delays() const { return delays_; }

 private:
  struct Pending {
    std::uint64_t number;
    double arrived;     ///< s, monotonic
    std::size_t frame;  ///< index into delays_
  };
  void record_delay(const GuardReport& r);
  void check_guard();
  std::string coil_status() const;  ///< suffix of an error message

  Params p_;
  CameraFeed feed_;
  std::unique_ptr<GuardLink> coils_;
  std::optional<double> start_;     ///< s, monotonic, of the first frame
  std::uint64_t first_number_ = 0;  ///< number of the first frame
  double arrived_ = 0;              ///< s, monotonic, arrival of the newest frame
  double frame_t_ = 0;              ///< s, monotonic, mid-exposure of the newest frame
  std::deque<Pending> pending_;     ///< commands without an answer yet
  std::vector<Delay> delays_;
  std::uint64_t dropped_before_ = 0;
  bool armed_ = false, just_armed_ = false;
};

}  // namespace faba
