#include "rig/bench/camera_feed.h"

#include <chrono>
#include <optional>

#include "core/monotonic.h"
#include "core/threads/urgent.h"

namespace faba {
namespace {

constexpr auto kThreadExitTimeout = std::chrono::seconds(1);  // timeout for the end of a camera's thread

}  // namespace

CameraFeed::CameraFeed(std::shared_ptr<Camera> camera, Keep keep, std::size_t most, Which which)
    : camera_(std::move(camera)),
      shared_(std::make_shared<Shared>()),
      thread_([c = camera_, s = shared_, keep, most, which] { read_frames(c, s, keep, most, which); }) {}

CameraFeed::~CameraFeed() {
  {
    const std::lock_guard lock(shared_->mutex);
    shared_->stop = true;
    shared_->changed.notify_all();
  }
  camera_->interrupt();
  std::unique_lock lock(shared_->mutex);
  const bool ended = shared_->changed.wait_for(lock, kThreadExitTimeout, [&] { return shared_->exited; });
  lock.unlock();
  if (ended)
    thread_.join();
  else
    thread_.detach();
}

void CameraFeed::read_frames(const std::shared_ptr<Camera>& camera, const std::shared_ptr<Shared>& s,
                             Keep keep, std::size_t most, Which which) {
  const Urgent urgent;
  std::optional<std::uint64_t> last;
  std::exception_ptr failure;
  try {
    CameraFrame frame;
    while (camera->read(frame)) {
      std::unique_lock lock(s->mutex);
      if (s->stop) break;
      if (last && frame.number > *last + 1) s->lost += frame.number - *last - 1;
      last = frame.number;
      if (frame.corrupt) ++s->corrupt;
      if (frame.corrupt && which == Which::good) continue;
      if (frame.t < s->since) {
        s->behind = monotonic_now() - frame.t;
        continue;
      }
      if (keep == Keep::newest && !s->waiting.empty()) {
        s->lost += s->waiting.size();
        s->waiting.clear();
      }
      if (keep == Keep::all && s->waiting.size() >= most)
        ++s->lost;
      else
        s->waiting.push_back(std::move(frame));
      frame = {};
      s->changed.notify_all();
      if (keep == Keep::each) s->changed.wait(lock, [&] { return s->waiting.empty() || s->stop; });
    }
  } catch (...) {
    failure = std::current_exception();
  }
  const std::lock_guard lock(s->mutex);
  s->failure = failure;
  s->end = s->exited = true;
  s->changed.notify_all();
}

CameraFeed::Got CameraFeed::next(CameraFrame& out, double until) {
  std::unique_lock lock(shared_->mutex);
  const std::chrono::duration<double> left(until - monotonic_now());
  shared_->changed.wait_for(lock, left, [&] { return !shared_->waiting.empty() || shared_->end; });
  if (!shared_->waiting.empty()) {
    out = std::move(shared_->waiting.front());
    shared_->waiting.pop_front();
    ++shared_->taken;
    shared_->changed.notify_all();
    return Got::frame;
  }
  if (!shared_->end) return Got::nothing;
  if (shared_->failure) std::rethrow_exception(shared_->failure);
  return Got::end;
}

void CameraFeed::forget() {
  const std::lock_guard lock(shared_->mutex);
  shared_->waiting.clear();
  shared_->since = monotonic_now();
  shared_->behind = 0;
}

std::uint64_t CameraFeed::taken() const {
  const std::lock_guard lock(shared_->mutex);
  return shared_->taken;
}

double CameraFeed::behind() const {
  const std::lock_guard lock(shared_->mutex);
  return shared_->behind;
}

std::uint64_t CameraFeed::corrupt() const {
  const std::lock_guard lock(shared_->mutex);
  return shared_->corrupt + camera_->corrupt();
}

std::uint64_t CameraFeed::dropped() const {
  const std::lock_guard lock(shared_->mutex);
  return shared_->lost;
}

}  // namespace faba
