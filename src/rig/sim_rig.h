#pragma once
#include <deque>
#include <functional>

#include "rig/rig.h"
#include "sim/world.h"

namespace faba {

/// A simulated microscope: steps the world from frame to frame and hands out what the camera saw `delay`
/// frames ago. Frame 0 is the world as it was placed. Before that the swarm is taken to have been at rest, so
/// that the first frames of a delayed camera show it where it started.
class SimRig final : public Rig {
 public:
  struct Params {
    int steps_per_frame = 1;
    double frame_period = 1.0 / 15;  ///< s
    int delay_frames = 0;
  };
  /// `world` outlives the rig.
  SimRig(World& world, const Params& p);

  bool read(Observation& out) override;
  void write(const Command& c) override { world_.command(c.current); }
  void safe() noexcept override;
  void archive(Archive& a) override;
  const World& world() const { return world_; }
  /// Asked between steps: when it says yes read() gives up the frame it is at, and with it the run.
  void give_up_when(std::function<bool()> asked) { give_up_ = std::move(asked); }

 private:
  std::vector<Detection> look() const;

  World& world_;
  Params p_;
  Frame frame_;
  std::function<bool()> give_up_;
  std::uint64_t next_ = 0;                   ///< frame that read() will make
  std::deque<std::vector<Detection>> seen_;  ///< the last delay + 1 frames, oldest first
};

}  // namespace faba
