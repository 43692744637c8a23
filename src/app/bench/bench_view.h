#pragma once
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "app/bench/open_bench.h"

namespace faba {

/// The camera of a bench, for pages to look through and set; the coils are not touched. One at a time.
/// Thread-safe. It closes by itself when nobody has looked for a while.
class BenchView {
 public:
  BenchView();
  ~BenchView();

  /// Opens the camera of a scenario with [rig], in place of one that was open. Throws what OpenBench throws.
  void open(Scenario s, const std::string& name);
  void close();
  /// `open` (the name, or null), and then `size_px`, `rate_hz`, `frames`, `dropped`, `corrupt`, `mean` grey,
  /// `saturated` (share of white pixels), `controls`, each {"name", "value", "automatically"}; `trouble`: why
  /// no more pictures come.
  Json state();
  /// The newest picture as PNG; empty when there is none.
  std::string picture();
  /// Throws Error(usage) for what the camera will not take, Error(input) when none is open.
  void set(const std::string& control, double value, std::optional<bool> automatically);

 private:
  struct View;
  std::shared_ptr<View> view(bool must);
  std::mutex opening_;  ///< held while one is made: slow
  std::mutex mutex_;    ///< of view_
  std::shared_ptr<View> view_;
  std::jthread janitor_;
};

}  // namespace faba
