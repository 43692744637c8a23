#pragma once
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>

#include "app/loop/loop.h"
#include "app/scenario/scenario.h"
#include "app/sinks/kept_frames.h"
#include "core/archive.h"
#include "sim/world.h"
#include "vision/flow/flow.h"
#include "vision/image/image.h"

namespace faba {

/// A sink of a run directory, with checkpoints.
class RunSink : public Sink {
 public:
  /// Syncs its files and writes their state to a checkpoint.
  virtual void checkpoint(Archive& a) = 0;
  /// Whether a checkpoint in this cycle leaves the content of its files as it is without one.
  virtual bool seamless() const { return true; }
  /// Completes its files. `keep`: also keep the files that are needed to resume.
  virtual void finish(bool keep) = 0;
};

/// Source of the pictures of a run and their times: a simulated camera or that of a bench.
class FrameSource {
 public:
  virtual ~FrameSource() = default;
  /// Time of the frame taken in this cycle, s.
  virtual double time_of(const Tick& t) const = 0;
  /// Time of the frame of any cycle, s, also of a future one; empty if it is not known in advance.
  virtual std::optional<double> planned_time(std::uint64_t cycle) const = 0;
  /// The picture of the camera in this cycle, 8 bits.
  virtual ImageRef picture(const Tick& t) const = 0;
  /// Bits of the camera's grey values, 8 or 16.
  virtual int bits() const = 0;
  /// The newest picture in 16 bits; only if bits() is 16.
  virtual const Image<std::uint16_t>& deep_picture() const = 0;
};

/// Data for sinks in addition to the Tick.
struct SinkContext {
  std::filesystem::path dir;
  std::shared_ptr<FrameSource> frames;
  std::shared_ptr<const Field> field;
  Frame frame;
  Scale scale;
  std::optional<double> um_per_px;  ///< empty: `scale` is nominal, and lengths are stated in px
  double frame_rate;                ///< Hz
  Record record;
  FrameRange recorded = {};          ///< frames that the sinks get
  bool dose = false;                 ///< cells may stop responding during the run
  bool jitter = false;               ///< frames are not taken at regular times
  FlowRegistry::PartType flow = {};  ///< method of flow.h5
  Pool* pool = nullptr;              ///< threads for flow.h5
  /// The simulated ground truth; null on a bench, whose recording has no true_* columns and no tracks.
  const World* truth = nullptr;
  /// Draws the swarm in this cycle; empty if videos show what the camera sees.
  std::function<void(const Tick&, RgbImage& picture)> draw = {};
  /// Gets the frames for the report from the first video; null if the length of the run is not known.
  std::shared_ptr<KeptFrames> kept = {};
};

/// Throws Error(usage) for videos that cannot be written, to report this before a run.
void check_recording(const Record& record, const Frame& frame, double rate);

class Simulation;
/// What the rows of the series of a simulation of `s` need, without a run directory and drawings.
SinkContext series_context(const Scenario& s, Simulation& simulation, Pool& pool);
/// Context of the sinks of a simulation of `s`. `dir`: run directory.
SinkContext sink_context(const Scenario& s, Simulation& simulation, Pool& pool,
                         const std::filesystem::path& dir);

// One function per sink; `resume` is null, or the archive to read its checkpoint from.

/// tracks.h5: positions of all cells. Needs ground truth.
std::unique_ptr<RunSink> tracks_sink(const SinkContext& c, Archive* resume);
/// video.mp4, or video.avi if `lossless`: the drawn swarm, or the camera pictures if there is no drawing.
std::unique_ptr<RunSink> video_sink(const SinkContext& c, bool lossless, Archive* resume);
/// flow.h5: optical flow between camera frames (docs/formats/flow.md).
std::unique_ptr<RunSink> flow_sink(const SinkContext& c, Archive* resume);
/// commands.csv: on a bench, the inputs of each command other than pictures, and the command, with full
/// precision.
std::unique_ptr<RunSink> commands_sink(const SinkContext& c);

}  // namespace faba
