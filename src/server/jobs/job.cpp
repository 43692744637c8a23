#include "server/jobs/job.h"

#include <algorithm>
#include <array>

namespace faba {
namespace {

constexpr std::array<const char*, 5> kStates = {"waiting", "running", "done", "failed", "cancelled"};

// The file that a word of a command line names: "runs/steer" of "./runs/steer" or "--noise=./runs/steer".
std::string_view file_of(std::string_view word) {
  if (word.starts_with("--")) word.remove_prefix(std::min(word.size(), word.find('=')));
  if (word.starts_with('=')) word.remove_prefix(1);
  if (word.starts_with("./")) word.remove_prefix(2);
  return word;
}

}  // namespace

bool job_uses(const Job& j, const std::string& path) {
  const auto names = [&](const std::string& word) {
    const std::string_view file = file_of(word);
    return file == path || file.starts_with(path + "/");
  };
  return !is_over(j) && (names(j.out.string()) || std::any_of(j.words.begin(), j.words.end(), names));
}

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
          {"error", j.error}};
}

Job::State job_state(const std::string& word) {
  const auto at = std::find(kStates.begin(), kStates.end(), word);
  return at == kStates.end() ? Job::State::failed : Job::State(at - kStates.begin());
}

}  // namespace faba
