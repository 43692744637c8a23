#include "server/bench/bench_recordings.h"

#include <fmt/format.h>

#include "core/error.h"

namespace faba {

void keep_recording(ExperimentStore& experiments, const BenchRecording& r) {
  if (r.experiment.empty()) return;
  try {
    Json video = {{"file", r.path.lexically_relative(experiments.folder(r.experiment)).string()}};
    if (!r.drop.empty()) video["drop"] = r.drop;
    if (r.exposure_s) video["exposure"] = fmt::format("{:.1f} s", *r.exposure_s);
    if (r.reversal_s) video["reversal"] = fmt::format("{:g} s", *r.reversal_s);
    if (r.field_deg) video["field_direction"] = fmt::format("{:g} deg", *r.field_deg);
    if (r.field_t) video["field_strength"] = fmt::format("{:g} uT", 1e6 * *r.field_t);
    experiments.add_recording(r.experiment, std::move(video), r.polarity);
  } catch (const Error& e) {
    throw Error(e.code(), e.where(),
                fmt::format("{}; the recording is in {}, but not in the experiment", e.reason(),
                            r.path.filename().string()));
  }
}

}  // namespace faba
