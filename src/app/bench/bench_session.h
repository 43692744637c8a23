#pragma once
#include <memory>

#include "app/bench/open_bench.h"
#include "app/recording/recorder.h"
#include "app/recording/recording.h"

namespace faba {

struct RunOptions;

/// A recorded run on the bench of a scenario: the control loop of app/loop/loop.h with a camera and coils in
/// place of a simulation. Its directory has the same files as that of a simulated run, with estimated in
/// place of true values.
class BenchSession {
 public:
  /// Creates the directory; the coils are disarmed. `bench`: opened with `s`. Throws Error(usage) for an
  /// unsuitable scenario, before anything is written; Error(device).
  static BenchSession begin(Scenario s, std::shared_ptr<OpenBench> bench, std::uint64_t seed,
                            const RunOptions& o);
  ~BenchSession();
  BenchSession(BenchSession&&) noexcept;

  /// Runs for the scenario's duration, from the first frame, or until the stop flag is set. The coils are
  /// armed after the first control cycle and de-energised at the end. All recorded files are finished in any
  /// case, also when Error(device) is thrown. Returns whether the end was reached.
  bool run();
  /// Content of manifest.json, after run().
  const Manifest& manifest() const;
  /// Content of series.csv, after run().
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
