#pragma once
#include <deque>
#include <memory>
#include <optional>

#include "rig/bench/camera_feed.h"
#include "rig/guard/guard_link.h"
#include "rig/rig.h"

namespace faba {

/// A camera and real coils. Frames come when the camera takes them; while none comes, or the decision on one
/// takes too long, the coils get no current. It begins disarmed: commands go nowhere until arm().
class BenchRig final : public Rig {
 public:
  struct Params {
    double camera_timeout = 2;  ///< s
    CameraFeed::Keep keep = CameraFeed::Keep::newest;
  };
  /// `coils` null: eyes without hands. Throws Error(device).
  BenchRig(std::shared_ptr<Camera> camera, std::unique_ptr<GuardLink> coils, const Params& p);
  ~BenchRig() override;

  /// The next frame is the first, of a live camera the next that comes: its time is 0, and delays are
  /// noted anew. Disarms.
  void begin();
  /// Throws Error(device) when the camera fails, gives no frame for too long, or the guard took the current
  /// away.
  bool read(Observation& out) override;
  void write(const Command& c) override;
  void safe() noexcept override;
  /// Throws Error(device) with the guard's reason when it will not.
  void arm();
  CameraFeed& feed() { return feed_; }
  std::uint64_t dropped() const { return feed_.dropped() - dropped_before_; }  ///< frames, since begin()
  GuardLink* coils() { return coils_.get(); }

  /// How long a frame took, s: of each, in order.
  struct Delay {
    double arrival;  ///< from mid-exposure to the program
    double command;  ///< from there until the device had the voltages; not a number when it never told
  };
  const std::vector<Delay>& delays() const { return delays_; }

 private:
  struct Asked {
    std::uint64_t number;
    double arrived;     ///< s, monotonic
    std::size_t frame;  ///< of delays_
  };
  void answered(const GuardReport& r);
  void check_guard();
  std::string and_the_coils() const;  ///< where they are, for the end of a message

  Params p_;
  CameraFeed feed_;
  std::unique_ptr<GuardLink> coils_;
  std::optional<double> began_;  ///< s, monotonic, of the first frame
  std::uint64_t first_ = 0;      ///< its number
  double arrived_ = 0;           ///< s, monotonic, when the newest came
  double frame_t_ = 0;           ///< s, monotonic, mid-exposure of the newest
  std::deque<Asked> asked_;      ///< not answered yet
  std::vector<Delay> delays_;
  std::uint64_t dropped_before_ = 0;
  bool armed_ = false, just_armed_ = false;
};

}  // namespace faba
