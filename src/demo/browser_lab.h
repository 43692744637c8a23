#pragma once
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "server/shown/page_message.h"
#include "server/shown/run_news.h"

namespace faba {

/// The live lab without threads, sockets and files: it answers messages and simulates frames when the page
/// calls it. web/protocol.md has the messages, also those that only the demonstration has.
class BrowserLab {
 public:
  struct Page {
    std::function<void(const std::string&)> text;   ///< receives JSON
    std::function<void(const std::string&)> frame;  ///< receives a binary frame
    std::function<double()> clock;                  ///< s, monotonic
  };
  /// `gallery`: the folder of the scenes.
  BrowserLab(Page page, std::filesystem::path gallery);

  /// Answers a message of the page.
  void receive(std::string_view text);
  /// Answers a request of the page without a message: GET /api/schema, /api/scenes, /api/scenes/NAME, POST
  /// /api/check. Errors have `where` and `what`.
  Json answer(std::string_view path, std::string_view body);
  /// Simulates the frames that are due, but stops after `budget` s, and sends the newest one. Returns the
  /// time until the next frame is due, s; infinity if the run is paused.
  double advance(double budget);

 private:
  enum class Pace { paused, real_time, fastest };

  Json carry_out(const PageMessage& m);
  void start(const Json& scenario, std::uint64_t seed);
  void pace(Pace p);
  void pause();
  bool step();
  void measure_speed(double now);
  void send_frame();
  void send_state();
  void send_hash();
  ShownRun& shown();
  double period() const;
  std::uint64_t end() const;

  Document document(Json scenario) const;
  std::string in_page(const std::string& where) const;
  Json refusal(const std::exception& e) const;
  Json check(std::string_view body) const;

  Page page_;
  std::filesystem::path gallery_;
  Parts parts_;
  Pool pool_;
  std::unique_ptr<ShownRun> shown_;
  std::uint32_t run_ = 0;
  Pace pace_ = Pace::paused;
  std::uint64_t pause_at_ = 0;  ///< frame
  double speed_ = 1, real_speed_ = 0;
  double due_ = 0;        ///< s, time of the next frame
  bool on_time_ = false;  ///< due_ is valid
  double reported_ = 0;   ///< s, time of the newest message about the speed
  std::uint64_t reported_frame_ = 0;
  double frame_rate_ = 60, sent_ = 0;  ///< Hz, largest rate of frames; s, time of the newest frame
  bool camera_ = false;
  int sites_ = 0;
};

}  // namespace faba
