#include "server/jobs/job_archive.h"

#include <algorithm>
#include <set>

#include "core/error.h"
#include "core/file.h"
#include "core/json_input.h"

namespace faba {
namespace {

namespace fs = std::filesystem;
constexpr std::uintmax_t kLargest = 64u << 20;  // bytes

// `out`: the directory of the file. What the file states about places outside of it is not used.
Job read_job(const Json& j, const fs::path& out) {
  Job job{.id = j.at("id"), .title = j.at("title"), .words = j.at("words"), .out = out, .kind = j.at("kind")};
  const fs::path page = fs::path(j.at("page").get<std::string>()).filename();
  job.page = page.empty() ? fs::path() : out / page;
  job.work = j.at("work");
  job.estimate_s = j.at("estimate_s");
  job.estimate_measured = j.at("estimate_from") == "measured";
  job.state = job_state(j.at("state").get<std::string>());
  job.seconds = j.at("seconds");
  job.ended = j.at("ended");
  job.error = j.at("error");
  job.result = j.at("result");
  return job;
}

void add_jobs(const fs::path& workspace, const fs::path& folder, std::vector<Job>& jobs) {
  std::error_code ec;
  for (const auto& e : fs::directory_iterator(workspace / folder, ec)) {
    const fs::path file = e.path() / kJobFile;
    if (!fs::is_regular_file(file, ec) || fs::file_size(file, ec) > kLargest) continue;
    try {
      const Json j = parse_json(read_file(file));
      if (!j.is_object()) continue;
      if (j.value("listed", true)) jobs.push_back(read_job(j, folder / e.path().filename()));
    } catch (const Json::exception&) {
      continue;
    } catch (const Error&) {
      continue;
    }
  }
}

void write_job(const fs::path& workspace, const Job& job, bool listed) {
  if (job.kind.empty() || job.out.empty()) return;
  Json j = job_json(job);
  j["result"] = job.result;
  j["listed"] = listed;
  try {
    fs::create_directories(workspace / job.out);
    write_file(workspace / job.out / kJobFile, j.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n");
  } catch (const std::exception&) {
    return;
  }
}

}  // namespace

void keep_job(const fs::path& workspace, const Job& job) { write_job(workspace, job, true); }
void forget_job(const fs::path& workspace, const Job& job) { write_job(workspace, job, false); }

std::vector<Job> kept_jobs(const fs::path& workspace, std::size_t most) {
  std::vector<Job> jobs;
  add_jobs(workspace, "runs", jobs);
  std::error_code ec;
  for (const auto& e : fs::directory_iterator(workspace / "experiments", ec))
    add_jobs(workspace, fs::path("experiments") / e.path().filename() / "results", jobs);
  std::stable_sort(jobs.begin(), jobs.end(), [](const Job& a, const Job& b) { return a.ended < b.ended; });
  if (jobs.size() > most) jobs.erase(jobs.begin(), jobs.end() - std::ptrdiff_t(most));
  std::set<int> used;
  int next = 1;
  for (const Job& j : jobs) next = std::max(next, j.id + 1);
  for (Job& j : jobs)
    if (!used.insert(j.id).second) j.id = next++;
  return jobs;
}

}  // namespace faba
