#pragma once
#include <chrono>
#include <condition_variable>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <thread>

#include "app/run/live_run.h"
#include "server/shown/frame_message.h"

namespace faba {

struct ShownRun;

/// The run that pages display and steer. It runs in real time in its own thread, which handles requests
/// between two frames. Only the newest frame is kept for each page: slow pages miss frames, and the run does
/// not wait for them.
class LiveLab {
 public:
  /// View settings of a listener.
  struct View {
    bool camera = false;
    double rate = 60;  ///< maximum frame rate, Hz
    int sites = 0;     ///< see FrameMessage
  };
  struct Listener {
    std::function<void(std::shared_ptr<const std::string>)> frame;  ///< binary
    std::function<void(const Json&)> news;                          ///< JSON messages without an id
  };

  /// `threads`: number of threads of a run; 0: all of the machine.
  explicit LiveLab(unsigned threads);
  ~LiveLab();

  /// Adds a listener, which first receives the present state.
  void watch(std::uint64_t who, Listener l);
  void set_view(std::uint64_t who, View w);
  void leave(std::uint64_t who);

  // Requests. `done` is called on the thread of the lab with the answer, without "id"; an Error becomes
  // {"ok": false, "where", "what"}.
  using Done = std::function<void(Json answer)>;
  void start(Document d, std::optional<std::uint64_t> seed, Done done);
  void exchange(Json event, Done done);
  void pause(bool paused, Done done);
  void step(std::uint64_t frames, Done done);
  void speed(double factor, Done done);
  void restart(Done done);
  /// The scenario with all events up to now, for a recording.
  void recorded(std::function<Json(const Scenario&, std::string state_hash)> take, Done done);

 private:
  using Clock = std::chrono::steady_clock;

  void run_loop(const std::stop_token& stop);
  void enqueue(std::function<Json()> what, Done done);
  void handle_requests(std::unique_lock<std::mutex>& lock);
  bool between_frames(const std::stop_token& stop);
  void keep_pace();
  Json prepare_run(const Document& d, std::uint64_t seed);
  LiveRun& live() const;
  void publish(Clock::time_point now);
  std::shared_ptr<const std::string> frame(bool camera);
  void broadcast(const Json& news);
  Json state() const;

  Parts parts_;
  Pool pool_;
  std::unique_ptr<ShownRun> shown_, next_;  ///< next_: replaces shown_ after it has stopped
  std::uint32_t run_ = 0;
  bool paused_ = false;
  std::uint64_t pause_at_ = 0;  ///< frame; 0: none
  double speed_ = 1, real_speed_ = 0;
  Clock::time_point due_, reported_;
  std::uint64_t reported_frame_ = 0;

  mutable std::mutex mutex_;
  std::condition_variable wake_;
  struct Request {
    std::function<Json()> what;
    Done done;
  };
  std::deque<Request> requests_;
  struct Watcher {
    Listener listener;
    View view;
    Clock::time_point next;  ///< earliest time of the next frame
  };
  std::map<std::uint64_t, Watcher> watchers_;
  std::jthread thread_;
};

}  // namespace faba
