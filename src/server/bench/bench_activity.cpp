#include "server/bench/bench_activity.h"

#include <cmath>

#include "app/bench/live_picture.h"
#include "app/bench/memory.h"

namespace faba {

void BenchActivity::cycle(const Tick& t, const GuardReport& guard) {
  const std::lock_guard lock(mutex_);
  current_ = t.command.current;
  guard_ = guard;
  estimate_ = t.estimate;
  const Vec2 to = t.target.position;
  setpoint_px_.reset();
  if (std::isfinite(to.x) && std::isfinite(to.y)) setpoint_px_ = frame_.image_from_world(to);
}

void BenchActivity::coils(const std::vector<double>& current, const GuardReport& guard) {
  const std::lock_guard lock(mutex_);
  current_ = current;
  guard_ = guard;
}

void BenchActivity::progress(std::uint64_t done, std::uint64_t total) {
  const std::lock_guard lock(mutex_);
  if (total_ == 0) first_ = {monotonic_now(), done};
  done_ = done;
  total_ = total;
}

void BenchActivity::captured(const Captured& so_far, std::size_t picture_bytes) {
  const std::lock_guard lock(mutex_);
  captured_ = so_far;
  picture_bytes_ = picture_bytes;
}

void BenchActivity::item(int index, int of) {
  const std::lock_guard lock(mutex_);
  index_ = index;
  of_ = of;
}

void BenchActivity::out(const std::string& path, const std::string& experiment) {
  const std::lock_guard lock(mutex_);
  out_ = path;
  experiment_ = experiment;
}

bool BenchActivity::armed() const {
  const std::lock_guard lock(mutex_);
  return guard_ && guard_->state == CoilGuard::State::armed;
}

std::optional<GuardReport> BenchActivity::guard() const {
  const std::lock_guard lock(mutex_);
  return guard_;
}

Json BenchActivity::guard_json() const {
  if (!guard_) return nullptr;
  return {{"state", word(guard_->state)},
          {"heat", guard_->heat},
          {"reason", guard_->reason.data()},
          {"write_ok", guard_->write_ok}};
}

Json BenchActivity::coils_json() const {
  Json coils = Json::array();
  const bool armed = guard_ && guard_->state == CoilGuard::State::armed;
  for (std::size_t k = 0; k < max_current_.size(); ++k) {
    const double sensed = guard_ ? guard_->sensed[k] : std::nan("");
    coils.push_back({{"current_a", armed && k < current_.size() ? current_[k] : 0.0},
                     {"sensed_a", std::isnan(sensed) ? Json() : Json(sensed)},
                     {"max_a", max_current_[k]}});
  }
  return coils;
}

void BenchActivity::describe(Json& state) const {
  const std::lock_guard lock(mutex_);
  const double elapsed = monotonic_now() - began;
  Json a = {{"kind", kind},
            {"title", title},
            {"started_s_ago", elapsed},
            {"progress", total_ > 0 ? Json(double(done_) / double(total_)) : Json()},
            {"left_s", nullptr},
            {"armed", guard_ && guard_->state == CoilGuard::State::armed},
            {"out", out_},
            {"experiment", experiment_.empty() ? Json() : Json(experiment_)},
            {"stopping", stop.load()}};
  // From the first report of the progress: devices are opened before it.
  if (done_ > first_.second && done_ <= total_)
    a["left_s"] = (monotonic_now() - first_.first) * double(total_ - done_) / double(done_ - first_.second);
  if (of_ > 0) a.update({{"index", index_}, {"of", of_}});
  if (captured_) {
    const Memory memory = memory_of_machine();
    a.update({{"taken", captured_->taken},
              {"kept", captured_->kept},
              {"dropped", captured_->dropped},
              {"corrupt", captured_->corrupt},
              {"buffered", captured_->buffered},
              {"memory",
               {{"used_bytes", captured_->buffered * picture_bytes_},
                {"available_bytes", memory.available},
                {"total_bytes", memory.total}}}});
  }
  state["activity"] = std::move(a);
  if (!uses_coils) return;
  state["coils"] = coils_json();
  state["guard"] = guard_json();
  state["armed"] = guard_ && guard_->state == CoilGuard::State::armed;
  if (estimate_) state["estimate"] = swarm_json(*estimate_, frame_);
  if (setpoint_px_) state["setpoint_px"] = {setpoint_px_->x, setpoint_px_->y};
}

}  // namespace faba
