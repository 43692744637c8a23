#pragma once
#include <optional>

#include "app/bench/open_bench.h"
#include "app/recording/session.h"

namespace faba {

/// One recorded step response.
struct RecordedResponse {
  std::filesystem::path dir;  ///< its run directory
  double exposure = 0;        ///< s that the sample had been in air when it began
  std::optional<Vec2> at_px;  ///< where the swarm was before it, in the picture; none when none was seen
  double cells = 0;           ///< of it
  std::uint64_t frames = 0, dropped = 0;
};

/// What is to be recorded.
struct StepResponseJob {
  Document scene;  ///< a scenario with [rig]; its controller, reference and duration do not count
  std::uint64_t seed = 1;
  std::string experiment;  ///< which drop; a number when empty
  RunOptions run;          ///< `out`: the study's directory; progress is told in ms of the whole schedule
  std::function<void(const RecordedResponse&)>
      done;  ///< called after each, whose directory is whole then but for a report
};

/// Takes the step responses of [rig.step_response], one after the other: a field drives the swarm to one
/// side, where it is looked for, and is then reversed while the camera records. Each has a run directory in
/// `run.out`, with the time in air in its scenario; `study.toml` beside them lists them for `faba activity`,
/// and those of earlier calls, after each of them anew. Throws Error(usage) for a scenario that does not fit;
/// Error(device); Error(interrupted) when asked to stop, after which what was recorded is whole.
std::vector<RecordedResponse> record_step_responses(const StepResponseJob& job);

}  // namespace faba
