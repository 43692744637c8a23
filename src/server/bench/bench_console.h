#pragma once
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "app/bench/capture.h"
#include "app/bench/viewed_bench.h"
#include "app/scenario/scenario.h"
#include "server/bench/arming_permits.h"
#include "server/bench/bench_activity.h"

namespace faba {

/// Where a recording of the bench goes.
struct BenchDestination {
  std::string title;
  std::filesystem::path root;    ///< pages see `out` relative to it
  std::filesystem::path out;     ///< file, folder or run directory
  std::string experiment, drop;  ///< to which it is added; may be empty
};

/// A recording that was made, for an experiment.
struct BenchRecording {
  std::filesystem::path path;
  std::string experiment, drop;
  std::optional<double> exposure_s = {};  ///< air exposure time of the sample at its start
  std::optional<double> reversal_s = {};  ///< time of the field reversal in it
  std::optional<double> field_deg =
      {};                              ///< direction of the field after the reversal, counter-clockwise, y up
  std::optional<double> field_t = {};  ///< T
  int polarity = 0;  ///< of the cells that the scene names: +1 north, -1 south, 0 not stated
};

/// A page's jog: its secret and the largest current of each coil, A.
struct JogSession {
  std::string secret;
  std::vector<double> max_current;
};

/// The bench of the lab for its pages: live view of the camera, captures, runs, step responses and jog. It
/// belongs to the lab, not to a page: activities continue when a page is closed, except a jog, which ends
/// when its page is silent. What energises the coils needs a permit (arming_permits.h) and goes through
/// Limits and the guard. Thread-safe.
class BenchConsole {
 public:
  /// A jog without a message of its page for this time ends, s.
  static constexpr double kJogDeadline = 0.6;

  /// `changed` is called with the short state after changes and regularly during an activity; `recorded` adds
  /// a recording to its experiment, and throws Error if it cannot.
  BenchConsole(std::function<void(const Json&)> changed, std::function<void(const BenchRecording&)> recorded);
  ~BenchConsole();

  /// Closes an open camera and opens that of a scenario with [rig]. Throws the errors of OpenBench, and
  /// Error(usage) during an activity.
  void open(const Document& scene, const std::string& name);
  /// Throws Error(usage) during an activity.
  void close();
  /// The state for pages, see web/protocol.md. A request keeps an idle camera open.
  Json state();
  /// The newest picture as PNG, or as BMP, which costs the least time; empty without a picture.
  std::string png();
  std::string bmp();
  /// Throws Error(usage) for a control or value that the camera does not support, Error(input) if none is
  /// open.
  void set(const std::string& control, double value, std::optional<bool> automatically);
  /// The sample has this air exposure time now, s; empty: not known.
  void sample(std::optional<double> exposure_s);

  // Activities. Each returns when it has started; its errors are in the state. Throw Error(usage) during
  // another activity, and Error(input) without an open bench.
  void capture(CaptureJob job, const BenchDestination& to);
  void run(double duration_s, const BenchDestination& to, std::uint64_t page, const std::string& permit);
  /// `changes` of [rig.step_response].
  void step_responses(const Json& changes, BenchDestination to, std::uint64_t page,
                      const std::string& permit);
  JogSession jog(std::uint64_t page, const std::string& permit);

  /// Currents of a jog, A, one per coil, in messages with increasing numbers. Throws Error(usage) for another
  /// session or an old number; nothing changes then.
  Json jog_set(const std::string& session, std::uint64_t number, const std::vector<double>& current);
  /// Resets a fault of the guard and arms again.
  void jog_reset(const std::string& session, std::uint64_t page, const std::string& permit);

  /// The page that steers; 0: none. A jog of another page ends.
  void steering(std::uint64_t page);
  /// Asks the activity to end.
  void stop();
  /// Ends an activity that uses the coils, and makes all permits void. Never fails.
  void off();
  ArmingPermits& permits() { return permits_; }

 private:
  // What the page of a jog asks for. The thread of the jog reads it.
  struct Jog {
    explicit Jog(std::uint64_t of_page);
    const std::string secret;
    const std::uint64_t page;
    std::mutex mutex;  // protects the following members
    std::uint64_t number = 0;
    double heard;                 ///< s, the newest message
    std::vector<double> current;  ///< A
    bool reset = false;
  };
  /// Returns a note on its end; may be empty.
  using Work = std::function<std::string(ViewedBench&, BenchActivity&)>;

  std::shared_ptr<ViewedBench> bench(bool required);
  std::shared_ptr<ViewedBench> take_bench();
  std::shared_ptr<BenchActivity> new_activity(const char* kind, const std::string& title, bool uses_coils);
  void start(const std::shared_ptr<BenchActivity>& activity, Work work, std::shared_ptr<Jog> jog = nullptr);
  void finish(const std::shared_ptr<BenchActivity>& activity, Json result);
  std::optional<double> exposure();
  std::shared_ptr<Jog> jog_of(const std::string& session);
  static std::string work_of_jog(ViewedBench& b, BenchActivity& a, Jog& jog);
  Json describe(bool all);
  void tell();
  void watch(const std::stop_token& stop);

  std::function<void(const Json&)> changed_;
  std::function<void(const BenchRecording&)> recorded_;
  ArmingPermits permits_;
  std::mutex opening_;  ///< held during open() and close(), which are slow
  std::mutex mutex_;    // protects the following members
  std::shared_ptr<ViewedBench> bench_;
  std::shared_ptr<BenchActivity> activity_;
  std::shared_ptr<Jog> jog_;
  std::uint64_t openings_ = 0;
  std::deque<Json> finished_;     ///< newest first, with "at" in s
  std::optional<double> placed_;  ///< s, when the air exposure of the sample began
  std::string fault_;
  double fault_at_ = 0;
  std::jthread worker_;   ///< of the activity
  std::jthread watcher_;  ///< closes an idle camera, tells pages about activities
};

}  // namespace faba
