#include "cli/study_job.h"

#include <fmt/format.h>

#include "core/error.h"

namespace faba::cli {

std::unique_ptr<StudyJob> study_job(const StudySource& source, bool needs_inputs) {
  if (source.verb == "identify") return identify_job(source, needs_inputs);
  if (source.verb == "calibrate") return calibrate_job(source, needs_inputs);
  if (source.verb == "compare-controllers") return controllers_job(source);
  if (source.verb == "tune") return tune_job(source);
  if (source.verb == "track") return track_job(source);
  if (source.verb == "activity") return activity_job(source);
  throw Error(
      Errc::usage, source.file.string(),
      fmt::format("the studies of `faba {}` cannot be planned; this command is for studies of identify, "
                  "calibrate, compare-controllers, tune, activity and track",
                  source.verb));
}

}  // namespace faba::cli
