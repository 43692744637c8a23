#pragma once
#include <deque>
#include <functional>
#include <memory>

#include "rig/rig.h"
#include "rig/simulated/cells_in_camera.h"
#include "sim/world.h"
#include "vision/render/microscope.h"

namespace faba {

/// A simulated microscope: steps the world from frame to frame and hands out what the camera saw `delay`
/// frames ago, as positions or as pictures. Frame 0 is the world as it was placed. Before that the swarm is
/// taken to have been at rest, so that the first frames of a delayed camera show it where it started.
class SimRig final : public Rig {
 public:
  struct Params {
    int steps_per_frame = 1;
    double frame_period = 1.0 / 15;  ///< s
    int delay_frames = 0;
    double jitter = 0;  ///< s, sd of the frames' times about the regular ones; cut at 0.4 frames
    /// Observations hold pictures and no positions: a camera knows no cells. Needs a microscope.
    bool frames = false;
    std::shared_ptr<Microscope> microscope = {};  ///< null: no pictures
    Pool* pool = nullptr;  ///< that renders; outlives the rig; needed with a microscope
  };
  /// `world` outlives the rig.
  SimRig(World& world, const Params& p);

  bool read(Observation& out) override;
  void write(const Command& c) override { world_.command(c.current); }
  void safe() noexcept override;
  void archive(Archive& a) override;
  const World& world() const { return world_; }
  /// Asked before each step: when it says no read() gives up the frame it is at, and with it the run.
  void before_steps(std::function<bool()> keep_running) { keep_running_ = std::move(keep_running); }

  /// Time of a frame, s, whether it was made already or not: a whole number of steps.
  double time_of(std::uint64_t frame) const;
  /// The newest frame as the camera sees it, before any delay; rendered once. Needs a microscope.
  ImageRef picture();
  /// Bits of the camera's grey values; needs a microscope.
  int bits() const { return p_.microscope->bits(); }
  /// The same in 16 bits, rendered at every call.
  const Image<std::uint16_t>& deep_picture();

 private:
  /// What the camera saw in one frame.
  struct Seen {
    double t = 0;  ///< s
    std::vector<Detection> cells;
    ImageRef image;
  };
  std::uint64_t step_of(std::uint64_t frame) const;
  bool step_to(std::uint64_t frame);
  std::vector<Detection> look() const;
  Exposure exposure();
  void archive_cells(Archive& a, std::vector<Detection>& cells) const;

  World& world_;
  Params p_;
  Frame frame_;
  CellsInCamera camera_;
  std::function<bool()> keep_running_;
  std::uint64_t next_ = 0;  ///< frame that read() will make
  std::deque<Seen> seen_;   ///< the last delay + 1 frames, oldest first
  ImageRef newest_;         ///< picture(), once somebody asked for it
  Image<std::uint16_t> deep_;
};

}  // namespace faba
