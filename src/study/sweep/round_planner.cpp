#include "study/sweep/round_planner.h"

#include <fmt/format.h>

#include <charconv>

#include "core/error.h"
#include "study/sweep/sweep.h"

namespace faba {
namespace {

constexpr std::uint64_t kMostNumbers = 100'000'000;  // in a list

bool read_number_text(std::string_view text, std::uint64_t& out) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), out);
  return error == std::errc() && end == text.data() + text.size();
}

}  // namespace

PlannedRound RoundPlanner::plan(const Round& round, const ResultStore& store, bool open) {
  PlannedRound planned{next_, round.size, round.description};
  next_ += round.size;
  if (open) plan_round(dir_, store.study_hash(), planned);
  return planned;
}

bool RoundPlanner::operator()(const Round& round, ResultStore& store) {
  const std::vector<std::uint64_t> missing = missing_tasks(store, round);
  PlannedRound planned = plan(round, store, !missing.empty());
  if (missing.empty()) return true;
  FailedTasks failed;
  for (const auto& [task, f] : store.failures(store.key(round)))
    if (f.attempts >= kMostAttempts) failed[task] = f.what;
  if (failed.size() == missing.size()) throw failed_tasks(round, failed, planned.first, kMostAttempts);
  open_tasks_.clear();
  for (const std::uint64_t task : missing)
    if (!failed.contains(task)) open_tasks_.push_back(planned.first + task);
  open_round_ = std::move(planned);
  return false;
}

std::string number_list(const std::vector<std::uint64_t>& numbers) {
  std::string text;
  for (std::size_t i = 0; i < numbers.size();) {
    std::size_t last = i;
    while (last + 1 < numbers.size() && numbers[last + 1] == numbers[last] + 1) ++last;
    text += text.empty() ? "" : ",";
    text += last == i ? fmt::format("{}", numbers[i]) : fmt::format("{}-{}", numbers[i], numbers[last]);
    i = last + 1;
  }
  return text;
}

std::vector<std::uint64_t> numbers_in(const std::string& text) {
  std::vector<std::uint64_t> numbers;
  std::string_view rest = text;
  while (true) {
    const std::string_view item = rest.substr(0, rest.find(','));
    const std::size_t dash = item.find('-');
    std::uint64_t first = 0, last = 0;
    const bool good = read_number_text(item.substr(0, dash), first) &&
                      (dash == std::string_view::npos ? (last = first, true)
                                                      : read_number_text(item.substr(dash + 1), last)) &&
                      first >= 1 && first <= last && last - first < kMostNumbers - numbers.size();
    if (!good)
      throw Error(
          Errc::usage, "--tasks",
          fmt::format("\"{}\" is not a list of tasks; write numbers and ranges from 1, such as 1-20 or "
                      "1-20,45",
                      text));
    for (std::uint64_t n = first; n <= last; ++n) numbers.push_back(n);
    if (item.size() == rest.size()) return numbers;
    rest.remove_prefix(item.size() + 1);
  }
}

}  // namespace faba
