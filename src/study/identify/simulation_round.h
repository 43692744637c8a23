#pragma once
#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "study/identify/families/model_family.h"
#include "study/identify/statistics/observed_statistics.h"
#include "study/sweep/sweep.h"

namespace faba {

/// An extension of a candidate by one of its families.
struct FamilyChoice {
  Eigen::VectorXd at;     ///< parameters at which families_of() is evaluated, as fractions of their ranges
  std::size_t index = 0;  ///< in families_of()
};

/// The families of a candidate at parameters `at`.
std::vector<ModelFamily> families_at(const IdentifyStudy& study, const std::vector<ResponseVideo>& videos,
                                     const Candidate& c, const Eigen::VectorXd& at);

/// The simulations of one round. Each simulation samples what is known with an uncertainty: times of field
/// reversals, number of cells, scale and field strength.
class SimulationRound {
 public:
  SimulationRound(const IdentifyStudy& study, const std::vector<ResponseVideo>& videos,
                  const ObservedStatistics& observed);

  /// Adds simulations of candidate `candidate`, one for each row of `u` and each episode. Simulations of one
  /// `number` and candidate have the same random numbers with and without a family.
  void add(std::size_t candidate, const Eigen::MatrixXd& u, std::size_t number,
           const std::optional<FamilyChoice>& family = {});
  bool empty() const { return blocks_.empty(); }
  /// The tasks; the round must outlive them.
  Round tasks() const;
  /// False when other shards have tasks left. Throws the errors of sweep().
  bool run(ResultStore& results, const SweepOptions& options);
  /// Statistics of the simulations of the next add(), one row each; NaN for failed simulations. Throws
  /// Error(usage) for damaged results.
  Eigen::MatrixXd take(const ResultStore& results, Eigen::Index rows);

  /// First word of the description of these rounds.
  static constexpr const char* kKind = "response 2";
  /// Adds the blocks of a description that tasks() has made. Throws Error(input) if it is of other videos.
  void add_described(const std::string& description);

 private:
  /// The simulations of one add().
  struct Block {
    std::size_t candidate = 0, number = 0;
    Eigen::MatrixXd u;
    std::optional<FamilyChoice> choice;
    std::optional<ModelFamily> family;
    std::uint64_t first = 0;  ///< task
  };
  const Block& block_of(std::uint64_t task) const;
  std::vector<double> simulate(std::uint64_t task) const;
  std::vector<TaskLabel> labels(std::uint64_t task) const;
  std::string description() const;

  const IdentifyStudy& study_;
  const std::vector<ResponseVideo>& videos_;
  const ObservedStatistics& observed_;
  std::vector<Block> blocks_;
  std::uint64_t size_ = 0, taken_ = 0, key_ = 0;
};

}  // namespace faba
