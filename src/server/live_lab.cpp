#include "server/live_lab.h"

#include <algorithm>
#include <cmath>

#include "app/run/random_seed.h"
#include "server/shown/run_news.h"

namespace faba {
namespace {

constexpr double kStatePeriod = 0.5;  // s, interval of state messages
constexpr double kLate = 0.25;        // s, maximum lag that is made up for

}  // namespace

LiveLab::LiveLab(unsigned threads)
    : parts_(builtin_parts()), pool_(threads), thread_([this](const std::stop_token& s) { run_loop(s); }) {}

LiveLab::~LiveLab() {
  thread_.request_stop();
  wake_.notify_all();
}

LiveRun& LiveLab::live() const {
  if (!shown_) throw Error(Errc::usage, "run", "no run; start a scenario first");
  return shown_->live;
}

void LiveLab::enqueue(std::function<Json()> what, Done done) {
  {
    const std::lock_guard lock(mutex_);
    requests_.push_back({std::move(what), std::move(done)});
  }
  wake_.notify_all();
}

void LiveLab::handle_requests(std::unique_lock<std::mutex>& lock) {
  while (!requests_.empty() && !next_) {
    const Request a = std::move(requests_.front());
    requests_.pop_front();
    lock.unlock();
    Json answer;
    try {
      answer = a.what();
      answer["ok"] = true;
    } catch (const Error& e) {
      answer = {{"ok", false}, {"where", e.where()}, {"what", e.reason()}};
    } catch (const std::exception& e) {
      answer = {{"ok", false}, {"where", ""}, {"what", e.what()}};
    }
    a.done(std::move(answer));
    lock.lock();
  }
}

void LiveLab::run_loop(const std::stop_token& stop) {
  while (!stop.stop_requested()) {
    {
      std::unique_lock lock(mutex_);
      handle_requests(lock);
      if (!next_) {
        wake_.wait(lock, [&] { return stop.stop_requested() || !requests_.empty(); });
        continue;
      }
      shown_ = std::move(next_);
    }
    ++run_;
    due_ = reported_ = Clock::now();
    reported_frame_ = 0;
    real_speed_ = 0;
    broadcast(run_news(*shown_, run_));
    broadcast(state());
    try {
      shown_->live.run([&] { return between_frames(stop); });
    } catch (const Error& e) {
      broadcast({{"say", "stopped"}, {"where", e.where()}, {"what", e.reason()}});
    }
  }
}

// Runs at the requested speed if possible. Lag beyond kLate is not made up for.
void LiveLab::keep_pace() {
  const auto now = Clock::now();
  const double period = shown_->live.scenario().frame_period() / speed_;
  due_ += std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(period));
  if (now - due_ > std::chrono::duration<double>(kLate)) due_ = now;
  const double since = std::chrono::duration<double>(now - reported_).count();
  if (since < kStatePeriod) return;
  const std::uint64_t frames = shown_->live.frame() - reported_frame_;
  real_speed_ = double(frames) * shown_->live.scenario().frame_period() / since;
  reported_ = now;
  reported_frame_ = shown_->live.frame();
  broadcast(state());
}

bool LiveLab::between_frames(const std::stop_token& stop) {
  keep_pace();
  publish(Clock::now());
  std::unique_lock lock(mutex_);
  if (pause_at_ > 0 && shown_->live.frame() >= pause_at_) {
    pause_at_ = 0;
    paused_ = true;
    const Json news = state();
    lock.unlock();
    broadcast(news);
    lock.lock();
  }
  for (;;) {
    handle_requests(lock);
    if (next_ || stop.stop_requested()) return false;
    const auto woken = [&] { return stop.stop_requested() || !requests_.empty(); };
    if (paused_) {
      wake_.wait(lock, woken);
      due_ = reported_ = Clock::now();
      reported_frame_ = shown_->live.frame();
    } else if (!wake_.wait_until(lock, due_, woken)) {
      return true;
    }
  }
}

void LiveLab::publish(Clock::time_point now) {
  std::map<std::pair<bool, int>, std::shared_ptr<const std::string>> messages;  // by camera and sites
  const std::lock_guard lock(mutex_);
  for (auto& [who, w] : watchers_) {
    if (now < w.next && !paused_) continue;
    // From the time at which the frame was due: with the time of the frame, the jitter of a run at the same
    // rate would skip every second frame.
    const auto period =
        std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(1 / w.view.rate));
    w.next = std::max(w.next + period, now);
    auto& message = messages[{w.view.camera, w.view.sites}];
    if (!message) message = shown_->message(run_, w.view.camera, w.view.sites);
    w.listener.frame(message);
  }
}

void LiveLab::broadcast(const Json& news) {
  const std::lock_guard lock(mutex_);
  for (const auto& [who, w] : watchers_) w.listener.news(news);
}

Json LiveLab::state() const {
  Json j = {
      {"say", "state"}, {"running", !paused_ && shown_}, {"speed", speed_}, {"real_speed", real_speed_}};
  j["frame"] = shown_ ? shown_->live.frame() : 0;
  return j;
}

void LiveLab::watch(std::uint64_t who, Listener l) {
  enqueue(
      [this, who, l = std::move(l)] {
        if (shown_) l.news(run_news(*shown_, run_));
        if (shown_ && shown_->history.size() > 0) l.news(history_news(*shown_, run_));
        l.news(state());
        if (shown_ && shown_->live.frame() > 0) l.frame(shown_->message(run_, false, 0));
        const std::lock_guard lock(mutex_);
        watchers_[who] = {l, {}, {}};
        return Json::object();
      },
      [](const Json&) {});
}

void LiveLab::set_view(std::uint64_t who, View w) {
  enqueue(
      [this, who, w] {
        std::unique_lock lock(mutex_);
        const auto it = watchers_.find(who);
        if (it == watchers_.end()) return Json::object();
        it->second.view = w;
        if (paused_ && shown_ && shown_->live.frame() > 0)
          it->second.listener.frame(shown_->message(run_, w.camera, w.sites));
        return Json::object();
      },
      [](const Json&) {});
}

void LiveLab::leave(std::uint64_t who) {
  const std::lock_guard lock(mutex_);
  watchers_.erase(who);
}

Json LiveLab::prepare_run(const Document& d, std::uint64_t seed) {
  next_ = std::make_unique<ShownRun>(d, seed, parts_, pool_);
  paused_ = false;
  pause_at_ = 0;
  return {{"seed", seed}};
}

void LiveLab::start(Document d, std::optional<std::uint64_t> seed, Done done) {
  enqueue([this, d = std::move(d), seed] { return prepare_run(d, seed.value_or(random_seed())); },
          std::move(done));
}

void LiveLab::restart(Done done) {
  enqueue(
      [this] {
        const std::uint64_t seed = live().seed();
        return prepare_run(shown_->document, seed);
      },
      std::move(done));
}

void LiveLab::exchange(Json event, Done done) {
  enqueue(
      [this, event = std::move(event)] {
        live().exchange(event);
        broadcast(parts_news(*shown_));
        return Json::object();
      },
      std::move(done));
}

void LiveLab::pause(bool paused, Done done) {
  enqueue(
      [this, paused] {
        live();
        paused_ = paused;
        pause_at_ = 0;
        due_ = Clock::now();
        broadcast(state());
        return Json{{"frame", live().frame()}};
      },
      std::move(done));
}

void LiveLab::step(std::uint64_t frames, Done done) {
  enqueue(
      [this, frames] {
        pause_at_ = live().frame() + frames;
        paused_ = false;
        due_ = Clock::now();
        broadcast(state());
        return Json{{"frame", pause_at_}};
      },
      std::move(done));
}

void LiveLab::speed(double factor, Done done) {
  enqueue(
      [this, factor] {
        speed_ = factor;
        due_ = Clock::now();
        broadcast(state());
        return Json::object();
      },
      std::move(done));
}

void LiveLab::recorded(std::function<Json(const Scenario&, std::string)> take, Done done) {
  enqueue([this, take = std::move(take)] { return take(live().recorded(), live().state_hash()); },
          std::move(done));
}

}  // namespace faba
