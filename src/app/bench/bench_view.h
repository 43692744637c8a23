#pragma once
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "app/bench/open_bench.h"

namespace faba {

/// Live view of the camera of a bench with its settings, for pages; the coils are not used. One camera at a
/// time. Thread-safe. The camera is closed automatically when there has been no request for some time.
class BenchView {
 public:
  BenchView();
  ~BenchView();

  /// Closes an open camera and opens that of a scenario with [rig]. Throws the errors of OpenBench.
  void open(Scenario s, const std::string& name);
  void close();
  /// `open` (the name, or null); if open also `size_px`, `rate_hz`, `frames`, `dropped`, `corrupt`, `mean`
  /// grey value, `saturated` (fraction of saturated pixels), `controls`, each {"name", "value",
  /// "automatically"}; `trouble`: why there are no more pictures.
  Json state();
  /// The newest picture as PNG; empty without a picture.
  std::string picture();
  /// Throws Error(usage) for a control or value that the camera does not support, Error(input) if none is
  /// open.
  void set(const std::string& control, double value, std::optional<bool> automatically);

 private:
  struct View;
  std::shared_ptr<View> view(bool required);
  std::mutex opening_;  ///< held during open(), which is slow
  std::mutex mutex_;    ///< protects view_
  std::shared_ptr<View> view_;
  std::jthread closer_;  ///< closes an idle camera
};

}  // namespace faba
