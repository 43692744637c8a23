#pragma once
#include <filesystem>
#include <memory>

#include "app/loop/loop.h"
#include "app/scenario/scenario.h"
#include "core/archive.h"
#include "rig/simulated/sim_rig.h"
#include "vision/flow/flow.h"

namespace faba {

/// A sink of a run directory: it can be cut back to a checkpoint and finished.
class RunSink : public Sink {
 public:
  /// Writes where it stands to a checkpoint, everything before that safely on the disk.
  virtual void checkpoint(Archive& a) = 0;
  /// Completes its files. With `keep`, what is needed to go on later is kept as well.
  virtual void finish(bool keep) = 0;
};

/// What sinks look at: the world's true state, where one is known, beside what the loop saw.
struct SinkContext {
  std::filesystem::path dir;
  const World* world;  ///< null on a bench
  std::shared_ptr<const Field> field;
  const Loop* loop;
  Frame frame;
  Scale scale;
  double frame_rate;  ///< Hz
  Record record;
  bool dose = false;                 ///< cells may stop responding during the run
  SimRig* rig = nullptr;             ///< the camera; null on a bench, where observations hold its pictures
  bool jitter = false;               ///< frames are not taken at regular times
  FlowRegistry::PartType flow = {};  ///< that flow.h5 is made with
  Pool* pool = nullptr;              ///< to make it with

  /// Time of the frame that was taken in this turn, s.
  double time_of(const Tick& t) const {
    if (!rig) return t.seen.t;
    return jitter ? rig->time_of(t.index) : double(t.index) / frame_rate;
  }
  /// What the camera saw then.
  ImageRef picture(const Tick& t) const { return rig ? rig->picture() : t.seen.image; }
  int bits() const { return rig ? rig->bits() : 8; }
};

/// Throws Error(usage) for a video that cannot be: what is better said before a run than after its first
/// frame.
void check_recording(const Record& record, const Frame& frame, double rate);

class Simulation;
/// What the sinks of a simulation of `s` look at. `dir`: where they write.
SinkContext sink_context(const Scenario& s, Simulation& simulation, Pool& pool,
                         const std::filesystem::path& dir);

// One function per sink; `resume` is null, or the archive to read its checkpoint from.

/// series.csv: one line per frame (docs/formats/run-directory.md).
std::unique_ptr<RunSink> series_sink(const SinkContext& c, Archive* resume);
/// tracks.h5: positions of all cells.
std::unique_ptr<RunSink> tracks_sink(const SinkContext& c, Archive* resume);
/// video.mp4 and, on request, video.avi: the drawn swarm, or with record.as_seen what the camera sees.
std::unique_ptr<RunSink> video_sink(const SinkContext& c, bool lossless, Archive* resume);
/// flow.h5: optical flow from frame to frame of what the camera sees (docs/formats/flow.md).
std::unique_ptr<RunSink> flow_sink(const SinkContext& c, Archive* resume);
/// commands.csv: on a bench, what each command was made from and what it was, exactly.
std::unique_ptr<Sink> commands_sink(const SinkContext& c);

}  // namespace faba
