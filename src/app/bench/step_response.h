#pragma once
#include <optional>

#include "app/bench/open_bench.h"
#include "app/recording/session.h"

namespace faba {

/// One recorded step response.
struct RecordedResponse {
  std::filesystem::path dir;  ///< its run directory
  double exposure = 0;        ///< air exposure time of the sample at its start, s
  std::optional<Vec2>
      at_px;         ///< image position of the swarm before the reversal; empty if no swarm was detected
  double cells = 0;  ///< number of cells of the swarm
  std::uint64_t frames = 0, dropped = 0;
  double reversal = 0;  ///< s, time of the field reversal in the video, which has no gaps for dropped frames
};

/// Options of record_step_responses().
struct StepResponseJob {
  Document scene;  ///< a scenario with [rig]; its controller, reference and duration are not used
  std::uint64_t seed = 1;
  std::string experiment;     ///< name of the drop; empty: a number
  RunOptions run;             ///< `out`: the study's directory; progress is in ms of the schedule
  BenchDevices devices = {};  ///< that are open already
  std::function<void(const RecordedResponse&)>
      done;  ///< called after each; its directory is then complete except for a report
};

/// Throws Error(usage) if a scenario is not suitable for step responses, such as for a field that the coils
/// cannot produce.
void check_step_response(const Document& scene);

/// Note that `every` is shorter than one response; empty if it is not, or 0, or if there is only one
/// response.
std::string schedule_note(const StepResponseParams& p);

/// Records the step responses of [rig.step_response]: a field drives the swarm to one side, where its
/// position is measured, and is then reversed while the camera records. Each response has a run directory in
/// `run.out`, with the air exposure time in its scenario. `study.toml` in the same folder lists them,
/// including those of earlier calls, for `faba activity`; it is updated after each response. Throws
/// Error(usage) for an unsuitable scenario; Error(device); Error(interrupted) if stopped, with all finished
/// responses complete.
std::vector<RecordedResponse> record_step_responses(const StepResponseJob& job);

}  // namespace faba
