#include <fmt/chrono.h>
#include <fmt/format.h>

#include <atomic>
#include <cstdlib>

#include "core/error.h"
#include "server/api/lab_services.h"
#include "server/api/responses.h"
#include "server/jobs/composed_study.h"
#include "server/jobs/job_estimate.h"
#include "server/jobs/job_words.h"
#include "server/request_values.h"
#include "study/identify/identify_study.h"
#include "study/steering/controller_study.h"

namespace faba {
namespace {

namespace fs = std::filesystem;

struct Asked {
  const JobKind& kind;
  Json values;
};
Asked asked_of(const Json& body) {
  const JobKind& kind = job_kind(text_of(body, "kind"));
  return {kind, body.contains("values") ? body["values"] : Json::object()};
}

// The first file of the values, for the title of the job.
std::string subject(const JobKind& kind, const Json& values) {
  for (const JobInput& i : kind.inputs) {
    if (!values.contains(i.key)) continue;
    const Json& v = values[i.key];
    const Json& first = v.is_array() && !v.empty() ? v[0] : v;
    if (!first.is_string()) continue;
    const std::string name = fs::path(first.get<std::string>()).filename().string();
    return v.is_array() && v.size() > 1 ? fmt::format("{} + {}", name, v.size() - 1) : name;
  }
  return "";
}

// Results of an experiment are in its folder.
fs::path results_of(const LabServices& lab, const Json& body) {
  const std::string experiment = body.value("experiment", "");
  if (experiment.empty()) return "runs";
  return lab.experiments.folder(experiment).lexically_relative(lab.workspace.root()) / "results";
}

JobEstimate estimate(const LabServices& lab, const Asked& a, double& work) {
  work = work_of(a.kind, a.values, lab.workspace);
  return estimate_job(a.kind, work, lab.jobs.jobs());
}
Json estimate_json(const JobEstimate& e) {
  return {{"seconds", e.seconds}, {"from", e.measured ? "measured" : "assumed"}};
}

Json start_job(const LabServices& lab, const Json& body) {
  const Asked a = asked_of(body);
  static std::atomic<unsigned> number{0};
  const fs::path results = results_of(lab, body),
                 out = results / fmt::format("{}-{:%Y%m%d-%H%M%S}-{}", a.kind.name,
                                             fmt::localtime(std::time(nullptr)), ++number);
  Job job{.words = job_words(a.kind, a.values, lab.workspace, out), .out = out, .kind = a.kind.name};
  if (!a.kind.page.empty()) job.page = out / a.kind.page;
  job.title = fmt::format("{}: {}", a.kind.verb_text(), subject(a.kind, a.values));
  try {
    const JobEstimate e = estimate(lab, a, job.work);
    job.estimate_s = e.seconds;
    job.estimate_measured = e.measured;
  } catch (const std::exception&) {
    job.work = 0;  // the job reports what is wrong with the file
  }
  fs::create_directories(lab.workspace.inside(out.string()));
  return {{"id", lab.jobs.add(std::move(job))}};
}

Json estimate_of(const LabServices& lab, const Json& body) {
  const Asked a = asked_of(body);
  (void)job_words(a.kind, a.values, lab.workspace, "runs");  // checks the values
  double work = 0;
  return estimate_json(estimate(lab, a, work));
}

Json compose(const LabServices& lab, const Json& body) {
  const JobKind& kind = job_kind(text_of(body, "kind"));
  Json asked = body;
  if (const std::string experiment = body.value("experiment", ""); !experiment.empty())
    asked["folder"] = lab.experiments.folder(experiment).lexically_relative(lab.workspace.root()).string();
  else
    asked.erase("folder");
  const ComposedStudy s = compose_study(kind, asked, lab.workspace);
  Json answer = {{"file", s.file}, {"toml", s.toml}};
  answer["estimate"] = estimate_json(estimate_job(kind, s.work, lab.jobs.jobs()));
  return answer;
}

int id_of(const std::string& text) { return std::atoi(text.c_str()); }
Error unknown_job(const std::string& id) { return {Errc::input, id.substr(0, 20), "job not found"}; }

Json job_of(const LabServices& lab, const std::string& id) {
  const std::optional<Job> j = lab.jobs.job(id_of(id));
  if (!j) throw unknown_job(id);
  Json answer = job_json(*j);
  answer["result"] = j->result;
  Json files = Json::array();
  std::error_code ec;
  if (!j->out.empty())
    for (const auto& e : fs::directory_iterator(lab.workspace.inside(j->out.string()), ec))
      if (e.is_regular_file(ec)) files.push_back(e.path().filename().string());
  answer["files"] = files;
  return answer;
}

// A failed command may have left outputs, which it would not replace.
void remove_outputs(const LabServices& lab, const Job& job) {
  if (job.kind.empty()) return;
  std::error_code ec;
  for (const JobOutput& o : job_kind(job.kind).outputs)
    if (!o.file.empty()) fs::remove(lab.workspace.inside((job.out / o.file).string()), ec);
}

Json change_job(const LabServices& lab, const std::string& id, const std::string& what) {
  const int n = id_of(id);
  const std::optional<Job> job = lab.jobs.job(n);
  if (!job) throw unknown_job(id);
  bool done = false;
  if (what == "first") {
    done = lab.jobs.move_to_front(n);
  } else if (what == "again") {
    if (is_over(*job) && job->state != Job::State::done) remove_outputs(lab, *job);
    done = lab.jobs.start_again(n);
  } else if (what == "clear") {
    done = lab.jobs.clear(n);
  } else {
    throw Error(Errc::usage, "do",
                fmt::format("\"{}\" must be one of first, again, clear", what.substr(0, 40)));
  }
  if (!done) throw Error(Errc::usage, id, "the job is in another state; reload the list of jobs");
  return Json::object();
}

// A file in the directory of a job.
WebResponse job_file(const LabServices& lab, const std::string& id, const std::string& name) {
  const std::optional<Job> j = lab.jobs.job(id_of(id));
  if (!j || j->out.empty()) throw unknown_job(id);
  const fs::path file = lab.workspace.existing((j->out / name).string());
  if (!fs::is_regular_file(file)) throw Error(Errc::input, name, "is not a file");
  return output_answer(file);
}

Json jobs(const LabServices& lab) {
  Json all = Json::array();
  for (const Job& j : lab.jobs.jobs()) all.push_back(job_json(j));
  return all;
}

Json kinds() {
  Json all = Json::array();
  for (const JobKind& k : job_kinds()) all.push_back(job_kind_json(k));
  return all;
}

}  // namespace

void add_job_routes(Routes& routes, const LabServices& lab) {
  routes.add("GET", "/api/schema/identify",
             [](const auto&, const auto&) { return json_answer(identify_study_schema()); });
  routes.add("GET", "/api/schema/compare-controllers",
             [](const auto&, const auto&) { return json_answer(controller_study_schema()); });
  routes.add("GET", "/api/job-kinds", [](const auto&, const auto&) { return json_answer(kinds()); });
  routes.add("GET", "/api/jobs", [&lab](const auto&, const auto&) { return json_answer(jobs(lab)); });
  routes.add("POST", "/api/jobs",
             [&lab](const auto& r, const auto&) { return json_answer(start_job(lab, body_of(r))); });
  routes.add("POST", "/api/jobs/estimate",
             [&lab](const auto& r, const auto&) { return json_answer(estimate_of(lab, body_of(r))); });
  routes.add("POST", "/api/studies",
             [&lab](const auto& r, const auto&) { return json_answer(compose(lab, body_of(r))); });
  routes.add("DELETE", "/api/jobs", [&lab](const auto&, const auto&) {
    lab.jobs.clear({});
    return json_answer(Json::object());
  });
  routes.add("GET", "/api/jobs/*",
             [&lab](const auto&, const auto& names) { return json_answer(job_of(lab, names[0])); });
  routes.add("GET", "/api/jobs/*/**",
             [&lab](const auto&, const auto& names) { return job_file(lab, names[0], names[1]); });
  routes.add("POST", "/api/jobs/*", [&lab](const auto& r, const auto& names) {
    return json_answer(change_job(lab, names[0], text_of(body_of(r), "do")));
  });
  routes.add("DELETE", "/api/jobs/*", [&lab](const auto&, const auto& names) {
    if (!lab.jobs.cancel(id_of(names[0]))) throw unknown_job(names[0]);
    return json_answer(Json::object());
  });
}

}  // namespace faba
