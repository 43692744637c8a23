#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "server/jobs/job.h"
#include "server/jobs/job_kind.h"
#include "server/workspace.h"

namespace faba {

/// How long a job will run.
struct JobEstimate {
  double seconds = 0;
  bool measured = false;  ///< from jobs of the kind that are complete; otherwise from the initial values
};

/// The work of a job with valid values: megapixels of the frames that are measured, megapixels of the frames
/// that are simulated, millions of cells times frames, or millions of sets of currents. 0 if it is not known,
/// and for jobs with a fixed time. Reads headers of videos, and studies. Throws Error for files that are not
/// valid.
double work_of(const JobKind& kind, const Json& values, const Workspace& workspace);
/// The same for a study file of `kind`.
double work_of_study(const JobKind& kind, const std::filesystem::path& study);

/// From the median of the times per work of the last complete jobs of this kind.
JobEstimate estimate_job(const JobKind& kind, double work, const std::vector<Job>& jobs);

}  // namespace faba
