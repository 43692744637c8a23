#include "study/identify/simulation_round.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/archive.h"
#include "core/error.h"
#include "core/hash.h"
#include "study/identify/sampled_episode.h"

namespace faba {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

std::string observed_digest(const ObservedStatistics& o) {
  Hash h;
  h.values(std::span<const double>(o.numbers.data(), std::size_t(o.numbers.size())));
  return h.hex();
}

// One description of writing and reading. Numbers of rows and columns precede the elements.
void archive_matrix(Archive& a, MatrixXd& m) {
  Index rows = m.rows(), columns = m.cols();
  std::vector<double> elements(m.data(), m.data() + m.size());
  a& rows& columns& elements;
  if (a.reading()) m = Eigen::Map<const MatrixXd>(elements.data(), rows, columns);
}

std::uint64_t seed_of(std::initializer_list<std::uint64_t> values) {
  Hash h;
  for (const std::uint64_t x : values) h.value(x);
  return h.result() >> 1;
}

}  // namespace

std::vector<ModelFamily> families_at(const IdentifyStudy& study, const std::vector<ResponseVideo>& videos,
                                     const Candidate& c, const VectorXd& at) {
  const Episode& episode = videos.front().episodes.front();
  return families_of(c,
                     candidate_scenario(study, c, videos.front(), episode, at, exact_timing(episode)).root);
}

SimulationRound::SimulationRound(const IdentifyStudy& study, const std::vector<ResponseVideo>& videos,
                                 const ObservedStatistics& observed)
    : study_(study), videos_(videos), observed_(observed) {}

void SimulationRound::add(std::size_t candidate, const MatrixXd& u, std::size_t number,
                          const std::optional<FamilyChoice>& choice) {
  Block b{candidate, number, u, choice, {}, size_};
  if (choice)
    b.family = families_at(study_, videos_, study_.candidates.at(candidate), choice->at).at(choice->index);
  size_ += std::uint64_t(u.rows()) * observed_.parts.size();
  blocks_.push_back(std::move(b));
}

std::string SimulationRound::description() const {
  Archive a;
  std::string kind = kKind, observed = observed_digest(observed_);
  std::uint64_t blocks = blocks_.size();
  a& kind& observed& blocks;
  for (Block b : blocks_) {
    bool family = b.choice.has_value();
    a& b.candidate& b.number& family;
    archive_matrix(a, b.u);
    if (!family) continue;
    MatrixXd at = b.choice->at;
    archive_matrix(a, at);
    a& b.choice->index;
  }
  return {a.bytes().begin(), a.bytes().end()};
}

void SimulationRound::add_described(const std::string& description) {
  Archive a(std::vector<std::uint8_t>(description.begin(), description.end()));
  std::string kind, observed;
  std::uint64_t blocks = 0;
  a& kind& observed& blocks;
  if (kind != kKind || observed != observed_digest(observed_))
    throw Error(Errc::input, "measured",
                "the measurement of the videos differs from the one with which the round was planned");
  for (std::uint64_t k = 0; k < blocks; ++k) {
    Block b;
    bool family = false;
    a& b.candidate& b.number& family;
    archive_matrix(a, b.u);
    if (family) {
      MatrixXd at;
      archive_matrix(a, at);
      b.choice.emplace();
      b.choice->at = at;
      a& b.choice->index;
    }
    add(b.candidate, b.u, b.number, b.choice);
  }
}

const SimulationRound::Block& SimulationRound::block_of(std::uint64_t task) const {
  const auto after = std::upper_bound(blocks_.begin(), blocks_.end(), task,
                                      [](std::uint64_t t, const Block& b) { return t < b.first; });
  return *std::prev(after);
}

std::vector<double> SimulationRound::simulate(std::uint64_t task) const {
  const Block& block = block_of(task);
  const std::uint64_t i = (task - block.first) / observed_.parts.size(),
                      p = (task - block.first) % observed_.parts.size();
  const Candidate& c = study_.candidates[block.candidate];
  const ObservedStatistics::Part& part = observed_.parts[p];
  const ResponseVideo& video = videos_[part.video];
  const Episode& episode = video.episodes[part.episode];
  const EpisodeSeeds seeds{seed_of({study_.seed, block.candidate, block.number, i}),
                           seed_of({study_.seed, block.candidate, block.number, i, p})};
  const SampledEpisode sampled = sampled_episode(study_, c, video, episode, block.u.row(Index(i)).transpose(),
                                                 seeds, block.family ? &*block.family : nullptr);
  try {
    return sampled_statistics(study_, video, *part.statistics, sampled, seeds);
  } catch (const Error& e) {
    if (e.code() != Errc::usage) throw;
    // Incompatible values, such as speeds that need too many steps.
    return std::vector<double>(std::size_t(part.count), std::nan(""));
  }
}

std::vector<TaskLabel> SimulationRound::labels(std::uint64_t task) const {
  const Block& block = block_of(task);
  const std::uint64_t row = (task - block.first) / observed_.parts.size(),
                      p = (task - block.first) % observed_.parts.size();
  const ObservedStatistics::Part& part = observed_.parts[p];
  const Candidate& c = study_.candidates[block.candidate];
  std::vector<TaskLabel> labels{{"model", c.model.name},
                                {"extension", block.family ? block.family->what : ""},
                                {"episode", videos_[part.video].episodes[part.episode].name},
                                {"simulation", fmt::format("{}", row + 1), double(row + 1)}};
  for (std::size_t j = 0; j < c.free.size(); ++j) {
    const double value = c.free[j].value(block.u(Index(row), Index(j)));
    labels.push_back({c.free[j].path, fmt::format("{:.6g}", value), value});
  }
  return labels;
}

Round SimulationRound::tasks() const {
  return {description(), size_, [this](std::uint64_t task) { return simulate(task); },
          [this](std::uint64_t task) { return labels(task); }};
}

bool SimulationRound::run(ResultStore& results, const SweepOptions& options) {
  const Round round = tasks();
  key_ = results.key(round);
  return sweep(results, round, options);
}

MatrixXd SimulationRound::take(const ResultStore& results, Index rows) {
  MatrixXd s = MatrixXd::Constant(rows, observed_.numbers.size(), std::nan(""));
  for (Index i = 0; i < rows; ++i)
    for (const ObservedStatistics::Part& part : observed_.parts) {
      const std::span<const double> values = results.find({key_, taken_++}).value();
      if (Index(values.size()) != part.count)
        throw Error(
            Errc::usage, results.folder().string(),
            fmt::format("result with {} numbers, expected {}; delete the folder to compute all results "
                        "again",
                        values.size(), part.count));
      s.row(i).segment(part.begin, part.count) =
          Eigen::Map<const VectorXd>(values.data(), part.count).transpose();
    }
  return s;
}

}  // namespace faba
