#include "rig/bench/bench_rig.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/monotonic.h"
#include "vision/image/image.h"

namespace faba {

BenchRig::BenchRig(std::shared_ptr<Camera> camera, std::unique_ptr<GuardLink> coils, const Params& p)
    : p_(p), feed_(std::move(camera), p.keep), coils_(std::move(coils)) {
  if (!coils_) return;
  coils_->on_answer = [this](const GuardReport& r) { record_delay(r); };
  coils_->deenergise_when_late();
}

BenchRig::~BenchRig() { safe(); }

void BenchRig::begin() {
  safe();
  start_.reset();
  if (!feed_.camera().waits()) feed_.forget();
  pending_.clear();
  delays_.clear();
  dropped_before_ = feed_.dropped();
}

void BenchRig::arm() {
  if (!coils_) throw Error(Errc::device, "rig", "no coils to arm");
  coils_->arm();
  armed_ = just_armed_ = true;
}

void BenchRig::safe() noexcept {
  armed_ = just_armed_ = false;
  if (coils_) coils_->disarm();
}

std::string BenchRig::coil_status() const {
  if (!coils_) return "";
  return coils_->report().write_ok ? "; the coils are de-energised"
                                   : "; the coils could not be de-energised: switch them off by hand";
}

void BenchRig::check_guard() {
  if (!armed_) return;
  const GuardReport r = coils_->report();
  if (r.state != CoilGuard::State::armed)
    throw Error(
        Errc::device, "coil guard",
        (r.reason[0] ? r.reason.data() : "disarmed") + coil_status() +
            (r.fault == CoilGuard::Fault::current_mismatch ? "; check the wire and the amplifier of the coil"
                                                           : ""));
}

bool BenchRig::read(Observation& out) {
  if (const double elapsed = monotonic_now() - arrived_; armed_ && elapsed > p_.camera_timeout)
    throw Error(Errc::device, "rig",
                fmt::format("control cycle overran ({:.1f} s){}", elapsed, coil_status()));
  CameraFrame frame;
  CameraFeed::Got got;
  try {
    got = feed_.next(frame, monotonic_now() + p_.camera_timeout);
  } catch (const Error& e) {
    check_guard();  // a fault of the guard came first: report that one
    if (!armed_) throw;
    safe();
    throw Error(e.code(), e.where(), e.reason() + coil_status());
  }
  if (got == CameraFeed::Got::end) return false;
  check_guard();
  if (got == CameraFeed::Got::nothing) {
    const double behind = start_ ? 0 : feed_.behind();
    throw Error(
        Errc::device, "camera",
        behind > 0
            ? fmt::format("frames are {:.1f} s old on arrival: the camera, or a simulated bench on this "
                          "machine, is too slow for the frame rate{}",
                          behind, coil_status())
            : fmt::format(
                  "no picture for {:g} s{}; check the camera and its cable", p_.camera_timeout,
                  coils_ ? coil_status() + " (the currents were set to zero at the first missing pictures)"
                         : ""));
  }
  arrived_ = monotonic_now();
  frame_t_ = frame.t;
  if (!start_) {
    start_ = frame.t;
    first_number_ = frame.number;
  }
  out.frame = frame.number - first_number_;
  out.t = frame.t - *start_;
  out.age = feed_.camera().waits() ? 0 : std::max(0.0, arrived_ - frame.t);  // frames of a file have no age
  out.seen.clear();
  out.image = frame.image;
  out.coils_off = coils_ && coils_->clear_timeout();
  if (std::exchange(just_armed_, false)) out.coils_off = true;  // commands before arming were discarded
  delays_.push_back({out.age, std::nan("")});
  return true;
}

void BenchRig::write(const Command& c) {
  if (!coils_ || !armed_) return;
  check_guard();
  if (const auto number = coils_->request(c.current, frame_t_))
    pending_.push_back({*number, arrived_, delays_.size() - 1});
}

void BenchRig::record_delay(const GuardReport& r) {
  while (!pending_.empty() && pending_.front().number < r.number) pending_.pop_front();
  if (pending_.empty() || pending_.front().number != r.number) return;
  const Pending& a = pending_.front();
  if (a.frame < delays_.size()) delays_[a.frame].command = r.done - a.arrived;
  pending_.pop_front();
}

}  // namespace faba
