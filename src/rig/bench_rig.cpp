#include "rig/bench_rig.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/monotonic.h"
#include "vision/image.h"

namespace faba {
namespace {

constexpr double kBlind = 0.8;  // of the guard's deadline, after which currents are taken away before it does

}  // namespace

BenchRig::BenchRig(std::shared_ptr<Camera> camera, std::unique_ptr<GuardLink> coils, const Params& p)
    : p_(p), feed_(std::move(camera), p.keep), coils_(std::move(coils)) {
  if (coils_) coils_->on_answer = [this](const GuardReport& r) { answered(r); };
}

BenchRig::~BenchRig() { safe(); }

void BenchRig::arm() {
  if (!coils_) throw Error(Errc::device, "rig", "has no coils to arm");
  coils_->arm();
  armed_ = true;
}

void BenchRig::safe() noexcept {
  armed_ = false;
  if (coils_) coils_->disarm();
}

void BenchRig::check_guard() {
  if (!armed_) return;
  const GuardReport r = coils_->report();
  if (r.state != CoilGuard::State::armed)
    throw Error(Errc::device, "coil guard",
                fmt::format("{}; the coils are at rest", r.reason[0] ? r.reason.data() : "is disarmed"));
}

bool BenchRig::read(Observation& out) {
  const double deadline = kBlind * (coils_ ? coils_->command_deadline() : p_.camera_timeout);
  const double give_up = monotonic_now() + p_.camera_timeout;
  bool rested = false;
  CameraFrame frame;
  for (;;) {
    if (over_) return false;
    const double until = armed_ && !rested && asked_t_ > 0 ? std::min(give_up, asked_t_ + deadline) : give_up;
    const CameraFeed::Got got = feed_.next(frame, until);
    if (got == CameraFeed::Got::end) return false;
    check_guard();
    if (got == CameraFeed::Got::frame) break;
    if (monotonic_now() >= give_up)
      throw Error(Errc::device, "camera",
                  fmt::format("has given no frame for {:g} s; the coils are at rest", p_.camera_timeout));
    if (!armed_ || rested) continue;
    coils_->request(std::vector<double>(coils_->coils(), 0.0), std::nan(""));
    rested = true;
  }
  arrived_ = monotonic_now();
  if (!began_) began_ = frame.t, first_ = frame.number;
  out.frame = frame.number - first_;
  out.t = frame.t - *began_;
  out.age = feed_.camera().waits() ? 0 : std::max(0.0, arrived_ - frame.t);  // a file has no age
  out.seen.clear();
  out.image = frame.image;
  out.rested = rested;
  delays_.push_back({out.age, std::nan("")});
  return true;
}

void BenchRig::write(const Command& c) {
  if (!coils_ || !armed_) return;
  check_guard();
  const double t = delays_.empty() ? 0 : arrived_ - delays_.back().arrival;
  asked_.push_back({coils_->request(c.current, t), arrived_, delays_.size() - 1});
  asked_t_ = monotonic_now();
}

void BenchRig::answered(const GuardReport& r) {
  while (!asked_.empty() && asked_.front().number < r.number) asked_.pop_front();
  if (asked_.empty() || asked_.front().number != r.number) return;
  const Asked& a = asked_.front();
  if (a.frame < delays_.size()) delays_[a.frame].command = r.done - a.arrived;
  asked_.pop_front();
}

}  // namespace faba
