#pragma once
#include "server/jobs/job.h"

namespace faba {

/// Name of the file of an ended job in its directory.
inline constexpr const char* kJobFile = "job.json";

/// Writes an ended job with a kind to its directory, runs/activity-1/job.json. Does nothing if that is not
/// possible: the job is then listed until the lab ends.
void keep_job(const std::filesystem::path& workspace, const Job& job);
/// Removes a kept job from the next list. Its results and its file stay.
void forget_job(const std::filesystem::path& workspace, const Job& job);
/// The newest kept jobs below runs/ and experiments/*/results/, oldest first, with different ids. Invalid
/// files are ignored.
std::vector<Job> kept_jobs(const std::filesystem::path& workspace, std::size_t most);

}  // namespace faba
