#pragma once
#include <atomic>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>

#include "app/bench/bench_watcher.h"
#include "app/bench/capture.h"
#include "core/frame.h"
#include "core/monotonic.h"

namespace faba {

/// What a bench is doing for the pages: a capture, a run, step responses or a jog, in its own thread. All
/// functions but the watcher's may be called by any thread.
class BenchActivity final : public BenchWatcher {
 public:
  /// `kind_of_it`: capture, run, step-response or jog. `with_coils`: they are energised.
  BenchActivity(std::string kind_of_it, std::string named, bool with_coils, const Frame& frame,
                std::vector<double> max_current)
      : kind(std::move(kind_of_it)),
        title(std::move(named)),
        uses_coils(with_coils),
        frame_(frame),
        max_current_(std::move(max_current)) {}

  const std::string kind, title;
  const bool uses_coils;
  const double began = monotonic_now();  ///< s
  std::atomic<bool> stop = false;        ///< set to end it

  void cycle(const Tick& t, const GuardReport& guard) override;
  /// State of the coils without a control loop.
  void coils(const std::vector<double>& current, const GuardReport& guard);
  void progress(std::uint64_t done, std::uint64_t total);
  void captured(const Captured& so_far, std::size_t picture_bytes);
  /// Item `index`, from 1, of a series of `of`.
  void item(int index, int of);
  void out(const std::string& path, const std::string& experiment);
  bool armed() const;
  std::optional<GuardReport> guard() const;

  /// "activity" of the state, without the lateness, and "coils", "guard", "armed" and "setpoint_px".
  void describe(Json& state) const;

 private:
  Json guard_json() const;
  Json coils_json() const;

  Frame frame_;
  std::vector<double> max_current_;  ///< A
  mutable std::mutex mutex_;         // protects the following members
  std::vector<double> current_;      ///< A
  std::optional<GuardReport> guard_;
  std::optional<Vec2> setpoint_px_;
  std::optional<Estimate> estimate_;  ///< of the control loop
  std::uint64_t done_ = 0, total_ = 0;
  std::pair<double, std::uint64_t> first_;  ///< time of the first report of the progress, s, and its `done`
  std::optional<Captured> captured_;
  std::size_t picture_bytes_ = 0;
  int index_ = 0, of_ = 0;
  std::string out_, experiment_;
};

}  // namespace faba
