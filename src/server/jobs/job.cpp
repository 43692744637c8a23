#include "server/jobs/job.h"

#include <algorithm>
#include <array>

namespace faba {
namespace {

constexpr std::array<const char*, 5> kStates = {"waiting", "running", "done", "failed", "cancelled"};

std::string text_in(const Json& result, const char* key) {
  return result.is_object() && result.contains(key) && result[key].is_string()
             ? result[key].get<std::string>()
             : "";
}

}  // namespace

Json job_json(const Job& j) {
  return {{"id", j.id},
          {"title", j.title},
          {"words", j.words},
          {"page", j.page},
          {"out", j.out},
          {"kind", j.kind},
          {"work", j.work},
          {"estimate_s", j.estimate_s},
          {"estimate_from", j.estimate_measured ? "measured" : "assumed"},
          {"state", kStates[std::size_t(j.state)]},
          {"doing", j.doing},
          {"done", j.did},
          {"of", j.of},
          {"seconds", j.seconds},
          {"ended", j.ended},
          {"error", j.error},
          {"quality", text_in(j.result, "quality")}};
}

Job::State job_state(const std::string& word) {
  const auto at = std::find(kStates.begin(), kStates.end(), word);
  return at == kStates.end() ? Job::State::failed : Job::State(at - kStates.begin());
}

}  // namespace faba
