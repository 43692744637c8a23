#pragma once
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>

#include "app/loop/loop.h"
#include "app/scenario/scenario.h"
#include "core/archive.h"
#include "sim/world.h"
#include "vision/flow/flow.h"
#include "vision/image/image.h"

namespace faba {

/// A sink of a run directory: it can be truncated to a checkpoint and finished.
class RunSink : public Sink {
 public:
  /// Writes where it stands to a checkpoint, everything before that safely on the disk.
  virtual void checkpoint(Archive& a) = 0;
  /// Completes its files. With `keep`, what is needed to resume later is kept as well.
  virtual void finish(bool keep) = 0;
};

/// Where a run's pictures and their times come from: a simulated camera or that of a bench.
class FrameSource {
 public:
  virtual ~FrameSource() = default;
  /// Time of the frame that was taken in this turn, s.
  virtual double time_of(const Tick& t) const = 0;
  /// Time of the frame of any turn, s, also of one to come; empty where only the clock knows.
  virtual std::optional<double> planned_time(std::uint64_t turn) const = 0;
  /// What the camera saw in this turn, 8 bits.
  virtual ImageRef picture(const Tick& t) const = 0;
  /// Bits of the camera's grey values, 8 or 16.
  virtual int bits() const = 0;
  /// The newest picture in 16 bits; only where bits() is 16.
  virtual const Image<std::uint16_t>& deep_picture() const = 0;
};

/// What sinks look at beside the tick.
struct SinkContext {
  std::filesystem::path dir;
  std::shared_ptr<FrameSource> frames;
  std::shared_ptr<const Field> field;
  Frame frame;
  Scale scale;
  double frame_rate;  ///< Hz
  Record record;
  bool dose = false;                 ///< cells may stop responding during the run
  bool jitter = false;               ///< frames are not taken at regular times
  FlowRegistry::PartType flow = {};  ///< that flow.h5 is made with
  Pool* pool = nullptr;              ///< to make it with
  /// The simulated truth; null on a bench, whose recording has no columns and tracks of it.
  const World* truth = nullptr;
  /// Draws the swarm as it is in this turn, for people; empty where a video shows what the camera sees.
  std::function<RgbImage(const Tick&)> draw = {};
};

/// Throws Error(usage) for a video that cannot be: what is better said before a run than after its first
/// frame.
void check_recording(const Record& record, const Frame& frame, double rate);

class Simulation;
/// What the sinks of a simulation of `s` look at. `dir`: where they write.
SinkContext sink_context(const Scenario& s, Simulation& simulation, Pool& pool,
                         const std::filesystem::path& dir);

// One function per sink; `resume` is null, or the archive to read its checkpoint from.

/// tracks.h5: positions of all cells. Needs the truth.
std::unique_ptr<RunSink> tracks_sink(const SinkContext& c, Archive* resume);
/// video.mp4 and, on request, video.avi: the drawn swarm, or what the camera sees where nothing is drawn.
std::unique_ptr<RunSink> video_sink(const SinkContext& c, bool lossless, Archive* resume);
/// flow.h5: optical flow from frame to frame of what the camera sees (docs/formats/flow.md).
std::unique_ptr<RunSink> flow_sink(const SinkContext& c, Archive* resume);
/// commands.csv: on a bench, what each command was made from and what it was, exactly.
std::unique_ptr<RunSink> commands_sink(const SinkContext& c);

}  // namespace faba
