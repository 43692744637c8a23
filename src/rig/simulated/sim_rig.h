#pragma once
#include <deque>
#include <functional>
#include <memory>

#include "rig/rig.h"
#include "rig/simulated/cells_in_camera.h"
#include "sim/world.h"
#include "vision/render/microscope.h"

namespace faba {

/// A simulated microscope: steps the world from frame to frame and returns the observation of `delay_frames`
/// frames ago, as positions or as images. Frame 0 is the initial state. The first frames of a delayed camera
/// show the initial positions.
class SimRig final : public Rig {
 public:
  struct Params {
    int steps_per_frame = 1;
    double frame_period = 1.0 / 15;  ///< s
    int delay_frames = 0;
    double jitter = 0;  ///< s, standard deviation of the frame times; truncated at 0.4 frames
    /// Observations contain images and no positions. Needs a microscope.
    bool frames = false;
    std::shared_ptr<Microscope> microscope = {};  ///< null: no images
    Pool* pool = nullptr;  ///< renders the images; must outlive the rig; needed with a microscope
  };
  /// `world` must outlive the rig.
  SimRig(World& world, const Params& p);

  bool read(Observation& out) override;
  void write(const Command& c) override { world_.command(c.current); }
  void safe() noexcept override;
  void archive(Archive& a) override;
  const World& world() const { return world_; }
  /// Called before each step; if it returns false, read() stops and returns false.
  void before_steps(std::function<bool()> keep_running) { keep_running_ = std::move(keep_running); }

  /// Time of any past or future frame, s: an integer number of steps.
  double time_of(std::uint64_t frame) const;
  /// Image of the newest frame, without the delay; rendered once. Needs a microscope.
  ImageRef picture();
  /// Bit depth of the grey values; needs a microscope.
  int bits() const { return p_.microscope->bits(); }
  /// The same image in 16 bits, rendered at every call.
  const Image<std::uint16_t>& deep_picture();

 private:
  /// Observation of one frame.
  struct Seen {
    double t = 0;  ///< s
    std::vector<Detection> cells;
    ImageRef image;
  };
  std::uint64_t step_of(std::uint64_t frame) const;
  bool step_to(std::uint64_t frame);
  std::vector<Detection> detections() const;
  Exposure exposure();
  void archive_cells(Archive& a, std::vector<Detection>& cells) const;

  World& world_;
  Params p_;
  Frame frame_;
  CellsInCamera camera_;
  std::function<bool()> keep_running_;
  std::uint64_t next_ = 0;  ///< next frame of read()
  std::deque<Seen> seen_;   ///< the last delay + 1 frames, oldest first
  ImageRef newest_;         ///< cache of picture()
  Image<std::uint16_t> deep_;
};

}  // namespace faba
