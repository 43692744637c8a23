// Workers on this machine: one process for each processor.
#include <signal.h>
#include <unistd.h>

#include <map>

#include "core/process/child.h"
#include "core/threads/parallel.h"
#include "study/engines/engines.h"
#include "study/engines/process.h"

namespace faba {
namespace {

class LocalEngine final : public Engine {
 public:
  LocalEngine(const EngineSettings& settings, WorkerCommand worker)
      : slots_(number_of_threads(unsigned(settings.workers))), worker_(std::move(worker)) {}
  ~LocalEngine() override { LocalEngine::cancel(); }

  unsigned slots() const override { return slots_; }
  double period_s() const override { return 0.02; }

  bool submit(std::span<const Attempt> attempts) override {
    for (const Attempt& a : attempts) {
      std::vector<std::string> words = worker_.words(a);
      words.insert(words.end(), {"--parent", std::to_string(getpid())});
      workers_[start_process(words, {.log = a.log})] = a.id;
    }
    return true;
  }

  std::vector<AttemptEnd> ended() override {
    std::vector<AttemptEnd> ends;
    for (auto it = workers_.begin(); it != workers_.end();) {
      const auto end = end_of_process(it->first);
      if (!end) {
        ++it;
        continue;
      }
      ends.push_back({it->second, end_text(*end), *end});
      it = workers_.erase(it);
    }
    return ends;
  }

  // Workers store each result at once, so they need no time to end.
  void cancel() override {
    for (const auto& [process, _] : workers_) kill(process, SIGTERM);
    for (const auto& [process, _] : workers_) end_child(process, 0.5);
    workers_.clear();
  }

 private:
  unsigned slots_;
  WorkerCommand worker_;
  std::map<pid_t, std::uint64_t> workers_;
};

}  // namespace

std::unique_ptr<Engine> local_engine(const EngineSettings& settings, const WorkerCommand& worker) {
  return std::make_unique<LocalEngine>(settings, worker);
}

}  // namespace faba
