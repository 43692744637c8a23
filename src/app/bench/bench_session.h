#pragma once
#include <memory>

#include "app/bench/open_bench.h"
#include "app/recording/recorder.h"
#include "app/recording/recording.h"

namespace faba {

struct RunOptions;

/// A recorded run on the bench of a scenario: the closed loop of app/loop/loop.h with a camera and coils in
/// place of a simulation. Its directory holds what a simulated run's does, with what was seen in place of
/// what is true.
class BenchSession {
 public:
  /// Makes the directory; the coils are disarmed. `bench`: opened with `s`. Throws Error(usage) for
  /// a scenario that does not fit, and then nothing has been written; Error(device).
  static BenchSession begin(Scenario s, std::shared_ptr<OpenBench> bench, std::uint64_t seed,
                            const RunOptions& o);
  ~BenchSession();
  BenchSession(BenchSession&&) noexcept;

  /// Runs for the scenario's duration, from the first frame on, or until asked to stop. Coils are armed when
  /// the first frame has been decided on, and at rest in the end. What was recorded is complete on every way
  /// out, also when Error(device) is thrown. Returns whether the end was reached.
  bool run();
  /// What manifest.json says, once it ran.
  const Manifest& manifest() const;
  /// series.csv, once it ran.
  Table series() const;
  void complete();
  const std::filesystem::path& dir() const;

 private:
  struct Impl;
  Manifest describe() const;
  explicit BenchSession(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace faba
