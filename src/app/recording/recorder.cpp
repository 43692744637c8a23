#include "app/recording/recorder.h"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>

#include "core/threads/urgent.h"

namespace faba {
namespace {

constexpr int kRecorderNiceness = 10;  // recording may be late; the control loop has priority

}  // namespace

Recorder::Recorder(std::vector<Sink*> sinks) : sinks_(std::move(sinks)), thread_([this] { work(); }) {}

Recorder::~Recorder() {
  {
    const std::lock_guard lock(mutex_);
    over_ = true;
  }
  changed_.notify_all();
  if (thread_.joinable()) thread_.join();
}

void Recorder::take(const Tick& t) {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [&] { return waiting_.size() < kMost || failure_; });
  if (failure_) std::rethrow_exception(failure_);
  waiting_.push_back({t.index, t.seen, t.estimate, t.target, t.command, t.limited});
  most_behind_ = std::max(most_behind_, waiting_.size());
  changed_.notify_all();
}

void Recorder::finish() {
  std::unique_lock lock(mutex_);
  over_ = true;
  changed_.notify_all();
  lock.unlock();
  if (thread_.joinable()) thread_.join();
  if (failure_) std::rethrow_exception(failure_);
}

void Recorder::work() {
  if (!Urgent::possible())
    (void)setpriority(PRIO_PROCESS, id_t(gettid()), kRecorderNiceness);  // of this thread only
  std::unique_lock lock(mutex_);
  for (;;) {
    changed_.wait(lock, [&] { return !waiting_.empty() || over_; });
    if (waiting_.empty()) return;
    const Kept k = std::move(waiting_.front());
    waiting_.pop_front();
    lock.unlock();
    try {
      for (Sink* s : sinks_) s->take({k.index, k.seen, k.estimate, k.target, k.command, k.limited});
    } catch (...) {
      lock.lock();
      failure_ = std::current_exception();
      changed_.notify_all();
      return;
    }
    lock.lock();
    changed_.notify_all();
  }
}

}  // namespace faba
