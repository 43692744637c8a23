#include "server/live_lab.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "app/sinks/series_row.h"

namespace faba {
namespace {

constexpr std::size_t kRows = 32;  // of the series in a message; a page knows most of them already
constexpr int kFieldColumns = 17, kFieldRows = 13;
constexpr std::size_t kMostHeadings = 20000;  // more cells are too small to show where they head
constexpr double kTellEvery = 0.5;            // s: how fast it really goes
constexpr double kLate = 0.25;                // s: what a run may catch up with; the rest is given up

std::uint64_t drawn_seed() {
  std::random_device device;
  return (std::uint64_t{device()} << 32 | device()) & 0xFFFFFFFFFFFFull;
}

Json box_json(const PictureBox& b) { return {b.left, b.top, b.right, b.bottom}; }

}  // namespace

struct LiveLab::Shown final : Sink {
  Shown(const Document& d, std::uint64_t seed, const Parts& parts, Pool& pool)
      : document(d),
        live(d, seed, parts, pool),
        row(sink_context(live.scenario(), live.simulation(), pool, {})),
        columns(row.names()) {
    columns.emplace_back("activity_um_s");
    const Simulation& s = live.simulation();
    const Grid g = s.world().parts().arena->grid();
    const Vec2 low{double(g.left), double(g.low)};
    const Vec2 corner = s.frame().image_from_world(low);
    const Vec2 opposite =
        s.frame().image_from_world(low + double(g.cell) * Vec2{double(g.columns), double(g.rows)});
    box = {corner.x, opposite.y, opposite.x, corner.y};
    const bool varies = s.world().parts().table.has_value();
    const int nx = varies ? kFieldColumns : 1, ny = varies ? kFieldRows : 1;
    for (int j = 0; j < ny; ++j)
      for (int i = 0; i < nx; ++i) {
        const Vec2 at =
            s.frame().world_from_image({(s.frame().width - 1) * (varies ? double(i) / (nx - 1) : 0.5),
                                        (s.frame().height - 1) * (varies ? double(j) / (ny - 1) : 0.5)});
        field_x.push_back(float(at.x)), field_y.push_back(float(at.y));
      }
    field_columns = nx, field_rows = ny;
    live.simulation().loop().sinks.push_back(this);
  }

  void take(const Tick& t) override {
    std::vector<double> v = row.values(t);
    const double now = live.simulation().rig().time_of(t.index);
    v.push_back(mean_speed(now - time) * 1e6);
    time = now;
    if (rows.size() == kRows * v.size()) rows.erase(rows.begin(), rows.begin() + std::ptrdiff_t(v.size()));
    rows.insert(rows.end(), v.begin(), v.end());
  }

  // Of all cells since the frame before, m/s: what the activity of a video is a measure of.
  double mean_speed(double dt) {
    const auto& agents = live.simulation().world().state().agents;
    const std::span<const float> x = agents["x"], y = agents["y"];
    double way = 0;
    const bool first = before_x.empty();
    if (first) before_x.resize(x.size()), before_y.resize(x.size());
    for (std::size_t i = 0; i < x.size(); ++i) {
      way += std::hypot(double(x[i]) - double(before_x[i]), double(y[i]) - double(before_y[i]));
      before_x[i] = x[i], before_y[i] = y[i];
    }
    return first || !(dt > 0) ? std::numeric_limits<double>::quiet_NaN() : way / (double(x.size()) * dt);
  }

  std::shared_ptr<const std::string> message(std::uint32_t run, bool camera) {
    Simulation& s = live.simulation();
    const World& w = s.world();
    const auto& agents = w.state().agents;
    FrameMessage m;
    m.run = run, m.frame = live.frame() - 1, m.t = time, m.view = s.frame(), m.box = box;
    m.x = agents["x"], m.y = agents["y"], m.response = agents["response"];
    if (agents.has("ux") && m.x.size() <= kMostHeadings) m.ux = agents["ux"], m.uy = agents["uy"];
    m.rows = rows, m.columns = columns.size();
    const std::size_t n = field_x.size();
    std::vector<float> bx(n), by(n), field(2 * n);
    if (w.parts().table)
      w.parts().table->eval({field_x, field_y}, {bx, by});
    else
      w.parts().field->eval({field_x, field_y}, w.state().current, {bx, by});
    for (std::size_t i = 0; i < n; ++i) field[2 * i] = bx[i], field[2 * i + 1] = -by[i];
    m.field_columns = field_columns, m.field_rows = field_rows, m.field = field;
    ImageRef picture;
    if (camera) {
      picture = s.rig().picture();
      m.picture = picture->px, m.picture_columns = picture->width, m.picture_rows = picture->height;
    }
    return std::make_shared<const std::string>(encode_frame(m));
  }

  Document document;
  LiveRun live;
  SeriesRow row;
  std::vector<std::string> columns;
  std::vector<double> rows;  ///< the newest kRows
  double time = 0;
  std::vector<float> before_x, before_y;  ///< m, in the frame before
  PictureBox box;
  std::vector<float> field_x, field_y;  ///< where the field is shown, m, world
  int field_columns = 1, field_rows = 1;
};

LiveLab::LiveLab(unsigned threads)
    : parts_(builtin_parts()), pool_(threads), thread_([this](const std::stop_token& s) { work(s); }) {}

LiveLab::~LiveLab() {
  thread_.request_stop();
  wake_.notify_all();
}

LiveRun& LiveLab::live() const {
  if (!shown_) throw Error(Errc::usage, "run", "there is none; start a scenario");
  return shown_->live;
}

void LiveLab::ask(std::function<Json()> what, Done done) {
  {
    const std::lock_guard lock(mutex_);
    asked_.push_back({std::move(what), std::move(done)});
  }
  wake_.notify_all();
}

void LiveLab::do_asked(std::unique_lock<std::mutex>& lock) {
  while (!asked_.empty() && !next_) {
    const Asked a = std::move(asked_.front());
    asked_.pop_front();
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

void LiveLab::work(const std::stop_token& stop) {
  while (!stop.stop_requested()) {
    {
      std::unique_lock lock(mutex_);
      do_asked(lock);
      if (!next_) {
        wake_.wait(lock, [&] { return stop.stop_requested() || !asked_.empty(); });
        continue;
      }
      shown_ = std::move(next_);
    }
    ++run_;
    due_ = told_ = Clock::now(), told_frame_ = 0, real_speed_ = 0;
    tell(run_news());
    tell(state());
    try {
      shown_->live.run([&] { return between_frames(stop); });
    } catch (const Error& e) {
      tell({{"say", "stopped"}, {"where", e.where()}, {"what", e.reason()}});
    }
  }
}

// Speed that is asked for, as long as the machine can; what it cannot is given up, not caught up with.
void LiveLab::keep_pace() {
  const auto now = Clock::now();
  const double period = shown_->live.scenario().frame_period() / speed_;
  due_ += std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(period));
  if (now - due_ > std::chrono::duration<double>(kLate)) due_ = now;
  const double since = std::chrono::duration<double>(now - told_).count();
  if (since < kTellEvery) return;
  const std::uint64_t frames = shown_->live.frame() - told_frame_;
  real_speed_ = double(frames) * shown_->live.scenario().frame_period() / since;
  told_ = now, told_frame_ = shown_->live.frame();
  tell(state());
}

bool LiveLab::between_frames(const std::stop_token& stop) {
  keep_pace();
  publish(Clock::now());
  std::unique_lock lock(mutex_);
  if (pause_at_ > 0 && shown_->live.frame() >= pause_at_) {
    pause_at_ = 0, paused_ = true;
    const Json news = state();
    lock.unlock();
    tell(news);
    lock.lock();
  }
  for (;;) {
    do_asked(lock);
    if (next_ || stop.stop_requested()) return false;
    const auto woken = [&] { return stop.stop_requested() || !asked_.empty(); };
    if (paused_) {
      wake_.wait(lock, woken);
      due_ = told_ = Clock::now(), told_frame_ = shown_->live.frame();
    } else if (!wake_.wait_until(lock, due_, woken)) {
      return true;
    }
  }
}

void LiveLab::publish(Clock::time_point now) {
  std::shared_ptr<const std::string> plain, camera;
  const std::lock_guard lock(mutex_);
  for (auto& [who, w] : watchers_) {
    if (now < w.next && !paused_) continue;
    w.next =
        now + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(1 / w.wish.rate));
    auto& message = w.wish.camera ? camera : plain;
    if (!message) message = shown_->message(run_, w.wish.camera);
    w.listener.frame(message);
  }
}

void LiveLab::tell(const Json& news) {
  const std::lock_guard lock(mutex_);
  for (const auto& [who, w] : watchers_) w.listener.news(news);
}

Json LiveLab::state() const {
  Json j = {
      {"say", "state"}, {"running", !paused_ && shown_}, {"speed", speed_}, {"real_speed", real_speed_}};
  j["frame"] = shown_ ? shown_->live.frame() : 0;
  return j;
}

Json LiveLab::run_news() const {
  const LiveRun& live = shown_->live;
  const Simulation& s = shown_->live.simulation();
  const World& w = s.world();
  const Outline edge = w.parts().arena->outline();
  Json populations = Json::array();
  for (const Population& p : w.parts().populations)
    populations.push_back(
        {{"begin", p.begin}, {"end", p.end}, {"polarity", p.polarity > 0 ? "north" : "south"}});
  Json j = parts_news();
  j["say"] = "run";
  j["run"] = run_, j["seed"] = live.seed();
  j["frame"] = {{"width", s.frame().width},
                {"height", s.frame().height},
                {"um_per_px", s.frame().m_per_px * 1e6},
                {"rate", live.scenario().camera.rate}};
  j["outline"] = {{"centre_px", {edge.centre_image.x, edge.centre_image.y}}, {"radius_px", edge.radius_px}};
  j["box"] = box_json(shown_->box);
  j["populations"] = populations;
  j["coils"] = w.state().current.size();
  j["columns"] = shown_->columns;
  return j;
}

Json LiveLab::parts_news() const {
  const Simulation& s = shown_->live.simulation();
  Json setpoints = Json::array();
  for (const Vec2 p : s.reference().setpoints()) {
    const Vec2 at = s.frame().image_from_world(p);
    if (std::isfinite(at.x)) setpoints.push_back({at.x, at.y});
  }
  return {{"say", "parts"},
          {"scenario", shown_->live.scenario().resolved()},
          {"setpoints", setpoints},
          {"events", shown_->live.exchanges()}};
}

void LiveLab::watch(std::uint64_t who, Listener l) {
  ask(
      [this, who, l = std::move(l)] {
        if (shown_) l.news(run_news());
        l.news(state());
        if (shown_ && shown_->live.frame() > 0) l.frame(shown_->message(run_, false));
        const std::lock_guard lock(mutex_);
        watchers_[who] = {l, {}, {}};
        return Json::object();
      },
      [](const Json&) {});
}

void LiveLab::wish(std::uint64_t who, Wish w) {
  ask(
      [this, who, w] {
        std::unique_lock lock(mutex_);
        const auto it = watchers_.find(who);
        if (it == watchers_.end()) return Json::object();
        it->second.wish = w;
        if (paused_ && shown_ && shown_->live.frame() > 0)
          it->second.listener.frame(shown_->message(run_, w.camera));
        return Json::object();
      },
      [](const Json&) {});
}

void LiveLab::leave(std::uint64_t who) {
  const std::lock_guard lock(mutex_);
  watchers_.erase(who);
}

Json LiveLab::begin(const Document& d, std::uint64_t seed) {
  next_ = std::make_unique<Shown>(d, seed, parts_, pool_);
  paused_ = false, pause_at_ = 0;
  return {{"seed", seed}};
}

void LiveLab::start(Document d, std::optional<std::uint64_t> seed, Done done) {
  ask([this, d = std::move(d), seed] { return begin(d, seed.value_or(drawn_seed())); }, std::move(done));
}

void LiveLab::restart(Done done) {
  ask([this] { return begin((live(), shown_->document), live().seed()); }, std::move(done));
}

void LiveLab::exchange(Json event, Done done) {
  ask(
      [this, event = std::move(event)] {
        live().exchange(event);
        tell(parts_news());
        return Json::object();
      },
      std::move(done));
}

void LiveLab::pause(bool paused, Done done) {
  ask(
      [this, paused] {
        live();
        paused_ = paused, pause_at_ = 0;
        due_ = Clock::now();
        tell(state());
        return Json{{"frame", live().frame()}};
      },
      std::move(done));
}

void LiveLab::step(std::uint64_t frames, Done done) {
  ask(
      [this, frames] {
        pause_at_ = live().frame() + frames, paused_ = false;
        due_ = Clock::now();
        tell(state());
        return Json{{"frame", pause_at_}};
      },
      std::move(done));
}

void LiveLab::speed(double factor, Done done) {
  ask(
      [this, factor] {
        speed_ = factor;
        due_ = Clock::now();
        tell(state());
        return Json::object();
      },
      std::move(done));
}

void LiveLab::recorded(std::function<void(const Scenario&, std::string)> take, Done done) {
  ask(
      [this, take = std::move(take)] {
        take(live().recorded(), live().state_hash());
        return Json::object();
      },
      std::move(done));
}

}  // namespace faba
